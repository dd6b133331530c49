// Makes dist/ from src/; `node build.mjs DIR` writes elsewhere, for the test that dist/ is up to date.
import { build } from "esbuild";
import { copyFile, mkdir, readFile } from "node:fs/promises";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const out = process.argv[2] ?? join(here, "dist");
/** The licences of the libraries in the bundle ask to go with it. */
async function notice(name) {
  const text = await readFile(join(here, "node_modules", name, "LICENSE"), "utf8");
  return `${name}\n\n${text.trim()}`;
}
const notices = await Promise.all(["uplot", "@uwdata/flechette"].map(notice));

await mkdir(out, { recursive: true });
await build({
  absWorkingDir: here,
  entryPoints: { viewer: "src/main.ts" },
  bundle: true,
  minify: true,
  format: "iife",
  target: "es2022",
  charset: "utf8",
  banner: { js: `/*! In this file:\n\n${notices.join("\n\n")}\n*/` },
  legalComments: "inline",
  outdir: out,
  logLevel: "warning",
});
await copyFile(join(here, "src/index.html"), join(out, "index.html"));
