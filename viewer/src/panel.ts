import { element } from "./dom";
import { NONE, spoken, type Run } from "./run";
import type { Row, Source, Table } from "./source";
import type { Selection, State, Store } from "./store";
import type { Tables } from "./tables";

const EVENT = ["event", "step", "load_factor", "contact", "kind", "mode"];

/** The numbers of the grain or contact that is selected. */
export class Panel {
  readonly node: HTMLElement;
  private readonly body = element("div", { class: "numbers", "aria-live": "polite" });
  private asked = 0;

  constructor(private readonly store: Store, private readonly source: Source, private readonly tables: Tables) {
    this.node = element("div", {}, this.finder(), this.body);
    store.on(["selection", "step", "run"], (state) => void this.update(state));
  }

  private finder(): HTMLElement {
    const kind = element("select", { "aria-label": "What to find" }, element("option", { value: "grain" }, "grain"), element("option", { value: "contact" }, "contact"));
    const id = element("input", { type: "number", min: 0, step: 1, placeholder: "number", class: "find", "aria-label": "Number of the grain or contact" });
    const find = (event: Event): void => {
      event.preventDefault();
      const { run } = this.store.state;
      const count = kind.value === "grain" ? run.grains : run.contacts;
      if (id.valueAsNumber >= 0 && id.valueAsNumber < count) this.store.set({ selection: { kind: kind.value as Selection["kind"], id: id.valueAsNumber } });
      else this.body.replaceChildren(element("p", {}, `There are ${kind.value}s 0 to ${count - 1}.`));
    };
    return element("form", { class: "field", submit: find }, kind, id, element("button", {}, "Find"));
  }

  private async update({ selection, step, run }: State): Promise<void> {
    const asked = ++this.asked;
    if (!selection) {
      this.body.replaceChildren(element("p", { class: "hint" }, "Click a grain or a contact for its numbers."));
      return;
    }
    try {
      const parts = await this.numbers(selection, step, run);
      if (asked === this.asked) this.body.replaceChildren(...parts);
    } catch (error) {
      if (asked === this.asked) this.body.replaceChildren(element("p", { role: "alert" }, String((error as Error).message)));
    }
  }

  private async numbers(selection: Selection, step: number, run: Run): Promise<HTMLElement[]> {
    const table = `${selection.kind}s`;
    const row = (await this.source.row(table, step, selection.id)) ?? (await this.embeddedRow(table, step, selection.id, run));
    const close = element("button", { class: "icon", "aria-label": "Close", title: "Close (Esc)", click: () => this.store.set({ selection: null }) }, "×");
    const heading = element(run.embedded ? "h3" : "h2", { class: "name" }, `${selection.kind === "grain" ? "Grain" : "Contact"} ${selection.id}`, close);
    const units = new Map((run.tables[table] ?? []).map((column) => [column.name, column.unit]));
    const list = element("dl", {});
    for (const [name, value] of Object.entries(row)) {
      if (["step", "grain", "contact"].includes(name)) continue;
      const unit = units.get(name) ?? "";
      list.append(element("dt", { title: unit === "1" ? "" : unit }, spoken(name)), element("dd", {}, this.value(name, value)));
    }
    const event = selection.kind === "contact" ? await this.event(selection.id, step) : null;
    return [heading, ...(event ? [event] : []), list];
  }

  private value(name: string, value: Row[string]): Node | string {
    if (value === null || value === NONE) return "–";
    if (typeof value === "string") return value || "–";
    const partner = (name === "first" || name === "second") && value >= 0;
    if (partner) return element("button", { class: "link", click: () => this.store.set({ selection: { kind: "grain", id: value } }) }, `grain ${value}`);
    if (Number.isInteger(value)) return String(value);
    return Math.abs(value) < 1e-3 ? value.toExponential(6) : String(Number(value.toPrecision(8)));
  }

  private async embeddedRow(table: string, step: number, id: number, run: Run): Promise<Row> {
    const names = (run.tables[table] ?? []).map((column) => column.name);
    const found = await this.tables.at(table, step, names, run);
    return rowOf(found, id);
  }

  /** How a contact broke, or will break. */
  private async event(contact: number, step: number): Promise<HTMLElement | null> {
    const events = await this.tables.whole("events", EVENT).catch(() => null);
    const contacts = events?.get("contact")?.values;
    const kind = events?.get("kind");
    if (!events || !contacts || !kind) return null;
    const broke = kind.names?.indexOf("broke") ?? -1;
    for (let i = 0; i < contacts.length; i++) {
      if (contacts[i] !== contact || kind.values[i] !== broke) continue;
      const event = rowOf(events, i);
      const when = Number(event["step"]) <= step ? "Broke" : "Breaks later";
      return element("p", { class: "event" }, `${when}: event ${event["event"]}, load step ${event["step"]}, factor ${Number(Number(event["load_factor"]).toPrecision(5))}, in ${event["mode"]}.`);
    }
    return null;
  }
}

function rowOf(table: Table, at: number): Row {
  const row: Row = {};
  for (const [name, { values, names }] of table) row[name] = names ? (names[values[at]!] ?? null) : Number.isNaN(values[at]) ? null : values[at]!;
  return row;
}
