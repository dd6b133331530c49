import { FETCH, FRAGMENT, type DataTexture, type Gl, type Program, type Uniform } from "../gl";
import { COLOUR, VIEW, type View } from "./view";

// A row of u_cells: three grains and a value.
const VERTEX = `${FETCH}${VIEW}${COLOUR}
uniform sampler2D u_shapes, u_moves, u_cells;
flat out vec4 v_colour;
void main() {
  int number = third(gl_VertexID), corner = gl_VertexID - 3 * number;
  vec4 cell = row(u_cells, number);
  int grain = int(corner == 0 ? cell.x : corner == 1 ? cell.y : cell.z);
  v_colour = vec4(colour(cell.w), u_plain.a);
  gl_Position = place(row(u_shapes, grain).xy + u_factor * row(u_moves, grain).xy);
}`;

const SHADE = `${FRAGMENT}
flat in vec4 v_colour;
out vec4 o_colour;
void main() {
  o_colour = v_colour;
}`;

/** Triangles between the centres of three grains. */
export class TriangleLayer {
  private readonly program: Program;

  constructor(private readonly gl: Gl) {
    this.program = gl.program(VERTEX, SHADE);
  }

  draw(view: View, shapes: DataTexture, moves: DataTexture, cells: DataTexture, uniforms: Record<string, Uniform>, map: WebGLTexture): void {
    const gl = this.gl.context;
    gl.disable(gl.BLEND);
    this.program.draw(gl.TRIANGLES, 3 * cells.rows, { ...view.uniforms, ...uniforms }, {
      u_shapes: shapes.texture, u_moves: moves.texture, u_cells: cells.texture, u_map: map,
    });
  }
}
