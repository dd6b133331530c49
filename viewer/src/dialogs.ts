import { ENTRIES } from "./controls";
import { element } from "./dom";
import type { Run } from "./run";
import type { Store } from "./store";

export const STATE_TEXT: Record<Run["state"], string> = {
  running: "running", done: "done", "no-equilibrium": "no equilibrium", stopped: "stopped",
};

function dialog(label: string, ...content: Node[]): HTMLDialogElement {
  const close = element("button", { class: "icon", "aria-label": "Close", click: () => made.close() }, "×");
  const made = element("dialog", { "aria-label": label }, element("h2", {}, label, close), ...content);
  made.addEventListener("click", (event) => {
    if (event.target === made) made.close();
  });
  return made;
}

/** What run and scene say. */
export function information(store: Store): HTMLDialogElement {
  const content = element("div");
  store.on(["run"], ({ run }) => content.replaceChildren(...describe(run)));
  return dialog("About this run", content);
}

function describe(run: Run): HTMLElement[] {
  const facts: [string, string][] = [
    ["title", run.title || "–"], ["state", STATE_TEXT[run.state]],
    ["grains", String(run.grains)], ["contacts", String(run.contacts)],
    ["load steps", `${run.load_steps}, with grains and contacts of ${run.recorded.length}${run.recorded[0] === 0 ? " (0 among them)" : ""}`],
    ["seed", String(run.seed)], ["version", `kavics ${run.version}, tables ${run.schema_version}`],
  ];
  const list = element("dl", {});
  for (const [name, value] of facts) list.append(element("dt", {}, name), element("dd", {}, value));
  const warnings = run.warnings.length > 0
    ? element("ul", { class: "warnings" }, ...run.warnings.map((text) => element("li", {}, text)))
    : element("p", {}, "No warnings.");
  return [
    list,
    ...(run.failure ? [element("p", { class: "failure" }, run.failure)] : []),
    element("h3", {}, "Warnings"), warnings,
    ...(run.scene ? [element("h3", {}, "Scene"), element("pre", { tabindex: 0, "aria-label": "Scene file" }, run.scene)] : []),
  ];
}

const KEYS: [string, string][] = [
  ["space", "play or pause"], [", .", "load step back, on"], ["← →", "the same; on the picture: move it"], ["home end", "first, last load step"],
  ["↑ ↓", "on the picture: move it"], ["+ −", "zoom"], ["0", "fit the assembly"], ["enter", "on the picture: select what is in its middle"],
  ["/", "find a grain or contact by its number"], ["esc", "select nothing"], ["t", "light or dark"], ["i", "about this run"], ["?", "this help"],
];

export function help(): HTMLDialogElement {
  const table = (rows: [string, string][]): HTMLElement =>
    element("table", {}, element("tbody", {}, ...rows.map(([key, text]) => element("tr", {}, element("th", { scope: "row" }, ...key.split(" ").map((one) => element("kbd", {}, one))), element("td", {}, text)))));
  return dialog("Help",
    element("p", {}, "Drag moves the picture, the wheel or two fingers zoom, a double click zooms in. A click on a grain or contact shows its numbers; a click on a curve goes to the nearest recorded load step."),
    element("h3", {}, "Keys"), table(KEYS),
    element("h3", {}, "Layers"), table(ENTRIES.map(({ key, text }) => [key, text])),
    element("h3", {}, "Signs"),
    element("p", {}, "Tension, opening and counter-clockwise rotation are positive. Crosses: blue compresses, orange pulls; the longest arm fills its square. Displacements are drawn as they are unless their scale says else."));
}
