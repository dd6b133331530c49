import { FETCH, FRAGMENT, type DataTexture, type Gl, type Program, type Uniform } from "../gl";
import { COLOUR, VIEW, type View } from "./view";

// A grain is one triangle around its disc. Every grain covers at least one pixel.
const VERTEX = `${FETCH}${VIEW}${COLOUR}
uniform sampler2D u_shapes, u_moves;
uniform float u_outside;
uniform vec3 u_ground;
flat out vec3 v_fill;
flat out float v_radius;
flat out vec2 v_spoke;
out vec2 v_pixels;
void main() {
  int grain = third(gl_VertexID);
  vec4 shape = row(u_shapes, grain), move = row(u_moves, grain);
  float radius = max(shape.z * u_scale, 0.71);
  vec2 centre = shape.xy + u_factor * move.xy;
  v_radius = radius;
  v_fill = mix(u_ground, colour(move.w), shape.w > 0.5 ? 1.0 : u_outside);
  int corner = gl_VertexID - 3 * grain;
  vec2 way = corner == 0 ? vec2(-1.7320508, -1.0) : corner == 1 ? vec2(1.7320508, -1.0) : vec2(0.0, 2.0);
  float reach = radius > 2.0 ? radius + 0.5 : radius;
  float turn = u_factor * move.z;
  v_pixels = way * reach;
  v_spoke = vec2(cos(turn), sin(turn));
  gl_Position = place(centre + way * (reach / u_scale));
}`;

const SHADE = `${FRAGMENT}
flat in vec3 v_fill;
flat in float v_radius;
flat in vec2 v_spoke;
in vec2 v_pixels;
uniform vec3 u_rim;
uniform bool u_spokes;
out vec4 o_colour;
void main() {
  float square = dot(v_pixels, v_pixels);
  if (v_radius < 2.0) {
    if (square > v_radius * v_radius) discard;
    o_colour = vec4(v_fill, 1.0);
    return;
  }
  float distance = sqrt(square), inside = v_radius - distance;
  float alpha = clamp(inside + 0.5, 0.0, 1.0);
  if (alpha <= 0.0) discard;
  float rim = v_radius < 4.0 ? 0.0 : clamp(1.5 - inside, 0.0, 1.0) * min(1.0, (v_radius - 4.0) / 6.0);
  float spoke = 0.0;
  if (u_spokes && v_radius > 9.0) {
    float across = abs(v_pixels.x * v_spoke.y - v_pixels.y * v_spoke.x);
    float along = dot(v_pixels, v_spoke);
    if (along > 0.55 * v_radius) spoke = clamp(1.1 - across, 0.0, 1.0) * min(1.0, (v_radius - 9.0) / 9.0);
  }
  o_colour = vec4(mix(v_fill, u_rim, 0.55 * max(rim, spoke)), alpha);
}`;

// Small grains have no rim, and less is handed on to their pixels: the tone, less 4 outside the window.
const SMALL_VERTEX = `${FETCH}${VIEW}${COLOUR}
uniform sampler2D u_shapes, u_moves;
flat out float v_tone;
out vec2 v_way;
void main() {
  int grain = third(gl_VertexID), corner = gl_VertexID - 3 * grain;
  vec4 shape = row(u_shapes, grain), move = row(u_moves, grain);
  v_way = corner == 0 ? vec2(-1.7320508, -1.0) : corner == 1 ? vec2(1.7320508, -1.0) : vec2(0.0, 2.0);
  v_tone = tone(move.w) - (shape.w > 0.5 ? 0.0 : 4.0);
  gl_Position = place(shape.xy + u_factor * move.xy + v_way * max(shape.z, 0.71 / u_scale));
}`;

const SMALL_SHADE = `${FRAGMENT}${COLOUR}
flat in float v_tone;
in vec2 v_way;
uniform float u_outside;
uniform vec3 u_ground;
out vec4 o_colour;
void main() {
  if (dot(v_way, v_way) > 1.0) discard;
  bool outside = v_tone < -2.0;
  vec3 fill = colourOf(outside ? v_tone + 4.0 : v_tone);
  o_colour = vec4(outside ? mix(u_ground, fill, u_outside) : fill, 1.0);
}`;

/** Up to this radius, in pixels, all grains are small. */
const SMALL = 2;

export interface GrainStyle {
  uniforms: Record<string, Uniform>;
  map: WebGLTexture;
  /** Radius of the largest grain. */
  largest: number;
}

/** Discs, filled by the colour of a column. */
export class GrainLayer {
  private readonly program: Program;
  private readonly small: Program;

  constructor(private readonly gl: Gl) {
    this.program = gl.program(VERTEX, SHADE);
    this.small = gl.program(SMALL_VERTEX, SMALL_SHADE);
  }

  draw(view: View, shapes: DataTexture, moves: DataTexture, count: number, style: GrainStyle): void {
    const gl = this.gl.context;
    const small = style.largest * view.scale < SMALL;
    if (small) gl.disable(gl.BLEND);
    else gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    (small ? this.small : this.program).draw(gl.TRIANGLES, 3 * count, { ...view.uniforms, ...style.uniforms }, {
      u_shapes: shapes.texture, u_moves: moves.texture, u_map: style.map,
    });
  }
}
