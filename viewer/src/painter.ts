import { radiiOf, SPOKES_UP_TO, type Drawn, type Picture } from "./assembly";
import type { Camera } from "./camera";
import { MAP_SIZE, pixels, type MapName, type Scale } from "./colour";
import type { Gl, Uniform } from "./gl";
import { GrainLayer } from "./layers/grains";
import { SegmentLayer, type Segments } from "./layers/segments";
import { TriangleLayer } from "./layers/triangles";
import { viewOf, type View } from "./layers/view";
import { PALETTES, unit, type Palette } from "./palette";
import { container } from "./pieces";
import type { State } from "./store";

/** Draws a picture; knows the order of the layers and their colours. */
export class Painter {
  private readonly grains: GrainLayer;
  private readonly segments: SegmentLayer;
  private readonly triangles: TriangleLayer;
  private readonly maps = new Map<string, WebGLTexture>();
  private frame: { edges: unknown; factor: number; segments: Segments } | null = null;

  constructor(private readonly gl: Gl, private readonly canvas: HTMLCanvasElement) {
    this.grains = new GrainLayer(gl);
    this.segments = new SegmentLayer(gl);
    this.triangles = new TriangleLayer(gl);
  }

  draw(state: State, picture: Picture | null, camera: Camera): void {
    const density = this.fitCanvas(camera, picture?.count ?? 0);
    const palette = PALETTES[state.theme];
    const gl = this.gl.context;
    const [red, green, blue] = unit(palette.ground) as [number, number, number];
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.clearColor(red, green, blue, 1);
    gl.clear(gl.COLOR_BUFFER_BIT);
    if (!picture) return;
    const view = viewOf(camera, density, state.factor);
    this.drawCells(view, state, picture, palette);
    if (state.layers.grains) this.drawGrains(view, state, picture, palette);
    if (state.layers.container) this.drawContainer(view, state, picture, palette);
    this.drawLines(view, state, picture, palette);
  }

  private drawGrains(view: View, state: State, picture: Picture, palette: Palette): void {
    this.grains.draw(view, picture.shapes, picture.moves, picture.count, {
      uniforms: {
        ...mapping(picture.scales.grains, unit(palette.grain, 1)),
        u_ground: unit(palette.ground), u_rim: unit(palette.rim),
        u_outside: state.layers.window ? 0.3 : 1, u_spokes: picture.count <= SPOKES_UP_TO,
      },
      map: this.map(picture.scales.grains, state.theme),
      largest: radiiOf(picture.body).largest,
    });
  }

  private drawCells(view: View, state: State, picture: Picture, palette: Palette): void {
    if (!picture.cells) return;
    const scale = picture.scales.cells;
    this.triangles.draw(view, picture.shapes, picture.moves, picture.cells, mapping(scale, unit(palette.cell, 1)), this.map(scale, state.theme));
  }

  private drawContainer(view: View, state: State, picture: Picture, palette: Palette): void {
    this.line(view, state, this.containerOf(picture, state.factor), view.density, { u_plain: unit(palette.container, 0.9) });
  }

  private containerOf({ edges }: Picture, factor: number): Segments {
    if (this.frame?.edges !== edges || this.frame.factor !== factor) {
      const { ends, styles } = this.frame?.segments ?? {};
      for (const texture of [...(ends?.textures ?? []), ...(styles?.textures ?? [])]) this.gl.context.deleteTexture(texture);
      this.frame = { edges, factor, segments: container(this.gl, edges, factor) };
    }
    return this.frame.segments;
  }

  private drawLines(view: View, state: State, picture: Picture, palette: Palette): void {
    const signs = { u_below: unit(palette.compression), u_above: unit(palette.tension), u_plain: [0, 0, 0, 1] };
    const scales = picture.scales;
    const radius = radiiOf(picture.body).mean * view.scale;
    const hair = view.density * Math.min(Math.max(0.08 * radius, 0.5), 2);
    const styles: [Drawn, number, Record<string, Uniform>, Scale?][] = [
      ["dual", hair, { u_plain: unit(palette.dual, 0.9) }],
      ["graph", 1.4 * hair, { u_plain: unit(palette.graph, 0.9) }],
      ["forces", state.width * radius,
        state.colour.forces ? mapping(scales.forces, unit(palette.graph, 1)) : signs, state.colour.forces ? scales.forces : undefined],
      ["broken", Math.max(3 * hair, 2 * view.density), mapping(scales.broken, unit(palette.mode, 1)), scales.broken],
      ["modes", 1.6 * hair, { u_plain: unit(palette.mode, 1) }],
      ["fabric", 2 * view.density, { u_plain: unit(palette.fabric, 1) }],
      ["stress", 2.4 * view.density, signs],
    ];
    for (const [name, width, uniforms, scale] of styles) {
      const segments = picture.segments[name];
      if (segments) this.line(view, state, segments, width, uniforms, this.map(scale, state.theme));
    }
  }

  private line(view: View, state: State, segments: Segments, width: number, uniforms: Record<string, Uniform>, map = this.map(undefined, "light")): void {
    const plain = { u_mapped: false, u_range: [0, 1] };
    this.segments.draw(view, segments, { uniforms: { ...plain, ...uniforms }, map, width, factor: state.factor, signed: "u_above" in uniforms });
  }

  private map(scale: Scale | undefined, theme: "light" | "dark"): WebGLTexture {
    const name: MapName = scale?.map ?? "sequential";
    const key = `${name} ${theme}`;
    let map = this.maps.get(key);
    if (!map) this.maps.set(key, (map = this.gl.colours(pixels(name, theme))));
    return map;
  }

  /** Many grains are drawn with one pixel of the canvas for one of the style sheet, whatever the screen has. */
  private fitCanvas(camera: Camera, count: number): number {
    const density = count > 300000 ? 1 : Math.min(globalThis.devicePixelRatio || 1, 2);
    const width = Math.round(camera.width * density);
    const height = Math.round(camera.height * density);
    if (this.canvas.width !== width || this.canvas.height !== height) Object.assign(this.canvas, { width, height });
    return density;
  }
}

function mapping(scale: Scale | undefined, plain: number[]): Record<string, Uniform> {
  const range = scale?.map === "words" ? [0, MAP_SIZE - 1] : [scale?.range.low ?? 0, scale?.range.high ?? 1];
  return { u_mapped: scale !== undefined, u_range: range, u_plain: plain };
}
