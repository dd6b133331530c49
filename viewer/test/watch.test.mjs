import assert from "node:assert/strict";
import { cpSync, mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { drawn, launch, open, quiet, results, scratch, serve } from "./browser.mjs";

const KINDS = ["grains", "contacts", "sides"];
let browser, server, whole, growing;

before(async () => {
  whole = results("block-32");
  growing = join(scratch, "growing.results");
  mkdirSync(growing);
  for (const name of ["scene.toml", "steps.parquet", "actions.parquet", "events.parquet"]) cpSync(join(whole, name), join(growing, name));
  for (const kind of KINDS) mkdirSync(join(growing, kind));
  for (const step of [0, 1]) addStep(step);
  tellState("running");
  browser = await launch();
  server = await serve(growing);
});

after(async () => {
  server?.stop();
  await browser?.close();
});

test("a run that is watched gains load steps, and the page goes with them from the last", async () => {
  const page = await open(browser, server.address);
  await drawn(page, 1);
  addStep(2);
  await drawn(page, 2);
  await page.keyboard.press("Home");
  await drawn(page, 0);
  addStep(3);
  await page.waitForFunction(() => document.querySelector(".slider").max === "3");
  await quiet(page);
  await drawn(page, 0);
  tellState("done");
  await page.locator(".state", { hasText: "done" }).waitFor();
  const asked = page.asked.length;
  await page.waitForTimeout(1500);
  assert.equal(page.asked.length, asked);
  assert.deepEqual(page.wrong, []);
});

/** Contacts and sides first: a load step is there when its grains are. */
function addStep(step) {
  const name = `${String(step).padStart(6, "0")}.parquet`;
  for (const kind of [...KINDS].reverse()) cpSync(join(whole, kind, name), join(growing, kind, name));
}

function tellState(state) {
  const run = JSON.parse(readFileSync(join(whole, "run.json"), "utf8"));
  writeFileSync(join(growing, "run.json"), JSON.stringify({ ...run, state }));
}
