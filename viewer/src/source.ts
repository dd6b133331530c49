import { tableFromIPC } from "@uwdata/flechette";
import type { Run } from "./run";

export type Numbers = Float32Array | Float64Array | Int32Array | Uint8Array | Uint16Array;

export interface Column {
  values: Numbers;
  /** Names of the codes, if the column is one of words. */
  names: string[] | null;
  unit: string;
}

export type Table = Map<string, Column>;
export type Row = Record<string, number | string | null>;

/** Where the pieces of page data come from. */
export interface Source {
  run(): Promise<Run>;
  /** A table with at least the named columns that exist; all columns if none is named. */
  table(name: string, columns?: string[]): Promise<Table>;
  /** A row in full precision, or null where only tables are there. */
  row(table: string, step: number, id: number): Promise<Row | null>;
}

export function openSource(): Source {
  return document.querySelector('script[data-name="run.json"]') ? new EmbeddedSource() : new ServedSource();
}

class ServedSource implements Source {
  async run(): Promise<Run> {
    return (await this.get("run.json")).json() as Promise<Run>;
  }

  async table(name: string, columns?: string[]): Promise<Table> {
    const query = columns ? `?columns=${columns.map(encodeURIComponent).join(",")}` : "";
    return decode(await (await this.get(name + query)).arrayBuffer());
  }

  async row(table: string, step: number, id: number): Promise<Row | null> {
    return (await this.get(`row/${table}/${step}/${id}`)).json() as Promise<Row>;
  }

  private async get(name: string): Promise<Response> {
    const response = await fetch(`data/${name}`, { cache: "no-store" });
    if (!response.ok) throw new Error(`${name}: ${(await response.text()) || response.statusText}`);
    return response;
  }
}

/** Pieces that stand in the page itself, as scripts with the attribute `data-name`. */
class EmbeddedSource implements Source {
  async run(): Promise<Run> {
    return JSON.parse(this.find("run.json")?.textContent ?? "") as Run;
  }

  async table(name: string): Promise<Table> {
    const script = this.find(name);
    if (!script) throw new Error(`${name} is not in this page`);
    const binary = atob((script.textContent ?? "").trim());
    const bytes = Uint8Array.from(binary, (character) => character.charCodeAt(0));
    const encoded = script.dataset["encoding"] === "deflate";
    return decode(encoded ? await inflate(bytes) : bytes.buffer);
  }

  async row(): Promise<null> {
    return null;
  }

  private find(name: string): HTMLScriptElement | null {
    return document.querySelector(`script[data-name="${name}"]`);
  }
}

async function inflate(bytes: Uint8Array<ArrayBuffer>): Promise<ArrayBuffer> {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Response(stream).arrayBuffer();
}

function decode(buffer: ArrayBuffer): Table {
  const arrow = tableFromIPC(new Uint8Array(buffer));
  const table: Table = new Map();
  for (const field of arrow.schema.fields) {
    const words = field.metadata?.get("values");
    table.set(field.name, {
      values: arrow.getChild(field.name).toArray() as Numbers,
      names: words === undefined ? null : (JSON.parse(words) as string[]),
      unit: field.metadata?.get("unit") ?? "",
    });
  }
  return table;
}
