import assert from "node:assert/strict";
import { existsSync } from "node:fs";
import { spawnSync } from "node:child_process";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { after, before, test } from "node:test";
import { drawn, find, launch, markPlace, open, program, quiet, results } from "./browser.mjs";

let browser, page;

before(async () => {
  const folder = results("dropped-1000");
  const report = join(folder, "report.html");
  if (!existsSync(report)) spawnSync(program, ["report", folder]);
  browser = await launch();
  page = await open(browser, pathToFileURL(report).href);
});

after(() => browser?.close());

test("a report shows the last load step as a file, and asks for nothing", async () => {
  await drawn(page, 60);
  await quiet(page);
  assert.deepEqual(page.wrong, []);
  assert.deepEqual(page.asked.filter((url) => !url.startsWith("data:") && !url.startsWith("file:")), []);
});

test("the slider of a report goes to its load steps", async () => {
  const slider = page.getByLabel("Load step", { exact: true });
  await slider.fill("0");
  await drawn(page, 0);
  await slider.focus();
  await page.keyboard.press("End");
  await drawn(page, 60);
});

test("a report gives the numbers of a grain", async () => {
  await find(page, "grain", 345);
  const place = await markPlace(page);
  for (const name of ["forces", "broken"]) {
    const box = page.locator(`[data-layer="${name}"]`);
    if (await box.count()) await box.uncheck();
  }
  await page.mouse.click(place.x, place.y);
  await page.locator(".numbers .name", { hasText: "Grain 345" }).waitFor();
  assert.match(await page.locator(".numbers dl").textContent(), /radius0\.\d+/);
});

test("keys pressed outside the viewer are not its own", async () => {
  await page.evaluate(() => document.activeElement?.blur());
  await page.keyboard.press("Home");
  await quiet(page);
  await drawn(page, 60);
  assert.deepEqual(page.wrong, []);
});
