import type { Picture } from "./assembly";
import { colourAt, colourOfWord, css, type Scale } from "./colour";
import { element } from "./dom";
import { PALETTES } from "./palette";
import { short, spoken, withUnit } from "./run";
import type { Coloured, Range, State, Store } from "./store";

/** Meaning of the colours in the picture. */
export class Legend {
  readonly node = element("div", { class: "legend", role: "group", "aria-label": "Legend" });
  private shown = "";

  constructor(private readonly store: Store) {}

  update(state: State, picture: Picture | null): void {
    if (!picture) return;
    const { scales } = picture;
    const key = JSON.stringify([scales, state.theme, state.colour, state.layers, state.range, picture.wholes, picture.mode?.eigenvalue]);
    if (key === this.shown) return;
    this.shown = key;
    const parts = [
      scales.grains && state.layers.grains ? this.bar("grains", state.colour.grains, scales.grains, state) : null,
      scales.cells ? this.bar("cells", state.colour.cells, scales.cells, state) : null,
      scales.forces && state.colour.forces ? this.bar("forces", state.colour.forces, scales.forces, state) : null,
      scales.forces && !state.colour.forces ? this.signs(scales.forces, state) : null,
      scales.broken ? this.bar(null, "order of breaking", scales.broken, state) : null,
      ...this.crosses(state, picture),
      picture.mode ? element("p", {}, `Mode ${state.mode} of ${picture.mode.count}: eigenvalue ${short(picture.mode.eigenvalue)}`) : null,
    ];
    this.node.replaceChildren(...parts.filter((part) => part !== null));
  }

  private bar(layer: Coloured | null, name: string, scale: Scale, state: State): HTMLElement {
    const title = layer ? `${layer === "grains" ? "grains: " : layer === "cells" ? "void cells: " : "forces: "}` : "";
    const heading = element("p", {}, title, element("b", {}, withUnit({ name, unit: scale.unit })));
    if (scale.names) return element("div", { class: "scale" }, heading, words(scale.names));
    const gradient = element("div", { class: "gradient" });
    const stops = Array.from({ length: 17 }, (_, k) => css(colourAt(scale.map, state.theme, k / 16)));
    gradient.style.background = `linear-gradient(to right, ${stops.join(",")})`;
    return element("div", { class: "scale" }, heading, gradient, layer ? this.ends(layer, scale, state) : fixed(scale));
  }

  /** The ends of the range, which can be typed over, and a button that holds it while load steps change. */
  private ends(layer: Coloured, scale: Scale, state: State): HTMLElement {
    const { range, extent } = scale;
    const held = state.range[layer] !== null;
    const hold = (value: Range | null): void => this.store.set({ range: { ...this.store.state.range, [layer]: value } });
    const input = (end: keyof Range, beyond: boolean): HTMLElement => {
      const field = element("input", {
        class: "end", value: `${beyond ? (end === "low" ? "≤ " : "≥ ") : ""}${short(range[end])}`, "aria-label": `Colours of ${layer}: ${end === "low" ? "lowest" : "highest"} value`,
        change: () => {
          const typed = Number(field.value.replace(/[≤≥\s]/g, "").replace("−", "-"));
          const next = { ...range, [end]: typed };
          if (Number.isFinite(typed) && next.low < next.high) hold(next);
          else field.value = short(range[end]);
        },
      });
      return field;
    };
    return element("div", { class: "ends" }, input("low", extent.low < range.low),
      element("button", {
        "aria-pressed": held, title: held ? "Fit the colours to every load step" : "Keep these colours over all load steps",
        click: () => hold(held ? null : range),
      }, held ? "held" : "hold"),
      input("high", extent.high > range.high));
  }

  private signs(scale: Scale, state: State): HTMLElement {
    const palette = PALETTES[state.theme];
    const line = (colour: string, text: string): HTMLElement => {
      const swatch = element("i", { class: "line" });
      swatch.style.background = colour;
      return element("li", {}, swatch, text);
    };
    const most = Math.max(Math.abs(scale.extent.low), Math.abs(scale.extent.high));
    return element("div", { class: "scale" },
      element("p", {}, "forces: ", element("b", {}, withUnit({ name: "normal_force", unit: scale.unit }))),
      element("ul", { class: "words" }, line(css(palette.compression), "compression"), line(css(palette.tension), "tension")),
      element("p", {}, `largest ${short(most)}`));
  }

  private crosses(state: State, picture: Picture): HTMLElement[] {
    return (["stress", "fabric"] as const).flatMap((kind) => {
      const whole = picture.wholes[kind];
      if (!state.layers[kind] || !whole) return [];
      const degrees = short(Number(((whole.angle * 180) / Math.PI).toFixed(1)));
      return [element("p", {}, element("b", {}, `principal ${kind}`), ` of the window: ${short(whole.major)} at ${degrees}°, ${short(whole.minor)} across`)];
    });
  }
}

function fixed({ range }: Scale): HTMLElement {
  return element("div", { class: "ends" }, element("span", {}, `event ${short(range.low)}`), element("span", {}, short(range.high)));
}

function words(names: string[]): HTMLElement {
  return element("ul", { class: "words" }, ...names.map((name, code) => {
    const swatch = element("i");
    swatch.style.background = css(colourOfWord(code));
    return element("li", {}, swatch, spoken(name) || "none");
  }));
}
