import type { Run } from "./run";

export const LAYERS = [
  "cells", "grains", "forces", "graph", "dual", "broken", "window", "container", "stress", "fabric", "modes",
] as const;
export type Layer = (typeof LAYERS)[number];

export type Coloured = "grains" | "forces" | "cells";

export interface Range {
  low: number;
  high: number;
}

export interface Selection {
  kind: "grain" | "contact";
  id: number;
}

export interface State {
  run: Run;
  /** The recorded load step that is shown. */
  step: number;
  playing: boolean;
  /** Load factors by load step; NaN where unknown. */
  loadFactors: Float64Array;
  layers: Record<Layer, boolean>;
  /** Column that colours a layer; "" for none: grains in one colour, forces by their sign. */
  colour: Record<Coloured, string>;
  /** Range of the colours; null: that of the values shown. */
  range: Record<Coloured, Range | null>;
  /** Normal forces are drawn no wider than if the largest were this: smaller ones are rounding. */
  leastForce: number;
  /** Displacements are drawn this many times. */
  factor: number;
  /** Width of the largest normal force in mean radii. */
  width: number;
  mode: number;
  selection: Selection | null;
  theme: "light" | "dark";
}

type Listener = (state: State, changed: ReadonlySet<keyof State>) => void;

/** The one place where the state of the page is. */
export class Store {
  private readonly listeners: [Set<keyof State>, Listener][] = [];
  private changed = new Set<keyof State>();

  constructor(private current: State) {}

  get state(): Readonly<State> {
    return this.current;
  }

  /** Changes the state and tells, in one go, who listens to what has changed. */
  set(part: Partial<State>): void {
    const waiting = this.changed.size > 0;
    for (const key of Object.keys(part) as (keyof State)[]) if (part[key] !== this.current[key]) this.changed.add(key);
    this.current = { ...this.current, ...part };
    if (!waiting && this.changed.size > 0) queueMicrotask(() => this.tell());
  }

  /** Calls `listener` at once and whenever one of the keys has changed. */
  on(keys: (keyof State)[], listener: Listener): void {
    this.listeners.push([new Set(keys), listener]);
    listener(this.current, new Set(keys));
  }

  private tell(): void {
    const changed = this.changed;
    this.changed = new Set();
    for (const [keys, listener] of this.listeners) {
      if ([...changed].some((key) => keys.has(key))) listener(this.current, changed);
    }
  }
}
