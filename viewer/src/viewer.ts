import { Assembly, type Picture } from "./assembly";
import { Camera } from "./camera";
import { controls } from "./controls";
import { Curves, Progress } from "./curves";
import { help, information, STATE_TEXT } from "./dialogs";
import { element } from "./dom";
import { Gl } from "./gl";
import { listenToKeys } from "./keys";
import { Legend } from "./legend";
import { navigate } from "./navigation";
import { Overlay } from "./overlay";
import { Painter } from "./painter";
import { Panel } from "./panel";
import { find } from "./picking";
import { hasColumn, type Run } from "./run";
import type { Source } from "./source";
import { Store, type State } from "./store";
import { Tables } from "./tables";
import { factorText, timeline } from "./timeline";
import { watch } from "./watch";

/** Forces are shown from the start up to this many contacts. */
const FORCES_UP_TO = 1e6;

/** Contact forces below this part of the largest force of an action are rounding. */
const ROUNDING = 1e-9;

/** The page: puts its parts together and keeps the picture that of the state. */
export class Viewer {
  private readonly store: Store;
  private readonly tables: Tables;
  private readonly camera = new Camera(() => this.redraw());
  private readonly canvas = element("canvas", { tabindex: 0, role: "img", class: "picture" });
  private readonly overlay = new Overlay();
  private readonly message = element("p", { class: "message", role: "status" });
  private readonly legend: Legend;
  private assembly!: Assembly;
  private painter!: Painter;
  private picture: Picture | null = null;
  private loading: Promise<void> | null = null;
  private outdated = false;
  private frame = 0;

  constructor(private readonly root: HTMLElement, private readonly source: Source, run: Run) {
    this.store = new Store(initial(run));
    this.tables = new Tables(source);
    this.legend = new Legend(this.store);
    document.title = run.embedded ? document.title : `${run.title || "kavics"} – kavics`;
  }

  start(): void {
    const { run } = this.store.state;
    const curves = new Curves(this.store, this.tables);
    const panel = new Panel(this.store, this.source, this.tables);
    const dialogs = { information: information(this.store), help: help() };
    const steps = timeline(this.store, () => this.drawn());
    const number = section("Selection", panel.node, true);
    const aside = element("div", { class: "aside" }, section("Layers", controls(this.store), true), number, section("Curves", curves.node, true));
    this.root.classList.toggle("embedded", run.embedded);
    this.root.append(
      element("div", { class: "frame" }, this.header(dialogs), this.stage(), this.legend.node, steps, aside),
      dialogs.information, dialogs.help,
    );
    listenToKeys(run.embedded ? this.root : document, this.store, {
      camera: this.camera, theme: () => this.toggleTheme(),
      information: () => dialogs.information.showModal(), help: () => dialogs.help.showModal(),
      find: () => aside.querySelector<HTMLInputElement>(".find")?.focus(),
    });
    this.follow();
    this.loadFactors(new Progress(this.tables, this.store));
    curves.start().catch((error: unknown) => this.say(error));
    void watch(this.store, this.source, this.tables);
  }

  private follow(): void {
    try {
      const gl = new Gl(this.canvas);
      this.assembly = new Assembly(gl, this.tables);
      this.painter = new Painter(gl, this.canvas);
    } catch (error) {
      this.say(error);
      return;
    }
    new ResizeObserver(() => this.camera.resize(this.canvas.clientWidth, this.canvas.clientHeight)).observe(this.canvas);
    navigate(this.canvas, this.camera, (x, y) => this.select(x, y));
    this.store.on(["theme"], ({ theme }) => (this.root.dataset["theme"] = theme));
    this.store.on(["run", "step", "layers", "colour", "range", "mode", "leastForce"], () => this.load());
    this.store.on(["factor", "width", "selection", "theme", "loadFactors"], () => this.redraw());
  }

  private load(): void {
    this.outdated = true;
    this.loading ??= this.loadAll().finally(() => (this.loading = null));
  }

  private async loadAll(): Promise<void> {
    while (this.outdated) {
      this.outdated = false;
      try {
        const picture = await this.assembly.picture(this.store.state, (early) => {
          if (!this.picture) this.show(early);
        });
        this.show(picture);
        this.assembly.sweep();
        this.say(null);
      } catch (error) {
        this.say(error);
      }
    }
  }

  private show(picture: Picture): void {
    if (!this.picture) this.setHome(picture);
    this.picture = picture;
    this.redraw();
  }

  private setHome({ body }: Picture): void {
    const box = { left: Infinity, right: -Infinity, bottom: Infinity, top: -Infinity };
    const include = (x: number, y: number, r: number): void => {
      box.left = Math.min(box.left, x - r);
      box.right = Math.max(box.right, x + r);
      box.bottom = Math.min(box.bottom, y - r);
      box.top = Math.max(box.top, y + r);
    };
    for (let i = 0; i < body.x.length; i++) include(body.x[i]!, body.y[i]!, body.radius[i]!);
    for (const [x, y] of this.store.state.run.container) include(x, y, 0);
    if (box.left < box.right) this.camera.setHome(box);
  }

  /** Draws soon, and only once however often it is asked. */
  private redraw(): void {
    if (this.frame || !this.painter) return;
    this.frame = requestAnimationFrame(() => {
      this.frame = 0;
      const { state } = this.store;
      this.painter.draw(state, this.picture, this.camera);
      this.overlay.draw(state, this.picture, this.camera);
      this.legend.update(state, this.picture);
      this.describe(state);
    });
  }

  /** Says what the picture shows, to those who cannot see it and to tests. */
  private describe(state: State): void {
    if (!this.picture) return;
    const { step, count } = this.picture;
    if (!performance.getEntriesByName("kavics-first-picture").length) performance.mark("kavics-first-picture");
    this.root.dataset["drawn"] = String(step);
    this.canvas.setAttribute("aria-label", `Assembly of ${count} grains at load step ${step}, ${factorText(state, step)}, displacements times ${state.factor}`);
  }

  private async drawn(): Promise<void> {
    await new Promise((done) => queueMicrotask(() => done(null)));
    await this.loading;
    await new Promise((done) => requestAnimationFrame(done));
  }

  private select(x: number, y: number): void {
    if (!this.picture) return;
    this.store.set({ selection: find(this.store.state, this.picture, this.camera, x, y) });
  }

  private say(error: unknown): void {
    this.message.textContent = error ? (error as Error).message : "";
    this.message.classList.toggle("wrong", Boolean(error));
  }

  private loadFactors(progress: Progress): void {
    this.store.on(["run"], () => {
      void progress.largestForce().then((force) => this.store.set({ leastForce: ROUNDING * force }));
      progress.values("steps/load_factor").then((loadFactors) => this.store.set({ loadFactors }), () => undefined);
    });
  }

  private toggleTheme(): void {
    this.store.set({ theme: this.store.state.theme === "dark" ? "light" : "dark" });
  }

  private header(dialogs: { information: HTMLDialogElement; help: HTMLDialogElement }): HTMLElement {
    const { run } = this.store.state;
    const state = element("button", { class: "state", title: "About this run (i)", click: () => dialogs.information.showModal() });
    this.store.on(["run"], ({ run: now }) => {
      state.dataset["state"] = now.state;
      const warnings = now.warnings.length;
      state.textContent = STATE_TEXT[now.state] + (warnings ? ` · ${warnings} ${warnings === 1 ? "warning" : "warnings"}` : "");
    });
    const button = (label: string, sign: string, click: () => void): HTMLElement => element("button", { class: "icon", "aria-label": label, title: label, click }, sign);
    return element("div", { class: "header" },
      element(run.embedded ? "h2" : "h1", {}, run.title || "kavics"), state, element("span", { class: "space" }),
      button("Light or dark (t)", "◐", () => this.toggleTheme()),
      button("About this run (i)", "i", () => dialogs.information.showModal()), button("Help (?)", "?", () => dialogs.help.showModal()));
  }

  private stage(): HTMLElement {
    const button = (label: string, sign: string, click: () => void): HTMLElement => element("button", { class: "icon", "aria-label": label, title: label, click }, sign);
    const tools = element("div", { class: "tools", role: "group", "aria-label": "Picture" },
      button("Zoom in (+)", "+", () => this.camera.zoom(1.25)), button("Zoom out (−)", "−", () => this.camera.zoom(0.8)), button("Fit (0)", "⤢", () => this.camera.fit()));
    return element("div", { class: "stage" }, this.canvas, this.overlay.node, tools, this.message);
  }
}

function section(title: string, content: HTMLElement, open: boolean): HTMLElement {
  return element("details", { open }, element("summary", {}, title), content);
}

function initial(run: Run): State {
  const forces = run.contacts <= FORCES_UP_TO;
  const dark = matchMedia("(prefers-color-scheme: dark)").matches;
  return {
    run, step: run.recorded.at(-1) ?? 0, playing: false, loadFactors: new Float64Array(),
    layers: {
      grains: true, forces, broken: true, container: true, graph: false, dual: false, cells: false, window: false, stress: false, fabric: false, modes: false,
    },
    colour: { grains: !forces && hasColumn(run, "grains", "displacement") ? "displacement" : "", forces: "", cells: "" },
    range: { grains: null, forces: null, cells: null },
    leastForce: 0, factor: 1, width: 0.6, mode: 0, selection: null, theme: dark ? "dark" : "light",
  };
}
