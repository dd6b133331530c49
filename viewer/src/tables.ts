import type { Run } from "./run";
import type { Column, Source, Table } from "./source";

/** Columns that no load step changes: asked for once. */
const LASTING: Record<string, Set<string>> = {
  grains: new Set(["x", "y", "radius", "window"]),
  contacts: new Set(["first", "second", "nx", "ny", "x", "y", "dual_length_full", "branch_length"]),
};

const BYTES_KEPT = 400e6;

/** Columns of the run's tables, kept as long as there is room. */
export class Tables {
  private readonly columns = new Map<string, Column>();
  private readonly pending = new Map<string, Promise<Table>>();

  constructor(private readonly source: Source) {}

  /** Columns of the table of a load step; those that do not exist are left out. */
  async at(table: string, step: number, names: string[], run: Run): Promise<Table> {
    const lasting = LASTING[table];
    const once = names.filter((name) => lasting?.has(name));
    const first = run.recorded[0] ?? 0;
    // A report holds lasting columns only with its first load step.
    const home = run.embedded ? first : step;
    const [kept, moving] = await Promise.all([
      this.get(`${table}/${home}`, `${table}/*`, once),
      this.get(`${table}/${step}`, `${table}/${step}`, names.filter((name) => !lasting?.has(name))),
    ]);
    return new Map([...kept, ...moving]);
  }

  /** Columns of a table that belongs to no load step. */
  async whole(table: string, names: string[]): Promise<Table> {
    return this.get(table, table, names);
  }

  /** Forgets tables that grow in a running run. */
  forget(table: string): void {
    for (const key of [...this.columns.keys()]) if (key.startsWith(`${table}:`)) this.columns.delete(key);
  }

  private async get(name: string, key: string, wanted: string[]): Promise<Table> {
    const missing = wanted.filter((column) => !this.columns.has(`${key}:${column}`));
    if (missing.length > 0) {
      const table = await this.ask(name, missing);
      for (const [column, values] of table) this.columns.set(`${key}:${column}`, values);
    }
    const found: Table = new Map();
    for (const column of wanted) {
      const values = this.columns.get(`${key}:${column}`);
      if (values) {
        found.set(column, values);
        this.touch(`${key}:${column}`, values);
      }
    }
    this.makeRoom();
    return found;
  }

  private ask(name: string, columns: string[]): Promise<Table> {
    const key = `${name}?${columns.join()}`;
    const asked = this.pending.get(key) ?? this.source.table(name, columns);
    this.pending.set(key, asked);
    return asked.finally(() => this.pending.delete(key));
  }

  private touch(key: string, column: Column): void {
    this.columns.delete(key);
    this.columns.set(key, column);
  }

  private makeRoom(): void {
    let bytes = 0;
    for (const column of this.columns.values()) bytes += column.values.byteLength;
    for (const [key, column] of this.columns) {
      if (bytes <= BYTES_KEPT) break;
      if (key.includes("/*:")) continue;
      this.columns.delete(key);
      bytes -= column.values.byteLength;
    }
  }
}
