// Pictures against those in test/pictures/; KAVICS_NEW_PICTURES=1 writes them anew, to be looked at.
import assert from "node:assert/strict";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import pixelmatch from "pixelmatch";
import { PNG } from "pngjs";
import { here, launch, layer, open, quiet, results, serve } from "./browser.mjs";

/** Part of the pixels that may differ: rasterisers are not alike in every edge. */
const TOLERANCE = 0.01;

let browser;
const servers = {};

before(async () => {
  browser = await launch();
  for (const scene of ["block-32", "dropped-1000"]) servers[scene] = await serve(results(scene));
});

after(async () => {
  for (const server of Object.values(servers)) server.stop();
  await browser?.close();
});

const CASES = [
  ["forces", "dropped-1000", "light", ["broken"], [], {}, 3],
  ["broken", "dropped-1000", "light", [], ["forces"], {}, 3],
  ["stress", "block-32", "dark", ["stress"], ["forces"], { "Colour of grains": "mean_stress" }, 5],
  ["graphs", "block-32", "light", ["graph", "dual", "cells"], ["forces", "grains"], {}, 5],
  ["window", "block-32", "light", ["window"], [], { "Colour of forces": "shear_force" }, 4],
];

for (const [name, scene, colorScheme, on, off, colours, step] of CASES) {
  test(`the picture of ${name} is as it was`, async () => {
    const page = await open(browser, servers[scene].address, { colorScheme });
    await page.evaluate(sameEverywhere);
    for (const each of on) await layer(page, each).check();
    for (const each of off) await layer(page, each).uncheck();
    for (const [label, column] of Object.entries(colours)) await page.getByLabel(label).selectOption(column);
    await page.getByLabel("Load step", { exact: true }).fill(String(step));
    await page.waitForTimeout(100);
    await quiet(page);
    compare(name, await page.locator(".picture").screenshot());
    assert.deepEqual(page.wrong, []);
    await page.close();
  });
}

/** Nothing that depends on the fonts of the machine. */
function sameEverywhere() {
  for (const [selector, height] of [[".header", 44], [".legend", 76], [".timeline", 48]]) {
    Object.assign(document.querySelector(selector).style, { height: `${height}px`, minHeight: "0", overflow: "hidden", flexWrap: "nowrap" });
  }
  for (const selector of [".overlay", ".tools"]) document.querySelector(selector).style.visibility = "hidden";
  for (const column of document.querySelectorAll(".frame")) column.style.gridTemplateColumns = "600px 1fr";
}

function compare(name, shot) {
  const file = join(here, "pictures", `${name}.png`);
  if (process.env.KAVICS_NEW_PICTURES) {
    mkdirSync(join(here, "pictures"), { recursive: true });
    writeFileSync(file, shot);
    return;
  }
  const [expected, found] = [PNG.sync.read(readFileSync(file)), PNG.sync.read(shot)];
  assert.deepEqual([found.width, found.height], [expected.width, expected.height]);
  const differing = pixelmatch(expected.data, found.data, null, found.width, found.height, { threshold: 0.2 });
  const part = differing / (found.width * found.height);
  if (part > TOLERANCE) writeFileSync(file.replace(".png", ".found.png"), shot);
  assert.ok(part <= TOLERANCE, `${(100 * part).toFixed(2)} % of the pixels differ; see ${name}.found.png`);
}
