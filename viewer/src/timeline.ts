import { element } from "./dom";
import { nearestRecorded, short } from "./run";
import type { State, Store } from "./store";

/** Load steps a second while playing, at most. */
const PACE = 8;

/** Goes `by` recorded load steps on or back. */
export function go(store: Store, by: number): void {
  const { recorded } = store.state.run;
  const at = recorded.indexOf(store.state.step) + by;
  store.set({ step: recorded[Math.min(Math.max(at, 0), recorded.length - 1)] ?? 0 });
}

export function goTo(store: Store, step: number): void {
  store.set({ step: nearestRecorded(store.state.run, step) });
}

export function togglePlay(store: Store): void {
  const { playing, run, step } = store.state;
  const atEnd = step === run.recorded.at(-1);
  store.set(playing ? { playing: false } : { playing: true, step: atEnd ? (run.recorded[0] ?? 0) : step });
}

/** The load factor of a load step, in words. */
export function factorText({ loadFactors }: State, step: number): string {
  const factor = loadFactors[step];
  if (factor === undefined || Number.isNaN(factor)) return step === 0 ? "before loading" : "";
  return `factor ${short(factor)}`;
}

/** The slider with its buttons. `drawn` resolves when the load step that is set is in the picture. */
export function timeline(store: Store, drawn: () => Promise<void>): HTMLElement {
  const slider = element("input", {
    type: "range", min: 0, step: 1, class: "slider", "aria-label": "Load step",
    input: () => store.set({ step: store.state.run.recorded[slider.valueAsNumber] ?? 0, playing: false }),
  });
  const play = element("button", { class: "icon", click: () => togglePlay(store) });
  const text = element("output", { class: "step", "aria-live": "off" });
  const button = (label: string, sign: string, by: number): HTMLElement =>
    element("button", { class: "icon", "aria-label": label, title: label, click: () => go(store, by) }, sign);
  store.on(["run", "step", "playing", "loadFactors"], (state) => {
    const { run, step, playing } = state;
    const factor = factorText(state, step);
    const at = run.recorded.indexOf(step);
    slider.max = String(Math.max(run.recorded.length - 1, 0));
    slider.value = String(at);
    slider.disabled = run.recorded.length < 2;
    slider.setAttribute("aria-valuetext", `load step ${step}, ${factor}`);
    text.replaceChildren(element("b", {}, `Step ${step}`), ` of ${run.load_steps}`, element("span", {}, factor));
    play.textContent = playing ? "❚❚" : "▶";
    play.title = playing ? "Pause (space)" : "Play (space)";
    play.setAttribute("aria-label", playing ? "Pause" : "Play");
  });
  store.on(["playing"], ({ playing }) => {
    if (playing) void run(store, drawn);
  });
  return element("div", { class: "timeline", role: "group", "aria-label": "Load steps" },
    button("Step back (,)", "‹", -1), play, button("Step on (.)", "›", 1), slider, text);
}

async function run(store: Store, drawn: () => Promise<void>): Promise<void> {
  while (store.state.playing) {
    await Promise.all([drawn(), new Promise((done) => setTimeout(done, 1000 / PACE))]);
    if (!store.state.playing) return;
    if (store.state.step === store.state.run.recorded.at(-1)) store.set({ playing: false });
    else go(store, 1);
  }
}
