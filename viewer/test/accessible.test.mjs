import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { after, before, test } from "node:test";
import { find, launch, open, quiet, results, serve } from "./browser.mjs";

const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
let browser, server;

before(async () => {
  browser = await launch();
  server = await serve(results("block-32"));
});

after(async () => {
  server?.stop();
  await browser?.close();
});

for (const colorScheme of ["light", "dark"]) {
  test(`axe finds nothing wrong in the ${colorScheme} page`, async () => {
    const page = await open(browser, server.address, { colorScheme });
    await page.getByLabel("Colour of grains").selectOption("mean_stress");
    await page.locator('[data-layer="stress"]').check();
    await find(page, "grain", 3);
    await quiet(page);
    await expectNothing(page);
    for (const name of ["Help (?)", "About this run (i)"]) {
      await page.getByRole("button", { name }).click();
      await expectNothing(page);
      await page.keyboard.press("Escape");
    }
    await page.close();
  });
}

test("a narrow page shows everything below one another", async () => {
  const page = await open(browser, server.address, { viewport: { width: 400, height: 800 } });
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= 400));
  await page.getByText("Curves", { exact: true }).scrollIntoViewIfNeeded();
  await expectNothing(page);
  await page.close();
});

async function expectNothing(page) {
  const found = await page.evaluate(`${axe}; axe.run(document, { runOnly: ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "best-practice"] })`);
  const wrong = found.violations.map(({ id, impact, nodes }) => `${impact} ${id}: ${nodes.map((node) => node.html).join(" | ")}`);
  assert.deepEqual(wrong, []);
}
