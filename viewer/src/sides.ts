import type { Run } from "./run";
import type { Table } from "./source";

export interface Point {
  x: number;
  y: number;
}

/** An edge of the container; `moves` if a side of the assembly stands there. */
export interface Edge {
  from: Point;
  to: Point;
  side: number | null;
  ux: number;
  uy: number;
  rotation: number;
}

/** Edges of the container, those that are sides with their displacement. */
export function edgesOf(run: Run, sides: Table | null): Edge[] {
  const corners = run.container.map(([x, y]) => ({ x, y }));
  const edges = corners.map((from, k): Edge => ({
    from, to: corners[(k + 1) % corners.length]!, side: null, ux: 0, uy: 0, rotation: 0,
  }));
  const ids = sides?.get("side")?.values ?? [];
  for (let row = 0; row < ids.length; row++) {
    const name = nameOf(sides!, row);
    const edge = edges[numberOf(name, edges) ?? ids[row]!];
    const value = (column: string): number => Number(sides!.get(column)?.values[row] ?? 0);
    if (edge) Object.assign(edge, { side: ids[row]!, ux: value("ux"), uy: value("uy"), rotation: value("rotation") });
  }
  return edges;
}

function nameOf(sides: Table, row: number): string {
  const column = sides.get("name");
  return column?.names?.[column.values[row]!] ?? "";
}

/** The edge that is named left, right, bottom or top: the one whose outward normal points there. */
function numberOf(name: string, edges: Edge[]): number | null {
  const way = { left: [-1, 0], right: [1, 0], bottom: [0, -1], top: [0, 1] }[name];
  if (!way) return null;
  const along = edges.map(({ from, to }) => {
    const [x, y] = [to.x - from.x, to.y - from.y];
    return (y * way[0]! - x * way[1]!) / Math.hypot(x, y);
  });
  return along.indexOf(Math.max(...along));
}

/** Displacement that a side gives a point on it. */
export function carried(edge: Edge, { x, y }: Point): Point {
  const middle = { x: (edge.from.x + edge.to.x) / 2, y: (edge.from.y + edge.to.y) / 2 };
  return { x: edge.ux - edge.rotation * (y - middle.y), y: edge.uy + edge.rotation * (x - middle.x) };
}

/** The point of an edge's line that is nearest to a point. */
export function foot(edge: Edge, { x, y }: Point): Point {
  const [dx, dy] = [edge.to.x - edge.from.x, edge.to.y - edge.from.y];
  const at = ((x - edge.from.x) * dx + (y - edge.from.y) * dy) / (dx * dx + dy * dy);
  return { x: edge.from.x + at * dx, y: edge.from.y + at * dy };
}
