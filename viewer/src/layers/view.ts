import type { Camera } from "../camera";
import type { Uniform } from "../gl";

/** What every shader knows of the picture. */
export interface View {
  uniforms: Record<string, Uniform>;
  /** Pixels of the canvas for a unit of length. */
  scale: number;
  /** Pixels of the canvas for one of the style sheet. */
  density: number;
}

export function viewOf(camera: Camera, density: number, factor: number): View {
  const scale = camera.scale * density;
  return {
    scale,
    density,
    uniforms: {
      u_middle: [camera.x, camera.y],
      u_clip: [(2 * camera.scale) / camera.width, (2 * camera.scale) / camera.height],
      u_size: [camera.width * density, camera.height * density],
      u_scale: scale,
      u_factor: factor,
    },
  };
}

export const VIEW = `
uniform vec2 u_middle, u_clip, u_size;
uniform float u_scale, u_factor;
vec4 place(vec2 point) {
  return vec4((point - u_middle) * u_clip, 0.0, 1.0);
}
`;

/** Tone, from 0 to 1, and colour of a value; −1 is the tone of none; values that do not exist are 1e38 and more. */
export const COLOUR = `
uniform sampler2D u_map;
uniform vec2 u_range;
uniform vec4 u_plain;
uniform bool u_mapped;
float tone(float value) {
  return !u_mapped || value > 1e37 ? -1.0 : clamp((value - u_range.x) / (u_range.y - u_range.x), 0.0, 1.0);
}
vec3 colourOf(float tone) {
  return tone < 0.0 ? u_plain.rgb : texelFetch(u_map, ivec2(int(tone * 255.0 + 0.5), 0), 0).rgb;
}
vec3 colour(float value) {
  return colourOf(tone(value));
}
`;

export const MISSING = 3e38;

export function shaderValue(value: number | undefined): number {
  return value === undefined || value !== value || value === -2147483648 ? MISSING : value;
}
