import { scaleOf, type Scale } from "./colour";
import type { DataTexture, Gl } from "./gl";
import { Ends, Styles, WIDEST, type Segments } from "./layers/segments";
import { shaderValue } from "./layers/view";
import { NONE } from "./run";
import { carried, foot, type Edge, type Point } from "./sides";
import type { Column, Numbers, Table } from "./source";
import type { Range } from "./store";

/** Numbers of the assembly at a load step that the page itself needs, to find and to mark. */
export interface Body {
  x: Numbers;
  y: Numbers;
  radius: Numbers;
  ux: Numbers;
  uy: Numbers;
}

export interface Links {
  first: Numbers;
  /** Grains, or anchors where a side is the partner: their numbers follow those of the grains. */
  second: Int32Array;
  anchors: Anchor[];
}

/** The point of a side that a grain is in contact with. */
export interface Anchor extends Point {
  edge: Edge | null;
  grain: number;
}

export function numbers(table: Table, name: string): Numbers {
  const column = table.get(name);
  if (!column) throw new Error(`the column ${name} is missing`);
  return column.values;
}

/** Partners of the contacts, each side as a point of its own for every contact with it. */
export function linksOf(contacts: Table, body: Body, edges: Edge[]): Links {
  const first = numbers(contacts, "first");
  const second = Int32Array.from(numbers(contacts, "second"));
  const anchors: Anchor[] = [];
  for (let c = 0; c < second.length; c++) {
    if (second[c]! >= 0) continue;
    const grain = first[c]!;
    const edge = edges.find((each) => each.side === -1 - second[c]!) ?? null;
    const centre = { x: body.x[grain]!, y: body.y[grain]! };
    second[c] = body.x.length + anchors.length;
    anchors.push({ ...(edge ? foot(edge, centre) : centre), edge, grain });
  }
  return { first, second, anchors };
}

export function shapes(gl: Gl, body: Body, window: Numbers | null): DataTexture {
  const { x, y, radius } = body;
  const count = x.length;
  return gl.data(count, 4, (rows) => {
    for (let i = 0; i < count; i++) {
      const at = 4 * i;
      rows[at] = x[i]!;
      rows[at + 1] = y[i]!;
      rows[at + 2] = radius[i]!;
      rows[at + 3] = window ? window[i]! : 1;
    }
  });
}

export function moves(gl: Gl, { ux, uy }: Body, rotation: Numbers | null, colour: Column | null): DataTexture {
  return gl.data(ux.length, 4, (rows) => {
    for (let i = 0; i < ux.length; i++) {
      const at = 4 * i;
      rows[at] = ux[i]!;
      rows[at + 1] = uy[i]!;
      rows[at + 2] = rotation ? rotation[i]! : 0;
      rows[at + 3] = shaderValue(colour?.values[i]);
    }
  });
}

/** Displacements of grains and, after them, of anchors. */
export interface Moves {
  x: Numbers;
  y: Numbers;
}

export function movesOf({ ux, uy }: Body, anchors: Anchor[], edges: Edge[]): Moves {
  if (anchors.length === 0) return { x: ux, y: uy };
  const [x, y] = [ux, uy].map((values) => {
    const longer = new Float32Array(values.length + anchors.length);
    longer.set(values);
    return longer;
  }) as [Float32Array, Float32Array];
  anchors.forEach((anchor, i) => {
    const now = edges.find((edge) => edge.side !== null && edge.side === anchor.edge?.side);
    const move = now ? carried(now, anchor) : { x: ux[anchor.grain]!, y: uy[anchor.grain]! };
    x[ux.length + i] = move.x;
    y[uy.length + i] = move.y;
  });
  return { x, y };
}

/** Ends at the centres of the partners, or at the anchor. */
export function branches(gl: Gl, { x, y }: Body, { first, second, anchors }: Links, moves: Moves): Ends {
  const count = x.length;
  return new Ends(gl, first.length, (rows, factor) => {
    for (let c = 0; c < first.length; c++) {
      const [p, q, at] = [first[c]!, second[c]!, 4 * c];
      const anchor = q < count ? null : anchors[q - count]!;
      rows[at] = x[p]! + factor * moves.x[p]!;
      rows[at + 1] = y[p]! + factor * moves.y[p]!;
      rows[at + 2] = (anchor ? anchor.x : x[q]!) + factor * moves.x[q]!;
      rows[at + 3] = (anchor ? anchor.y : y[q]!) + factor * moves.y[q]!;
    }
  }, true);
}

/**
 * Contacts as the force network: a width of 1 for a large normal force, with its sign. Forces below `least` are
 * rounding and no reference.
 */
export function forces(gl: Gl, ends: Ends, contacts: Table, colour: Column | null, held: Range | null, least: number): { segments: Segments; scale: Scale } {
  const force = contacts.get("normal_force")!;
  const scale = scaleOf(colour ?? force, held);
  const reference = Math.max(largest(colour ? scaleOf(force, null).range : scale.range), least);
  let widest = 0;
  const rows = new Float32Array(2 * ends.count);
  for (let c = 0; c < ends.count; c++) {
    const width = Math.min(Math.max(force.values[c]! / reference, -WIDEST), WIDEST) || 0;
    widest = Math.max(widest, Math.abs(width));
    rows[2 * c] = width;
    rows[2 * c + 1] = colour ? shaderValue(colour.values[c]) : 0;
  }
  return { segments: { ends, styles: new Styles(gl, rows), widest }, scale };
}

function largest(range: Range): number {
  return Math.max(Math.abs(range.low), Math.abs(range.high));
}

/** Active contacts as lines between the centres. */
export function graph(gl: Gl, ends: Ends, contacts: Table): Segments {
  const state = contacts.get("state")!;
  const gone = new Set(["broken", "open"].map((word) => state.names?.indexOf(word) ?? -1));
  const rows = new Float32Array(2 * ends.count);
  for (let c = 0; c < ends.count; c++) rows[2 * c] = gone.has(state.values[c]!) ? 0 : 1;
  return { ends, styles: new Styles(gl, rows), widest: 1 };
}

/** Lines with ends of their own, which move by the mean displacement of two grains. */
export interface Line {
  ends: [number, number, number, number];
  /** Grains or anchors; none: the line stays. */
  with: [number, number] | null;
  width: number;
  value: number;
}

export function lines(gl: Gl, list: Line[], moves: Moves): Segments {
  const ends = new Ends(gl, list.length, (rows, factor) => list.forEach((line, i) => {
    const [p, q] = line.with ?? [-1, -1];
    const [dx, dy] = line.with ? [(factor * (moves.x[p]! + moves.x[q]!)) / 2, (factor * (moves.y[p]! + moves.y[q]!)) / 2] : [0, 0];
    const [x1, y1, x2, y2] = line.ends;
    rows.set([x1 + dx, y1 + dy, x2 + dx, y2 + dy], 4 * i);
  }));
  const rows = Float32Array.from(list.flatMap(({ width, value }) => [width, value]));
  return { ends, styles: new Styles(gl, rows), widest: list.reduce((most, line) => Math.max(most, Math.abs(line.width)), 0) };
}

export function dual(gl: Gl, { first, second }: Links, table: Table, moves: Moves): Segments {
  const contact = numbers(table, "contact");
  const columns = ["x1", "y1", "x2", "y2"].map((name) => numbers(table, name));
  const ends = new Ends(gl, contact.length, (rows, factor) => {
    for (let i = 0; i < contact.length; i++) {
      const [p, q] = [first[contact[i]!]!, second[contact[i]!]!];
      const dx = (factor * (moves.x[p]! + moves.x[q]!)) / 2;
      const dy = (factor * (moves.y[p]! + moves.y[q]!)) / 2;
      columns.forEach((column, k) => (rows[4 * i + k] = column[i]! + (k % 2 === 0 ? dx : dy)));
    }
  });
  return { ends, styles: new Styles(gl, new Float32Array(2 * contact.length).fill(1)), widest: 1 };
}

/** A broken contact is a line across it, as long as its dual edge, coloured by when it broke. */
export function broken(gl: Gl, links: Links, contacts: Table, moves: Moves): { segments: Segments; scale: Scale; contacts: number[] } {
  const when = contacts.get("broke_at")!;
  const [x, y, nx, ny, length] = ["x", "y", "nx", "ny", "dual_length_full"].map((name) => numbers(contacts, name)) as [Numbers, Numbers, Numbers, Numbers, Numbers];
  const list: Line[] = [];
  const ids: number[] = [];
  for (let c = 0; c < when.values.length; c++) {
    if (when.values[c] === NONE) continue;
    const [dx, dy] = [(-ny[c]! * length[c]!) / 2, (nx[c]! * length[c]!) / 2];
    ids.push(c);
    list.push({
      ends: [x[c]! - dx, y[c]! - dy, x[c]! + dx, y[c]! + dy],
      with: [links.first[c]!, links.second[c]!], width: 1, value: when.values[c]!,
    });
  }
  return { segments: lines(gl, list, moves), scale: scaleOf(when, null, true), contacts: ids };
}

/** Triangles that fill the void cells. */
export function cells(gl: Gl, table: Table, voids: Table, colour: string, held: Range | null): { cells: DataTexture; scale: Scale | null } {
  const [owner, ...corners] = ["void", "first", "second", "third"].map((name) => numbers(table, name)) as [Numbers, ...Numbers[]];
  const column = voids.get(colour) ?? null;
  const made = gl.data(owner.length, 4, (rows) => {
    for (let i = 0; i < owner.length; i++) {
      corners.forEach((corner, k) => (rows[4 * i + k] = corner[i]!));
      rows[4 * i + 3] = shaderValue(column?.values[owner[i]!]);
    }
  });
  return { cells: made, scale: column && scaleOf(column, held) };
}

const STILL: Moves = { x: new Float32Array(), y: new Float32Array() };

/** Principal directions as crosses, the longest arm filling its square. */
export function crosses(gl: Gl, table: Table, kind: string): { segments: Segments; whole: { major: number; minor: number; angle: number } | null } {
  const kinds = table.get("kind")!;
  const [x, y, angle, major, minor, size, whole] = ["x", "y", "angle", "major", "minor", "size", "whole"].map((name) => numbers(table, name)) as Numbers[];
  const mine = [...kinds.values.keys()].filter((i) => kinds.names?.[kinds.values[i]!] === kind);
  const field = mine.filter((i) => whole![i] !== 1);
  const most = field.reduce((value, i) => Math.max(value, Math.abs(major![i]!), Math.abs(minor![i]!)), 0) || 1;
  const list = field.flatMap((i) => [[major![i]!, angle![i]!], [minor![i]!, angle![i]! + Math.PI / 2]].map(([value, turn]): Line => {
    const half = (0.46 * size![i]! * Math.abs(value!)) / most;
    const [dx, dy] = [half * Math.cos(turn!), half * Math.sin(turn!)];
    return { ends: [x![i]! - dx, y![i]! - dy, x![i]! + dx, y![i]! + dy], with: null, width: value! < 0 ? -1 : 1, value: 0 };
  }));
  const all = mine.find((i) => whole![i] === 1);
  return {
    segments: lines(gl, list, STILL),
    whole: all === undefined ? null : { major: major![all]!, minor: minor![all]!, angle: angle![all]! },
  };
}

/** A mode as a line from every grain, the largest `reach` long. */
export function mode(gl: Gl, table: Table, number: number, body: Body, reach: number): { segments: Segments; eigenvalue: number; count: number } {
  const [modes, eigenvalue, grain, ux, uy] = ["mode", "eigenvalue", "grain", "ux", "uy"].map((name) => numbers(table, name)) as [Numbers, Numbers, Numbers, Numbers, Numbers];
  const list: Line[] = [];
  let [value, count] = [NaN, 0];
  for (let i = 0; i < modes.length; i++) {
    count = Math.max(count, modes[i]! + 1);
    const g = grain[i]!;
    if (modes[i] !== number || g < 0) continue;
    value = eigenvalue[i]!;
    const [x, y] = [body.x[g]!, body.y[g]!];
    list.push({ ends: [x, y, x + reach * ux[i]!, y + reach * uy[i]!], with: [g, g], width: 1, value: 0 });
  }
  return { segments: lines(gl, list, { x: body.ux, y: body.uy }), eigenvalue: value, count };
}

/** Edges of the container where they are now; sides thick, the rest thin. */
export function container(gl: Gl, edges: Edge[], factor: number): Segments {
  const list = edges.map((edge): Line => {
    const [from, to] = [edge.from, edge.to].map((point) => {
      const move = carried(edge, point);
      return { x: point.x + factor * move.x, y: point.y + factor * move.y };
    }) as [Point, Point];
    return { ends: [from.x, from.y, to.x, to.y], with: null, width: edge.side === null ? 1 : 2.5, value: 0 };
  });
  return lines(gl, list, STILL);
}
