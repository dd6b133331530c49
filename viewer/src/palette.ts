import type { Rgb } from "./colour";

/** Colours of what no column colours. */
export interface Palette {
  ground: Rgb;
  grain: Rgb;
  rim: Rgb;
  compression: Rgb;
  tension: Rgb;
  graph: Rgb;
  dual: Rgb;
  cell: Rgb;
  container: Rgb;
  fabric: Rgb;
  mode: Rgb;
}

export const PALETTES: Record<"light" | "dark", Palette> = {
  light: {
    ground: [252, 252, 250], grain: [216, 221, 226], rim: [38, 50, 63],
    compression: [24, 88, 158], tension: [206, 96, 10],
    graph: [74, 88, 102], dual: [128, 84, 140], cell: [224, 229, 233], container: [70, 80, 92],
    fabric: [17, 94, 76], mode: [150, 30, 84],
  },
  dark: {
    ground: [17, 21, 26], grain: [56, 65, 76], rim: [8, 11, 14],
    compression: [104, 178, 244], tension: [255, 170, 80],
    graph: [150, 163, 177], dual: [196, 154, 208], cell: [36, 43, 51], container: [150, 160, 172],
    fabric: [98, 206, 176], mode: [240, 130, 180],
  },
};

export function unit([red, green, blue]: Rgb, alpha?: number): number[] {
  const made = [red / 255, green / 255, blue / 255];
  return alpha === undefined ? made : [...made, alpha];
}
