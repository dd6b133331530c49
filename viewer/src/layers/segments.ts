import { FETCH, FRAGMENT, type DataTexture, type Gl, type Program, type Uniform } from "../gl";
import { COLOUR, VIEW, type View } from "./view";

// A row of u_ends: the two ends as they are drawn. A row of u_styles: width and value; a negative width is that of a
// negative force.
const READ = `${FETCH}${VIEW}${COLOUR}
uniform sampler2D u_ends, u_styles;
uniform float u_width;
vec2 across(vec4 ends) {
  vec2 along = ends.zw - ends.xy;
  return vec2(-along.y, along.x) * inversesqrt(max(dot(along, along), 1e-30));
}
const vec4 NOWHERE = vec4(2.0, 2.0, 0.0, 1.0);
`;

const quad = (signed: boolean): string => `${READ}
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
  gl_Position = width < 0.01 ? NOWHERE : place(point + across(ends) * (v_across / u_scale));
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
// wide and their colour thin, so that none falls between the pixels.
const hairline = (signed: boolean): string => `${READ}
flat out vec2 v_paint;
void main() {
  int number = third(gl_VertexID), corner = gl_VertexID - 3 * number;
  vec2 style = row(u_styles, number).xy;
  float width = u_width * abs(style.x);
  vec4 ends = row(u_ends, number);
  v_paint = vec2(0.6 * u_plain.a * min(width, 1.0), ${signed ? "style.x" : "tone(style.y)"});
  vec2 point = corner == 2 ? ends.zw : ends.xy + across(ends) * ((corner == 0 ? 1.2 : -1.2) / u_scale);
  gl_Position = width < 0.01 ? NOWHERE : place(point);
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
    private readonly gl: Gl, readonly count: number, private readonly write: (rows: Float32Array, factor: number) => void, readonly shared = false,
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

export interface Segments {
  ends: Ends;
  styles: DataTexture;
  /** Largest width there is, as `styles` gives it. */
  widest: number;
}

export interface SegmentStyle {
  uniforms: Record<string, Uniform>;
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
    const thin = segments.widest * style.width < 2.5 && count > FEW;
    const uniforms = { ...view.uniforms, ...style.uniforms, u_width: style.width };
    this.program(thin, style.signed).draw(gl.TRIANGLES, count * (thin ? 3 : 6), uniforms, {
      u_ends: segments.ends.at(style.factor).texture, u_styles: segments.styles.texture, u_map: style.map,
    });
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
