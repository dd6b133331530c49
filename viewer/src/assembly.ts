import { scaleOf, type Scale } from "./colour";
import type { DataTexture, Gl } from "./gl";
import { Ends, type Segments } from "./layers/segments";
import * as pieces from "./pieces";
import { hasColumn, type Run } from "./run";
import { edgesOf, type Edge } from "./sides";
import type { Column, Table } from "./source";
import type { Layer, State } from "./store";
import type { Tables } from "./tables";

export type Drawn = "forces" | "graph" | "dual" | "broken" | "stress" | "fabric" | "modes";

/** All that is drawn of one load step. */
export interface Picture {
  step: number;
  count: number;
  body: pieces.Body;
  shapes: DataTexture;
  moves: DataTexture;
  edges: Edge[];
  links: pieces.Links | null;
  branches: Ends | null;
  displacements: pieces.Moves;
  brokenContacts: number[];
  segments: Partial<Record<Drawn, Segments>>;
  cells: DataTexture | null;
  scales: Partial<Record<"grains" | "forces" | "cells" | "broken", Scale>>;
  wholes: Partial<Record<"stress" | "fabric", { major: number; minor: number; angle: number } | null>>;
  mode: { eigenvalue: number; count: number } | null;
}

/** Whether the run has what a layer draws. */
export function offered(run: Run, layer: Layer): boolean {
  const contacts = (...names: string[]): boolean => names.every((name) => hasColumn(run, "contacts", name));
  switch (layer) {
    case "forces": return contacts("first", "second", "normal_force");
    case "graph": return contacts("first", "second", "state");
    case "dual": return run.has.dual && contacts("first", "second");
    case "broken": return contacts("first", "second", "broke_at", "x", "y", "nx", "ny", "dual_length_full");
    case "window": return hasColumn(run, "grains", "window");
    case "cells": return run.has.cells.length > 0;
    case "modes": return run.has.modes.length > 0;
    case "stress": case "fabric": return run.has.crosses;
    default: return true;
  }
}

const WITH_LINKS: Layer[] = ["forces", "graph", "dual", "broken"];

/** Brings the pieces of a picture together and keeps those that a change does not concern. */
export class Assembly {
  private readonly made = new Map<string, { key: string; value: unknown }>();
  private stale: WebGLTexture[] = [];

  constructor(private readonly gl: Gl, private readonly tables: Tables) {}

  /** The picture of a state; `early` is called with the grains before all else is there. */
  async picture(state: State, early: (picture: Picture) => void): Promise<Picture> {
    const picture = await this.grains(state);
    early({ ...picture });
    await Promise.all([this.contacts(state, picture), this.cells(state, picture), this.crosses(state, picture), this.modes(state, picture)]);
    return picture;
  }

  /** Frees what no picture needs any longer, once a new one has taken the place of the old. */
  sweep(): void {
    for (const texture of this.stale) this.gl.context.deleteTexture(texture);
    this.stale = [];
  }

  private async grains(state: State): Promise<Picture> {
    const { run, step } = state;
    const names = ["x", "y", "radius", "ux", "uy"];
    if (run.grains <= SPOKES_UP_TO) names.push("rotation");
    if (state.colour.grains && state.layers.grains) names.push(state.colour.grains);
    if (state.layers.window) names.push("window");
    const wantsLinks = WITH_LINKS.some((layer) => shows(state, layer));
    const [grains, sides, contacts] = await Promise.all([
      this.tables.at("grains", step, names, run),
      this.tables.at("sides", step, ["side", "name", "ux", "uy", "rotation"], run).catch(() => null),
      wantsLinks ? this.tables.at("contacts", step, ["first", "second"], run) : null,
    ]);
    const [x, y, radius, ux, uy] = ["x", "y", "radius", "ux", "uy"].map((name) => pieces.numbers(grains, name));
    const body = { x, y, radius, ux, uy } as pieces.Body;
    const edges = edgesOf(run, sides);
    const links = contacts && this.keep("links", "once", () => pieces.linksOf(contacts, body, edges));
    const displacements = pieces.movesOf(body, links?.anchors ?? [], edges);
    const window = grains.get("window")?.values ?? null;
    const column = (state.layers.grains && grains.get(state.colour.grains)) || null;
    const scale = column ? this.scale(column, state) : undefined;
    return {
      step, count: body.x.length, body, edges, links, displacements,
      branches: links && this.keep("branches", String(step), () => pieces.branches(this.gl, body, links, displacements)),
      shapes: this.keep("shapes", String(window !== null), () => pieces.shapes(this.gl, body, window)),
      moves: this.keep("moves", `${step} ${state.colour.grains} ${column !== null}`, () =>
        pieces.moves(this.gl, body, grains.get("rotation")?.values ?? null, column)),
      brokenContacts: [], segments: {}, cells: null, scales: scale ? { grains: scale } : {}, wholes: {}, mode: null,
    };
  }

  private async contacts(state: State, picture: Picture): Promise<void> {
    const { links, branches, displacements } = picture;
    if (!links || !branches) return;
    const names: string[] = [];
    if (shows(state, "forces")) names.push("normal_force", ...(state.colour.forces ? [state.colour.forces] : []));
    if (shows(state, "graph")) names.push("state");
    if (shows(state, "broken")) names.push("broke_at");
    const [contacts, dual] = await Promise.all([
      this.tables.at("contacts", state.step, names, state.run),
      shows(state, "dual") ? this.tables.whole("dual", ["contact", "x1", "y1", "x2", "y2"]) : null,
    ]);
    if (shows(state, "forces")) this.forces(state, picture, branches, contacts);
    if (shows(state, "graph")) picture.segments.graph = this.keep("graph", String(state.step), () => pieces.graph(this.gl, branches, contacts));
    if (dual) picture.segments.dual = this.keep("dual", String(state.step), () => pieces.dual(this.gl, links, dual, displacements));
    if (shows(state, "broken")) await this.broken(state, picture, links, contacts);
  }

  private forces(state: State, picture: Picture, branches: Ends, contacts: Table): void {
    const colour = contacts.get(state.colour.forces) ?? null;
    const key = `${state.step} ${state.colour.forces} ${state.leastForce} ${JSON.stringify(state.range.forces)}`;
    const made = this.keep("forces", key, () => pieces.forces(this.gl, branches, contacts, colour, state.range.forces, state.leastForce));
    picture.segments.forces = made.segments;
    picture.scales.forces = made.scale;
  }

  private async broken(state: State, picture: Picture, links: pieces.Links, contacts: Table): Promise<void> {
    if (!contacts.get("broke_at")?.values.some((event) => event >= 0)) return;
    const names = ["broke_at", "x", "y", "nx", "ny", "dual_length_full"];
    const table = await this.tables.at("contacts", state.step, names, state.run);
    const made = this.keep("broken", String(state.step), () => pieces.broken(this.gl, links, table, picture.displacements));
    picture.segments.broken = made.segments;
    picture.scales.broken = made.scale;
    picture.brokenContacts = made.contacts;
  }

  private async cells(state: State, picture: Picture): Promise<void> {
    const { run, step, colour, range } = state;
    if (!shows(state, "cells") || !run.has.cells.includes(step)) return;
    const [table, voids] = await Promise.all([
      this.tables.at("cells", step, ["void", "first", "second", "third"], run),
      colour.cells ? this.tables.at("voids", step, [colour.cells], run) : new Map(),
    ]);
    const key = `${step} ${colour.cells} ${JSON.stringify(range.cells)}`;
    const made = this.keep("cells", key, () => pieces.cells(this.gl, table, voids, colour.cells, range.cells));
    picture.cells = made.cells;
    if (made.scale) picture.scales.cells = made.scale;
  }

  private async crosses(state: State, picture: Picture): Promise<void> {
    const kinds = (["stress", "fabric"] as const).filter((kind) => shows(state, kind));
    if (kinds.length === 0) return;
    const table = await this.tables.at("crosses", state.step, ["kind", "x", "y", "angle", "major", "minor", "size", "whole"], state.run);
    for (const kind of kinds) {
      const made = this.keep(kind, String(state.step), () => pieces.crosses(this.gl, table, kind));
      picture.segments[kind] = made.segments;
      picture.wholes[kind] = made.whole;
    }
  }

  private async modes(state: State, picture: Picture): Promise<void> {
    if (!shows(state, "modes") || !state.run.has.modes.includes(state.step)) return;
    const table = await this.tables.at("modes", state.step, ["mode", "eigenvalue", "grain", "ux", "uy"], state.run);
    const reach = 4 * radiiOf(picture.body).mean;
    const made = this.keep("modes", `${state.step} ${state.mode}`, () =>
      pieces.mode(this.gl, table, state.mode, picture.body, reach));
    picture.segments.modes = made.segments;
    picture.mode = made;
  }

  private scale(column: Column, state: State): Scale {
    const key = `${state.step} ${state.colour.grains} ${JSON.stringify(state.range.grains)}`;
    return this.keep("scale", key, () => scaleOf(column, state.range.grains));
  }

  /** The value made last under this name if it was made for the same key; else made anew. */
  private keep<T>(name: string, key: string, make: () => T): T {
    const before = this.made.get(name);
    if (before?.key === key) return before.value as T;
    const value = make();
    if (before) this.stale.push(...texturesOf(before.value));
    this.made.set(name, { key, value });
    return value;
  }
}

/** Textures of what has been made; ends that several use are made apart and freed apart. */
function texturesOf(value: unknown): WebGLTexture[] {
  if (value instanceof WebGLTexture) return [value];
  if (value === null || typeof value !== "object" || ArrayBuffer.isView(value) || Array.isArray(value)) return [];
  if ("textures" in value) return value.textures as WebGLTexture[];
  return Object.values(value).flatMap((inner) => (inner instanceof Ends && inner.shared ? [] : texturesOf(inner)));
}

/** Rotations are drawn, and asked for, up to this many grains. */
export const SPOKES_UP_TO = 200000;

export function shows(state: State, layer: Layer): boolean {
  return state.layers[layer] && offered(state.run, layer);
}

export interface Radii {
  mean: number;
  largest: number;
}

const radii = new WeakMap<object, Radii>();

export function radiiOf({ radius }: pieces.Body): Radii {
  let known = radii.get(radius);
  if (!known) {
    let [sum, largest] = [0, 0];
    for (let i = 0; i < radius.length; i++) {
      sum += radius[i]!;
      largest = Math.max(largest, radius[i]!);
    }
    radii.set(radius, (known = { mean: sum / Math.max(radius.length, 1), largest }));
  }
  return known;
}
