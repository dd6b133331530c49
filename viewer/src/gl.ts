/** Rows of two or four numbers for a shader, found by their number. */
export interface DataTexture {
  texture: WebGLTexture;
  rows: number;
}

const WIDTH = 2048;

export const FETCH = `#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
vec4 row(sampler2D table, int number) {
  return texelFetch(table, ivec2(number & ${WIDTH - 1}, number >> 11), 0);
}
// number / 3; dividing integers is slow where there is no graphics card.
int third(int number) {
  int guess = int(float(number) * 0.333333343);
  int rest = number - 3 * guess;
  return rest < 0 ? guess - 1 : rest > 2 ? guess + 1 : guess;
}
`;

export const FRAGMENT = `#version 300 es
precision highp float;
`;

export class Gl {
  readonly context: WebGL2RenderingContext;

  constructor(canvas: HTMLCanvasElement) {
    const context = canvas.getContext("webgl2", { antialias: false, alpha: false, powerPreference: "high-performance" });
    if (!context) throw new Error("this browser has no WebGL 2, which the picture of the assembly needs");
    this.context = context;
    context.bindVertexArray(context.createVertexArray());
  }

  program(vertex: string, fragment: string): Program {
    return new Program(this.context, vertex, fragment);
  }

  /** Room for `rows` rows of two or four numbers; `fill` writes them. */
  data(rows: number, columns: 2 | 4, fill: (target: Float32Array) => void): DataTexture {
    const gl = this.context;
    const height = Math.max(1, Math.ceil(rows / WIDTH));
    const target = new Float32Array(columns * WIDTH * height);
    fill(target);
    const [inside, format] = columns === 2 ? [gl.RG32F, gl.RG] : [gl.RGBA32F, gl.RGBA];
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, inside, WIDTH, height, 0, format, gl.FLOAT, target);
    nearest(gl);
    return { texture, rows };
  }

  /** A row of colours. */
  colours(pixels: Uint8Array): WebGLTexture {
    const gl = this.context;
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, pixels.length / 4, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    nearest(gl);
    return texture;
  }
}

function nearest(gl: WebGL2RenderingContext): void {
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
}

export type Uniform = number | readonly number[] | boolean;

export class Program {
  private readonly program: WebGLProgram;
  private readonly places = new Map<string, WebGLUniformLocation | null>();

  constructor(private readonly gl: WebGL2RenderingContext, vertex: string, fragment: string) {
    this.program = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]] as const) {
      const shader = gl.createShader(kind)!;
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(this.program, shader);
    }
    gl.linkProgram(this.program);
    if (!gl.getProgramParameter(this.program, gl.LINK_STATUS)) throw new Error(this.log());
  }

  draw(mode: number, vertices: number, uniforms: Record<string, Uniform>, textures: Record<string, WebGLTexture>): void {
    const gl = this.gl;
    gl.useProgram(this.program);
    for (const [name, value] of Object.entries(uniforms)) this.setUniform(name, value);
    Object.entries(textures).forEach(([name, texture], unit) => {
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.uniform1i(this.place(name), unit);
    });
    gl.activeTexture(gl.TEXTURE0);
    gl.drawArrays(mode, 0, vertices);
  }

  private setUniform(name: string, value: Uniform): void {
    const place = this.place(name);
    if (typeof value === "boolean") this.gl.uniform1i(place, Number(value));
    else if (typeof value === "number") this.gl.uniform1f(place, value);
    else if (value.length === 2) this.gl.uniform2fv(place, value);
    else if (value.length === 3) this.gl.uniform3fv(place, value);
    else this.gl.uniform4fv(place, value);
  }

  private place(name: string): WebGLUniformLocation | null {
    if (!this.places.has(name)) this.places.set(name, this.gl.getUniformLocation(this.program, name));
    return this.places.get(name)!;
  }

  private log(): string {
    const shaders = this.gl.getAttachedShaders(this.program) ?? [];
    return shaders.map((shader) => this.gl.getShaderInfoLog(shader)).join("\n") + this.gl.getProgramInfoLog(this.program);
  }
}
