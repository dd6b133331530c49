import { offered } from "./assembly";
import { choices, element } from "./dom";
import { spoken, withUnit, type ColumnInfo, type Run } from "./run";
import type { Coloured, Layer, Store } from "./store";

interface Entry {
  layer: Layer;
  text: string;
  key: string;
  coloured?: Coloured;
}

export const ENTRIES: Entry[] = [
  { layer: "grains", text: "Grains", key: "g", coloured: "grains" },
  { layer: "forces", text: "Forces", key: "f", coloured: "forces" },
  { layer: "broken", text: "Broken contacts", key: "b" },
  { layer: "graph", text: "Contact graph", key: "c" },
  { layer: "dual", text: "Dual graph", key: "d" },
  { layer: "cells", text: "Void cells", key: "v", coloured: "cells" },
  { layer: "window", text: "Measuring window", key: "w" },
  { layer: "container", text: "Container and sides", key: "o" },
  { layer: "stress", text: "Principal stress", key: "s" },
  { layer: "fabric", text: "Principal fabric", key: "a" },
  { layer: "modes", text: "Modes", key: "m" },
];

const UNCOLOURED = {
  grains: "one colour", forces: "compression, tension", cells: "one colour",
};
const TABLE = { grains: "grains", forces: "contacts", cells: "voids" };
const LEFT_OUT = new Set(["step", "grain", "contact", "void", "first", "second", "broke_at", "law"]);

/** Columns that can colour a layer. */
export function colourColumns(run: Run, layer: Coloured): ColumnInfo[] {
  return (run.tables[TABLE[layer]] ?? []).filter((column) => !LEFT_OUT.has(column.name));
}

export function toggle(store: Store, layer: Layer): void {
  const { layers, run } = store.state;
  if (offered(run, layer)) store.set({ layers: { ...layers, [layer]: !layers[layer] } });
}

export function controls(store: Store): HTMLElement {
  const list = element("ul", { class: "layers" });
  store.on(["run"], ({ run }) => list.replaceChildren(...ENTRIES.filter(({ layer }) => offered(run, layer)).map((entry) => row(store, entry))));
  store.on(["layers"], ({ layers }) => {
    for (const box of list.querySelectorAll<HTMLInputElement>("input[data-layer]")) box.checked = layers[box.dataset["layer"] as Layer];
  });
  return element("div", {}, list, deformation(store), width(store));
}

function row(store: Store, { layer, text, key, coloured }: Entry): HTMLElement {
  const box = element("input", { type: "checkbox", "data-layer": layer, checked: store.state.layers[layer], change: () => toggle(store, layer) });
  const label = element("label", {}, box, element("span", {}, text), element("kbd", { "aria-hidden": "true" }, key));
  const extra = coloured ? colour(store, coloured) : layer === "modes" ? modes(store) : null;
  return element("li", {}, label, extra);
}

function colour(store: Store, layer: Coloured): HTMLElement {
  const options: [string, string][] = [["", UNCOLOURED[layer]]];
  for (const column of colourColumns(store.state.run, layer)) options.push([column.name, withUnit(column)]);
  return choices(`Colour of ${layer === "cells" ? "void cells" : layer}`, new Map([["", options]]), store.state.colour[layer], (name) => {
    const { colour, range, layers } = store.state;
    store.set({ colour: { ...colour, [layer]: name }, range: { ...range, [layer]: null }, layers: { ...layers, [layer]: true } });
  });
}

function modes(store: Store): HTMLElement {
  const input = element("input", {
    type: "number", min: 0, step: 1, value: store.state.mode, "aria-label": "Number of the mode, lowest first",
    change: () => store.set({ mode: Math.max(0, Math.round(input.valueAsNumber) || 0) }),
  });
  return input;
}

/** The slider runs over powers of ten, with 0 at its left end. */
const POWERS = { low: -1, high: 5 };
const TICKS = 240;

function deformation(store: Store): HTMLElement {
  const slider = element("input", {
    type: "range", min: 0, max: TICKS, step: 1, "aria-label": "Scale of the displacements",
    input: () => store.set({ factor: factorAt(slider.valueAsNumber) }),
  });
  const number = element("input", {
    type: "number", min: 0, step: "any", "aria-label": "Scale of the displacements, as a number",
    change: () => store.set({ factor: Number.isFinite(number.valueAsNumber) ? Math.max(0, number.valueAsNumber) : 1 }),
  });
  const real = element("button", { title: "As it is", click: () => store.set({ factor: 1 }) }, "×1");
  store.on(["factor"], ({ factor }) => {
    slider.value = String(tickAt(factor));
    slider.setAttribute("aria-valuetext", `displacements times ${factor}`);
    number.value = String(factor);
  });
  return element("div", { class: "field", role: "group", "aria-label": "Deformation" }, element("span", {}, "Displacements ×"), slider, number, real);
}

function factorAt(tick: number): number {
  if (tick === 0) return 0;
  return Number((10 ** (POWERS.low + (tick / TICKS) * (POWERS.high - POWERS.low))).toPrecision(2));
}

function tickAt(factor: number): number {
  if (factor <= 0) return 0;
  return Math.max(1, ((Math.log10(factor) - POWERS.low) / (POWERS.high - POWERS.low)) * TICKS);
}

function width(store: Store): HTMLElement {
  const slider = element("input", {
    type: "range", min: 0.1, max: 3, step: 0.05, value: store.state.width, "aria-label": "Width of the forces",
    input: () => store.set({ width: slider.valueAsNumber }),
  });
  return element("div", { class: "field" }, element("span", {}, "Width of forces"), slider);
}

export function nameOf(layer: Layer): string {
  return ENTRIES.find((entry) => entry.layer === layer)?.text ?? spoken(layer);
}
