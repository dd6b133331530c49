import type { Source } from "./source";
import type { Store } from "./store";
import type { Tables } from "./tables";

const EVERY = 1000;
const GROWING = ["steps", "actions", "events"];

/** Asks for news as long as the run goes on. A page that shows the last load step stays at the last. */
export async function watch(store: Store, source: Source, tables: Tables): Promise<void> {
  while (store.state.run.state === "running" && !store.state.run.embedded) {
    await new Promise((done) => setTimeout(done, EVERY));
    const run = await source.run().catch(() => null);
    const { run: before, step } = store.state;
    if (!run || (run.change === before.change && run.state === before.state)) continue;
    GROWING.forEach((table) => tables.forget(table));
    const last = run.recorded.at(-1) ?? 0;
    store.set({ run, step: step === before.recorded.at(-1) ? last : step });
  }
}
