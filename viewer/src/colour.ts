import type { Numbers, Column } from "./source";
import { NONE } from "./run";
import type { Range } from "./store";

export type Rgb = [number, number, number];
export type MapName = "sequential" | "order" | "diverging" | "words";

// Stops of viridis and cividis (Nuñez, Anderton and Renslow 2018; both read by the colour-blind), evenly spaced.
const VIRIDIS = "440154 482878 3e4989 31688e 26828e 1f9e89 35b779 6ece58 b5de2b fde725";
const CIVIDIS = "00224e 123570 3b496c 575d6d 707173 8a8678 a59c74 c3b369 e1cc55 fee838";
// Blue for less, orange for more; the middle is near the ground of the picture.
const DIVERGING = {
  light: "0b3c7d 2f6fb5 7fb0dc d3e3ee f1efeb f7ddc0 efae6a cc6f1b 8a3f05",
  dark: "9fd0ff 5aa6ec 2f75b8 2c4e72 3d4147 6b4c2c b06a1f ee9a3a ffcf94",
};
// Okabe and Ito (2008).
const WORDS = "0072b2 e69f00 009e73 cc79a7 56b4e9 d55e00 f0e442 8c8c8c";

export const MAP_SIZE = 256;

function stops(text: string): Rgb[] {
  return text.split(" ").map((hex) => [0, 2, 4].map((at) => parseInt(hex.slice(at, at + 2), 16)) as Rgb);
}

function stopsOf(map: MapName, theme: "light" | "dark"): Rgb[] {
  if (map === "sequential") return stops(VIRIDIS);
  if (map === "order") return stops(CIVIDIS);
  return stops(map === "words" ? WORDS : DIVERGING[theme]);
}

/** Colour at a place between 0 and 1. */
export function colourAt(map: MapName, theme: "light" | "dark", place: number): Rgb {
  const list = stopsOf(map, theme);
  const at = Math.min(Math.max(place, 0), 1) * (list.length - 1);
  const index = Math.min(Math.floor(at), list.length - 2);
  const [from, to] = [list[index]!, list[index + 1]!];
  return from.map((value, k) => value + (to[k]! - value) * (at - index)) as Rgb;
}

/** Colour of the code of a word. */
export function colourOfWord(code: number): Rgb {
  const list = stops(WORDS);
  return list[code % list.length]!;
}

export function css([red, green, blue]: Rgb): string {
  return `rgb(${Math.round(red)} ${Math.round(green)} ${Math.round(blue)})`;
}

/** The map as a row of a texture. */
export function pixels(map: MapName, theme: "light" | "dark"): Uint8Array {
  const row = new Uint8Array(4 * MAP_SIZE).fill(255);
  for (let at = 0; at < MAP_SIZE; at++) {
    row.set(map === "words" ? colourOfWord(at) : colourAt(map, theme, at / (MAP_SIZE - 1)), 4 * at);
  }
  return row;
}

/** How a column becomes colours. */
export interface Scale {
  map: MapName;
  range: Range;
  /** Lowest and highest value there are. */
  extent: Range;
  names: string[] | null;
  unit: string;
}

/** Share of the values that may lie beyond either end of the range. */
const BEYOND = 0.005;

/** The map of a column: around 0 if there are values on both sides of it. */
export function scaleOf(column: Column, held: Range | null, ordered = false): Scale {
  const { names, unit } = column;
  if (names) return { map: "words", range: { low: 0, high: MAP_SIZE - 1 }, extent: { low: 0, high: names.length - 1 }, names, unit };
  const extent = extentOf(column.values);
  const diverges = extent.low < 0 && extent.high > 0;
  const map = ordered ? "order" : diverges ? "diverging" : "sequential";
  const range = held ?? (ordered ? extent : bulk(column.values, extent, diverges));
  return { map, range: wide(range), extent, names, unit };
}

function exists(value: number): boolean {
  return value === value && value !== NONE;
}

function extentOf(values: Numbers): Range {
  let [low, high] = [Infinity, -Infinity];
  for (let i = 0; i < values.length; i++) {
    const value = values[i]!;
    if (!exists(value)) continue;
    if (value < low) low = value;
    if (value > high) high = value;
  }
  return low > high ? { low: 0, high: 0 } : { low, high };
}

/** The range without the few most extreme values, which would leave all others one colour. */
function bulk(values: Numbers, extent: Range, diverges: boolean): Range {
  const every = Math.max(1, Math.floor(values.length / 20000));
  const sample: number[] = [];
  for (let i = 0; i < values.length; i += every) if (exists(values[i]!)) sample.push(values[i]!);
  if (sample.length < 100) return diverges ? symmetric(extent) : extent;
  const sorted = Float64Array.from(sample).sort();
  const cut = Math.floor(BEYOND * sorted.length);
  const range = { low: sorted[cut]!, high: sorted[sorted.length - 1 - cut]! };
  return diverges ? symmetric(range) : range;
}

function symmetric({ low, high }: Range): Range {
  const size = Math.max(Math.abs(low), Math.abs(high));
  return { low: -size, high: size };
}

/** Values that differ by rounding only are one colour. */
function wide({ low, high }: Range): Range {
  const size = Math.max(Math.abs(low), Math.abs(high));
  if (high - low > 1e-6 * size) return { low, high };
  const half = size > 0 ? 0.5 * size : 0.5;
  return { low: (low + high) / 2 - half, high: (low + high) / 2 + half };
}
