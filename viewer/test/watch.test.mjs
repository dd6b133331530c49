import assert from "node:assert/strict";
import { cpSync, mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { copy, drawn, launch, open, quiet, results, scratch, serve } from "./browser.mjs";

const KINDS = ["grains", "contacts", "sides"];
const TABLES = ["steps.parquet", "actions.parquet", "events.parquet"];
let browser, server, whole, growing;

before(async () => {
  const begun = copy(results("block-32", undefined, "--set", "stage.0.factors=[1.0]"), "begun.results");
  whole = results("block-32");
  growing = join(scratch, "growing.results");
  mkdirSync(growing);
  cpSync(join(whole, "scene.toml"), join(growing, "scene.toml"));
  for (const name of TABLES) cpSync(join(begun, name), join(growing, name));
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
  for (const step of [4, 5]) addStep(step);
  for (const name of TABLES) cpSync(join(whole, name), join(growing, name));
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
