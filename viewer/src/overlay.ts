import type { Picture } from "./assembly";
import type { Camera } from "./camera";
import { svg } from "./dom";
import { placeOf } from "./picking";
import { short } from "./run";
import type { State } from "./store";

/** What lies over the picture: the mark of what is selected, and the scale bar. */
export class Overlay {
  readonly node = svg("svg", { class: "overlay", "aria-hidden": "true" });
  private readonly mark = svg("g", { class: "mark" });
  private readonly bar = svg("path", { class: "bar" });
  private readonly length = svg("text", { class: "bar-length" });

  constructor() {
    this.node.append(this.mark, this.bar, this.length);
  }

  draw(state: State, picture: Picture | null, camera: Camera): void {
    this.drawBar(camera);
    this.mark.replaceChildren(...(picture ? this.marks(state, picture, camera) : []));
  }

  private marks({ selection, factor }: State, picture: Picture, camera: Camera): SVGElement[] {
    if (!selection) return [];
    const at = (number: number): { x: number; y: number } => {
      const { x, y } = placeOf(picture, number, factor);
      return camera.toPicture(x, y);
    };
    if (selection.kind === "grain") {
      if (selection.id >= picture.count) return [];
      const { x, y } = at(selection.id);
      const r = Math.max(picture.body.radius[selection.id]! * camera.scale, 3) + 2;
      return [svg("circle", { cx: x, cy: y, r, class: "halo" }), svg("circle", { cx: x, cy: y, r })];
    }
    const links = picture.links;
    if (!links || selection.id >= links.first.length) return [];
    const [from, to] = [at(links.first[selection.id]!), at(links.second[selection.id]!)];
    const line = { x1: from.x, y1: from.y, x2: to.x, y2: to.y };
    const end = { cx: from.x, cy: from.y, r: 4 };
    return [svg("line", { ...line, class: "halo" }), svg("line", line), svg("circle", end), svg("circle", { ...end, cx: to.x, cy: to.y })];
  }

  private drawBar(camera: Camera): void {
    const most = Math.min(140, 0.3 * camera.width) / camera.scale;
    const power = 10 ** Math.floor(Math.log10(most));
    const length = power * ([5, 2, 1].find((times) => times * power <= most) ?? 1);
    const [right, y] = [camera.width - 16, camera.height - 16];
    const left = right - length * camera.scale;
    this.bar.setAttribute("d", `M${left} ${y - 5}V${y}H${right}V${y - 5}`);
    this.length.textContent = short(length);
    this.length.setAttribute("x", String((left + right) / 2));
    this.length.setAttribute("y", String(y - 7));
  }
}
