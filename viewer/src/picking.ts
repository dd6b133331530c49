import type { Picture } from "./assembly";
import type { Camera } from "./camera";
import type { Point } from "./sides";
import type { Selection, State } from "./store";

/** How far beside a contact or a small grain a click may fall, in pixels. */
const NEAR = 5;

/** Where the centre of a grain, or an anchor, is drawn, in the plane. */
export function placeOf({ body, links, displacements, count }: Picture, number: number, factor: number): Point {
  const at = number < count ? { x: body.x[number]!, y: body.y[number]! } : links!.anchors[number - count]!;
  return { x: at.x + factor * displacements.x[number]!, y: at.y + factor * displacements.y[number]! };
}

/** What is drawn at a point of the picture. */
export function find(state: State, picture: Picture, camera: Camera, x: number, y: number): Selection | null {
  const at = camera.toPlane(x, y);
  const grain = findGrain(picture, at, state.factor, NEAR / camera.scale);
  const contact = findContact(state, picture, at, NEAR / camera.scale);
  if (contact && (!grain || !state.layers.grains || contact.middle)) return { kind: "contact", id: contact.id };
  return grain === null ? null : { kind: "grain", id: grain };
}

function findGrain({ body, count }: Picture, at: Point, factor: number, near: number): number | null {
  const { x, y, radius, ux, uy } = body;
  let [found, least] = [-1, near];
  for (let i = 0; i < count; i++) {
    const dx = x[i]! + factor * ux[i]! - at.x;
    const dy = y[i]! + factor * uy[i]! - at.y;
    const limit = least + radius[i]!;
    if (dx > limit || dx < -limit || dy > limit || dy < -limit) continue;
    const beside = Math.sqrt(dx * dx + dy * dy) - radius[i]!;
    if (beside < least) [found, least] = [i, beside];
  }
  return found < 0 ? null : found;
}

/** The contact whose line is nearest; `middle` if the point is in the middle half of the line. */
function findContact(state: State, picture: Picture, at: Point, near: number): { id: number; middle: boolean } | null {
  const { links, body, brokenContacts } = picture;
  if (!links) return null;
  const all = state.layers.forces || state.layers.graph || state.layers.dual;
  const list = all ? null : state.layers.broken ? brokenContacts : [];
  const { first, second } = links;
  const factor = state.factor;
  let [found, least, middle] = [-1, near, false];
  const number = list ? list.length : first.length;
  for (let k = 0; k < number; k++) {
    const c = list ? list[k]! : k;
    const [p, q] = [first[c]!, second[c]!];
    const x1 = body.x[p]! + factor * body.ux[p]!;
    const y1 = body.y[p]! + factor * body.uy[p]!;
    const far = q < picture.count ? 8 * (body.radius[p]! + body.radius[q]!) + near : Infinity;
    if (Math.abs(x1 - at.x) > far || Math.abs(y1 - at.y) > far) continue;
    const to = q < picture.count ? null : placeOf(picture, q, factor);
    const x2 = to ? to.x : body.x[q]! + factor * body.ux[q]!;
    const y2 = to ? to.y : body.y[q]! + factor * body.uy[q]!;
    const [dx, dy] = [x2 - x1, y2 - y1];
    const along = ((at.x - x1) * dx + (at.y - y1) * dy) / (dx * dx + dy * dy || 1);
    if (along < 0 || along > 1) continue;
    const beside = Math.hypot(at.x - x1 - along * dx, at.y - y1 - along * dy);
    if (beside < least) [found, least, middle] = [c, beside, along > 0.25 && along < 0.75 && 0.5 * Math.hypot(dx, dy) > near];
  }
  return found < 0 ? null : { id: found, middle };
}
