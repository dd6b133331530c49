/** What `run.json` tells of a run. */
export interface Run {
  title: string;
  version: string;
  schema_version: number;
  seed: number;
  state: "running" | "done" | "no-equilibrium" | "stopped";
  failure: string | null;
  warnings: string[];
  grains: number;
  contacts: number;
  /** Grows whenever there is something new. */
  change: number;
  /** Load steps with tables of grains and contacts, rising. */
  recorded: number[];
  load_steps: number;
  /** Corners, counter-clockwise. */
  container: [number, number][];
  tables: Record<string, ColumnInfo[] | undefined>;
  has: {
    dual: boolean;
    crosses: boolean;
    cells: number[];
    voids: number[];
    cracks: number[];
    modes: number[];
  };
  scene: string;
  embedded: boolean;
}

export interface ColumnInfo {
  name: string;
  unit: string;
  /** Names of the codes of a column of words. */
  values?: string[];
}

/** Stands for null in columns of integers. */
export const NONE = -2147483648;

export function hasColumn(run: Run, table: string, name: string): boolean {
  return run.tables[table]?.some((column) => column.name === name) ?? false;
}

/** The recorded load step that is nearest to `step`. */
export function nearestRecorded(run: Run, step: number): number {
  return run.recorded.reduce(
    (best, at) => (Math.abs(at - step) < Math.abs(best - step) ? at : best),
    run.recorded[0] ?? 0,
  );
}

/** "mean_stress" as it is read: "mean stress". */
export function spoken(name: string): string {
  return name.replaceAll("_", " ");
}

export function withUnit(column: ColumnInfo): string {
  const unit = column.unit.replaceAll("*", "·").replaceAll("^2", "²").replaceAll("^3", "³");
  return unit === "" || unit === "1" ? spoken(column.name) : `${spoken(column.name)} [${unit}]`;
}

/** A number as short as four digits allow. */
export function short(value: number): string {
  if (!Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  const text = size >= 1e5 || size < 1e-3 ? value.toExponential(2) : String(Number(value.toPrecision(4)));
  return text.replace("-", "−").replace("e+", "e");
}
