import uPlot from "uplot";
import { choices, element } from "./dom";
import { short, spoken, withUnit, type Run } from "./run";
import type { State, Store } from "./store";
import { goTo } from "./timeline";
import type { Tables } from "./tables";

/** A quantity that every load step has: "steps/stress_yy" or "actions/press/force". */
type Quantity = string;

const ACTION_COLUMNS = ["displacement", "force", "factor"];

/** Values of quantities by load step; NaN where a load step has none. */
export class Progress {
  constructor(private readonly tables: Tables, private readonly store: Store) {}

  async values(quantity: Quantity): Promise<Float64Array> {
    const parts = quantity.split("/");
    const table = parts[0]!;
    const column = parts.at(-1)!;
    const values = new Float64Array(this.store.state.run.load_steps + 1).fill(NaN);
    const names = table === "actions" ? ["step", "action", column] : ["step", column];
    const found = await this.tables.whole(table, names);
    const step = found.get("step")?.values ?? [];
    const source = found.get(column)?.values ?? [];
    const action = found.get("action");
    const wanted = action?.names?.indexOf(parts.slice(1, -1).join("/")) ?? -1;
    for (let i = 0; i < step.length; i++) if (!action || action.values[i] === wanted) values[step[i]!] = source[i]!;
    return values;
  }

  /** The largest force of an action in the whole run. */
  async largestForce(): Promise<number> {
    const found = await this.tables.whole("actions", ["force"]).catch(() => null);
    return Float64Array.from(found?.get("force")?.values ?? []).reduce((most, force) => Math.max(most, Math.abs(force) || 0), 0);
  }

  /** Names of the actions, in their order. */
  async actions(): Promise<string[]> {
    const found = await this.tables.whole("actions", ["action"]).catch(() => null);
    return found?.get("action")?.names ?? [];
  }
}

function options(run: Run, actions: string[]): Map<string, [Quantity, string][]> {
  const steps = (run.tables["steps"] ?? []).filter((column) => column.name !== "stage" && !column.values);
  const groups = new Map([["Steps", steps.map((column): [string, string] => [`steps/${column.name}`, withUnit(column)])]]);
  for (const action of actions) {
    groups.set(`Action ${action}`, ACTION_COLUMNS.map((column) => [`actions/${action}/${column}`, `${action}: ${spoken(column)}`]));
  }
  return groups;
}

/** The curves beside the picture. */
export class Curves {
  readonly node = element("div", { class: "curves" });
  private readonly list = element("div");
  private readonly curves: Curve[] = [];
  private readonly progress: Progress;
  private actions: string[] = [];

  constructor(private readonly store: Store, tables: Tables) {
    this.progress = new Progress(tables, store);
    const more = element("button", { class: "more", click: () => this.add("steps/step", "steps/broken") }, "Another curve");
    this.node.append(this.list, more);
    store.on(["step", "theme"], () => this.curves.forEach((curve) => curve.redraw()));
  }

  async start(): Promise<void> {
    this.actions = await this.progress.actions();
    const action = this.actions[0];
    if (action !== undefined) this.add(`actions/${action}/displacement`, `actions/${action}/force`);
    this.add("steps/step", "steps/broken");
    this.store.on(["run"], () => this.curves.forEach((curve) => void curve.load()));
  }

  private add(x: Quantity, y: Quantity): void {
    const remove = (curve: Curve): void => {
      curve.node.remove();
      this.curves.splice(this.curves.indexOf(curve), 1);
    };
    const curve = new Curve(this.store, this.progress, options(this.store.state.run, this.actions), x, y, remove);
    this.curves.push(curve);
    this.list.append(curve.node);
    void curve.load();
  }
}

const HEIGHT = 190;

class Curve {
  readonly node = element("figure", { class: "curve" });
  private readonly place = element("div", { class: "plot" });
  private readonly caption = element("output", { class: "reading" });
  private xs: Float64Array = new Float64Array();
  private ys: Float64Array = new Float64Array();
  private plot: uPlot;
  private asked = 0;

  constructor(
    private readonly store: Store, private readonly progress: Progress, groups: Map<string, [Quantity, string][]>,
    private x: Quantity, private y: Quantity, remove: (curve: Curve) => void,
  ) {
    const vertical = choices("Quantity upwards", groups, y, (chosen) => void this.load({ y: chosen }));
    const across = choices("Quantity to the right", groups, x, (chosen) => void this.load({ x: chosen }));
    const close = element("button", { class: "icon", "aria-label": "Remove this curve", title: "Remove this curve", click: () => remove(this) }, "×");
    this.plot = new uPlot(this.settings(), [[0, 1], [0, 1]], this.place);
    this.plot.root.querySelector("canvas")!.setAttribute("aria-hidden", "true");
    this.node.append(element("div", { class: "axis-names" }, vertical, close), this.place, element("div", { class: "axis-names across" }, this.caption, across));
    new ResizeObserver(() => this.plot.setSize({ width: Math.max(this.place.clientWidth, 50), height: HEIGHT })).observe(this.place);
    this.listen();
  }

  async load(chosen: { x?: Quantity; y?: Quantity } = {}): Promise<void> {
    Object.assign(this, chosen);
    const asked = ++this.asked;
    const [xs, ys] = await Promise.all([this.progress.values(this.x), this.progress.values(this.y)]);
    if (asked !== this.asked) return;
    [this.xs, this.ys] = [xs, ys];
    this.plot.setData([[0, 1], [0, 1]]);
    this.tell(this.store.state);
  }

  redraw(): void {
    this.plot.redraw(false, true);
    this.tell(this.store.state);
  }

  // uPlot gives axes and grid; it wants rising x for its own lines, which a load-displacement curve does not have.
  private settings(): uPlot.Options {
    const ink = (name: string) => (): string => getComputedStyle(this.node).getPropertyValue(name);
    const axis = (size: number): uPlot.Axis => ({
      stroke: ink("--muted"), font: "11px system-ui, sans-serif", size,
      grid: { stroke: ink("--grid"), width: 1 }, ticks: { stroke: ink("--grid"), width: 1, size: 4 },
      values: (_, values) => values.map(short),
    });
    return {
      width: 300, height: HEIGHT, legend: { show: false }, cursor: { show: false }, padding: [8, 10, 0, 0],
      scales: { x: { time: false, range: () => limits(this.xs, this.ys) }, y: { range: () => limits(this.ys, this.xs) } },
      axes: [{ ...axis(28), space: 60 }, { ...axis(58), space: 30 }],
      series: [{}, { paths: () => null, points: { show: false } }],
      hooks: { draw: [(plot) => this.draw(plot)] },
    };
  }

  private draw(plot: uPlot): void {
    const { ctx } = plot;
    const style = getComputedStyle(this.node);
    const { run, step } = this.store.state;
    const ratio = uPlot.pxRatio;
    const at = (k: number): [number, number] => [plot.valToPos(this.xs[k]!, "x", true), plot.valToPos(this.ys[k]!, "y", true)];
    const dot = (k: number, radius: number): void => {
      ctx.beginPath();
      ctx.arc(...at(k), radius * ratio, 0, 2 * Math.PI);
      ctx.fill();
    };
    ctx.save();
    ctx.strokeStyle = ctx.fillStyle = style.getPropertyValue("--line");
    ctx.lineWidth = 1.6 * ratio;
    ctx.lineJoin = "round";
    ctx.beginPath();
    for (let k = 0; k < this.xs.length; k++) if (this.exists(k)) ctx.lineTo(...at(k));
    ctx.stroke();
    if (run.recorded.length <= 100) for (const k of run.recorded) if (this.exists(k)) dot(k, 2.2);
    if (this.exists(step)) {
      const [x, y] = at(step);
      const { left, top, width, height } = plot.bbox;
      ctx.strokeStyle = ctx.fillStyle = style.getPropertyValue("--accent");
      ctx.lineWidth = ratio;
      ctx.setLineDash([4 * ratio, 3 * ratio]);
      ctx.beginPath();
      ctx.moveTo(x, top);
      ctx.lineTo(x, top + height);
      ctx.moveTo(left, y);
      ctx.lineTo(left + width, y);
      ctx.stroke();
      ctx.setLineDash([]);
      dot(step, 5);
    }
    ctx.restore();
  }

  private exists(k: number): boolean {
    return Number.isFinite(this.xs[k]) && Number.isFinite(this.ys[k]);
  }

  /** A click, or moving with the button down, goes to the recorded load step nearest to the point. */
  private listen(): void {
    const over = this.plot.over;
    const follow = (event: PointerEvent): void => {
      const box = over.getBoundingClientRect();
      const step = this.nearest(event.clientX - box.left, event.clientY - box.top);
      if (step !== null) goTo(this.store, step);
    };
    over.addEventListener("pointerdown", (event) => {
      over.setPointerCapture(event.pointerId);
      this.store.set({ playing: false });
      follow(event);
    });
    over.addEventListener("pointermove", (event) => {
      if (event.buttons === 1) follow(event);
    });
  }

  private nearest(x: number, y: number): number | null {
    let [best, least] = [null as number | null, Infinity];
    for (let k = 0; k < this.xs.length; k++) {
      if (!this.exists(k)) continue;
      const away = Math.hypot(this.plot.valToPos(this.xs[k]!, "x") - x, this.plot.valToPos(this.ys[k]!, "y") - y);
      if (away < least) [best, least] = [k, away];
    }
    return best;
  }

  private tell({ step }: State): void {
    const [x, y] = [this.xs[step], this.ys[step]];
    this.caption.textContent = x === undefined || y === undefined || !this.exists(step) ? "" : `${short(x)}, ${short(y)}`;
  }
}

/** Limits of the values whose partner exists, with a margin. */
function limits(values: Float64Array, partners: Float64Array): [number, number] {
  let [low, high] = [Infinity, -Infinity];
  values.forEach((value, k) => {
    if (!Number.isFinite(value) || !Number.isFinite(partners[k])) return;
    low = Math.min(low, value);
    high = Math.max(high, value);
  });
  if (low > high) return [0, 1];
  const margin = high > low ? 0.05 * (high - low) : 0.5 * Math.abs(high) || 0.5;
  return [low - margin, high + margin];
}
