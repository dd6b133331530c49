import { FETCH, FRAGMENT, type DataTexture, type Gl, type Program, type Uniform } from "../gl";
import { COLOUR, VIEW, type View } from "./view";

/** Widths in `styles` are not larger. */
export const WIDEST = 2.5;

// A row of u_ends: the two ends as they are drawn. A row of u_styles: width and value; a negative width is that of a
// negative force.
const quad = (signed: boolean): string => `${FETCH}${VIEW}${COLOUR}
uniform sampler2D u_ends, u_styles;
uniform float u_width;
uniform vec3 u_above, u_below;
flat out vec4 v_colour;
out float v_across;
flat out float v_half;
void main() {
  int number = third(gl_VertexID >> 1), corner = gl_VertexID - 6 * number;
  vec2 style = row(u_styles, number).xy;
  float width = u_width * abs(style.x);
  vec4 ends = row(u_ends, number);
  v_colour = vec4(${signed ? "style.x < 0.0 ? u_below : u_above" : "colour(style.y)"}, u_plain.a * min(width, 1.0));
  v_half = 0.5 * max(width, 1.0);
  v_across = ((corner & 1) == 0 ? -1.0 : 1.0) * (v_half + 0.5);
  vec2 point = corner == 0 || corner == 1 || corner == 3 ? ends.xy : ends.zw;
  vec2 along = ends.zw - ends.xy;
  vec2 across = vec2(-along.y, along.x) * inversesqrt(max(dot(along, along), 1e-30));
  gl_Position = width < 0.01 ? vec4(2.0, 2.0, 0.0, 1.0) : place(point + across * (v_across / u_scale));
}`;

const QUAD_SHADE = `${FRAGMENT}
flat in vec4 v_colour;
flat in float v_half;
in float v_across;
out vec4 o_colour;
void main() {
  o_colour = vec4(v_colour.rgb, v_colour.a * clamp(v_half + 0.5 - abs(v_across), 0.0, 1.0));
}`;

// Where lines are a few pixels long, hairlines are single triangles, half the work of quads and no worse. Their base is
// wide and their colour thin, so that none falls between the pixels. A row of u_hairs: the first end; the way to the
// second, in parts of u_reach; width and tone. The last two are pairs of numbers of 12 bits.
const hairline = (signed: boolean): string => `${FETCH}${VIEW}${COLOUR}
uniform sampler2D u_hairs;
uniform float u_width, u_reach;
flat out vec2 v_paint;
vec2 unpack(float pair) {
  float second = floor(pair / 4096.0);
  return vec2(pair - 4096.0 * second, second);
}
void main() {
  int number = third(gl_VertexID), corner = gl_VertexID - 3 * number;
  vec4 hair = row(u_hairs, number);
  vec2 style = unpack(hair.w);
  float width = u_width * style.x * ${WIDEST / 4095};
  vec2 along = (unpack(hair.z) - 2048.0) * (u_reach / 2047.0);
  vec2 across = vec2(-along.y, along.x) * inversesqrt(max(dot(along, along), 1e-30));
  v_paint = vec2(0.6 * u_plain.a * min(width, 1.0), (style.y - ${signed ? "2.0" : "1.0) * (1.0 / 4094.0"}));
  vec2 point = hair.xy + (corner == 2 ? along : across * ((corner == 0 ? 1.2 : -1.2) / u_scale));
  gl_Position = width < 0.01 ? vec4(2.0, 2.0, 0.0, 1.0) : place(point);
}`;

const hairlineShade = (signed: boolean): string => `${FRAGMENT}${COLOUR}
uniform vec3 u_above, u_below;
flat in vec2 v_paint;
out vec4 o_colour;
void main() {
  o_colour = vec4(${signed ? "v_paint.y < 0.0 ? u_below : u_above" : "colourOf(v_paint.y)"}, v_paint.x);
}`;

/** Ends of segments, made anew when the scale of the displacements changes. */
export class Ends {
  private made: { factor: number; data: DataTexture } | null = null;

  /** Shared ends are not freed with the segments that use them. */
  constructor(
    private readonly gl: Gl, readonly count: number, readonly write: (rows: Float32Array, factor: number) => void, readonly shared = false,
  ) {}

  get textures(): WebGLTexture[] {
    return this.made ? [this.made.data.texture] : [];
  }

  at(factor: number): DataTexture {
    if (this.made?.factor !== factor) {
      if (this.made) this.gl.context.deleteTexture(this.made.data.texture);
      this.made = { factor, data: this.gl.data(this.count, 4, (rows) => this.write(rows, factor)) };
    }
    return this.made.data;
  }
}

/** Width and value of segments. */
export class Styles {
  private data: DataTexture | null = null;

  constructor(private readonly gl: Gl, readonly rows: Float32Array) {}

  get texture(): DataTexture {
    return (this.data ??= this.gl.data(this.rows.length / 2, 2, (rows) => rows.set(this.rows)));
  }

  get textures(): WebGLTexture[] {
    return this.data ? [this.data.texture] : [];
  }
}

/** Hairlines of segments, made anew for another scale of the displacements or another range of the values. */
class Hairs {
  private key = "";
  private data: DataTexture | null = null;
  private reach = 1;

  constructor(private readonly gl: Gl) {}

  at({ ends, styles }: Segments, factor: number, range: readonly number[], signed: boolean): { data: DataTexture; reach: number } {
    const key = `${factor} ${range.join()} ${signed}`;
    if (!this.data || key !== this.key) {
      this.textures.forEach((texture) => this.gl.context.deleteTexture(texture));
      this.data = this.gl.data(ends.count, 4, (rows) => {
        ends.write(rows, factor);
        this.reach = pack(rows, styles.rows, ends.count, range, signed);
      });
      this.key = key;
    }
    return { data: this.data, reach: this.reach };
  }

  get textures(): WebGLTexture[] {
    return this.data ? [this.data.texture] : [];
  }
}

/** Turns rows of ends into rows of hairlines; gives the longest way along an axis. */
function pack(rows: Float32Array, styles: Float32Array, count: number, range: readonly number[], signed: boolean): number {
  let reach = 1e-30;
  for (let i = 0; i < 4 * count; i += 4) {
    reach = Math.max(reach, Math.abs(rows[i + 2]! - rows[i]!), Math.abs(rows[i + 3]! - rows[i + 1]!));
  }
  const [low, high] = range as [number, number];
  for (let i = 0; i < count; i++) {
    const at = 4 * i;
    const [width, value] = [styles[2 * i]!, styles[2 * i + 1]!];
    const x = 2048 + Math.round((2047 * (rows[at + 2]! - rows[at]!)) / reach);
    const y = 2048 + Math.round((2047 * (rows[at + 3]! - rows[at + 1]!)) / reach);
    const tone = value > 1e37 ? 0 : 1 + Math.round(4094 * Math.min(Math.max((value - low) / (high - low), 0), 1));
    rows[at + 2] = x + 4096 * y;
    rows[at + 3] = Math.round((4095 * Math.min(Math.abs(width), WIDEST)) / WIDEST) + 4096 * (signed ? (width < 0 ? 1 : 3) : tone);
  }
  return reach;
}

export interface Segments {
  ends: Ends;
  styles: Styles;
  /** Largest width there is, as `styles` gives it. */
  widest: number;
  hairs?: Hairs;
}

export interface SegmentStyle {
  uniforms: Record<string, Uniform> & { u_range: readonly number[] };
  map: WebGLTexture;
  /** Pixels for a width of 1 in `styles`. */
  width: number;
  factor: number;
  /** Coloured by the sign of the width, not by the value. */
  signed: boolean;
}

const FEW = 20000;

/** Straight lines with a width and a colour each. */
export class SegmentLayer {
  private readonly programs = new Map<string, Program>();

  constructor(private readonly gl: Gl) {}

  draw(view: View, segments: Segments, style: SegmentStyle): void {
    const gl = this.gl.context;
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    const count = segments.ends.count;
    const uniforms = { ...view.uniforms, ...style.uniforms, u_width: style.width };
    const thin = segments.widest * style.width < 2.5 && count > FEW;
    const program = this.program(thin, style.signed);
    if (thin) {
      const { data, reach } = this.hairsOf(segments).at(segments, style.factor, style.uniforms.u_range, style.signed);
      program.draw(gl.TRIANGLES, 3 * count, { ...uniforms, u_reach: reach }, { u_hairs: data.texture, u_map: style.map });
    } else {
      const [ends, styles] = [segments.ends.at(style.factor), segments.styles.texture];
      program.draw(gl.TRIANGLES, 6 * count, uniforms, { u_ends: ends.texture, u_styles: styles.texture, u_map: style.map });
    }
  }

  private hairsOf(segments: Segments): Hairs {
    return (segments.hairs ??= new Hairs(this.gl));
  }

  private program(thin: boolean, signed: boolean): Program {
    const key = `${thin} ${signed}`;
    let program = this.programs.get(key);
    if (!program) {
      program = thin ? this.gl.program(hairline(signed), hairlineShade(signed)) : this.gl.program(quad(signed), QUAD_SHADE);
      this.programs.set(key, program);
    }
    return program;
  }
}
