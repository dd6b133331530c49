import assert from "node:assert/strict";
import { after, before, describe, test } from "node:test";
import { drawn, find, launch, layer, markPlace, open, quiet, results, serve } from "./browser.mjs";

let browser, server, page;

before(async () => {
  browser = await launch();
  server = await serve(results("dropped-1000"));
  page = await open(browser, server.address);
});

after(async () => {
  server?.stop();
  await browser?.close();
});

describe("a served run", () => {
  test("shows its last load step without an error", async () => {
    await drawn(page, 60);
    await quiet(page);
    assert.deepEqual(page.wrong, []);
    assert.match(await page.title(), /Dropped grains/);
    assert.match(await page.locator(".picture").getAttribute("aria-label"), /1000 grains at load step 60/);
  });

  test("asks its own server for everything", () => {
    assert.ok(page.asked.length > 5);
    for (const url of page.asked) assert.ok(url.startsWith(server.address) || url.startsWith("data:"), url);
  });

  test("asks for no column that it does not show", () => {
    const grains = page.asked.filter((url) => url.includes("/data/grains/"));
    assert.ok(grains.length > 0);
    for (const url of grains) assert.doesNotMatch(url, /stress|cell_area|moment/);
  });

  test("goes where the slider goes, and the curves with it", async () => {
    const reading = page.locator(".reading").first();
    const before = await reading.textContent();
    await page.getByLabel("Load step", { exact: true }).focus();
    await page.keyboard.press("Home");
    await drawn(page, 0);
    assert.equal(await reading.textContent(), "0, 0");
    await page.keyboard.press("End");
    await drawn(page, 60);
    assert.equal(await reading.textContent(), before);
  });

  test("goes where a curve is clicked", async () => {
    const plot = await page.locator(".u-over").first().boundingBox();
    await page.mouse.click(plot.x + 2, plot.y + plot.height - 2);
    await drawn(page, 0);
    await page.mouse.click(plot.x + plot.width - 2, plot.y + plot.height - 2);
    await drawn(page, 60);
  });

  test("plays from the first load step to the last", async () => {
    await page.getByRole("button", { name: "Play" }).click();
    await page.waitForFunction(() => Number(document.querySelector("[data-drawn]").dataset.drawn) < 60);
    await drawn(page, 60);
    await page.getByRole("button", { name: "Play" }).waitFor();
  });

  test("shows the numbers of the grain that is clicked", async () => {
    await find(page, "grain", 345);
    const place = await markPlace(page);
    await page.keyboard.press("Escape");
    await layer(page, "forces").uncheck();
    await layer(page, "broken").uncheck();
    await page.mouse.click(place.x, place.y);
    await page.locator(".numbers .name", { hasText: "Grain 345" }).waitFor();
    assert.match(await page.locator(".numbers dl").textContent(), /radius0\.\d+.*cell area/s);
    await layer(page, "forces").check();
    await layer(page, "broken").check();
  });

  test("tells how a contact broke", async () => {
    const id = await page.evaluate(firstBroken);
    await find(page, "contact", id);
    await page.locator(".numbers .event").waitFor();
    assert.match(await page.locator(".numbers .event").textContent(), /^Broke: event \d+, load step \d+, factor [\d.]+, in (tension|shear|bending)\.$/);
  });

  test("draws something else for every layer", async () => {
    await goTo(30);
    for (const name of ["grains", "forces", "broken", "graph", "dual", "cells", "window", "container", "stress", "fabric"]) {
      await quiet(page);
      const before = await page.locator(".picture").screenshot();
      await layer(page, name).click();
      await quiet(page);
      assert.ok(!before.equals(await page.locator(".picture").screenshot()), name);
      await layer(page, name).click();
    }
    await goTo(60);
  });

  test("colours grains by every column, and says which colour is which", async () => {
    const select = page.getByLabel("Colour of grains");
    for (const name of await select.locator("option").evaluateAll((list) => list.map((option) => option.value))) {
      await select.selectOption(name);
      await quiet(page);
      if (name !== "") assert.match(await page.locator(".legend").textContent(), new RegExp(`grains: ${name.replaceAll("_", " ")}`));
    }
    await select.selectOption("");
    assert.deepEqual(page.wrong, []);
  });

  test("keeps the range of the colours when told to", async () => {
    await page.getByLabel("Colour of grains").selectOption("displacement");
    await page.getByRole("button", { name: "hold" }).click();
    const highest = page.getByLabel("Colours of grains: highest value");
    const held = (await highest.inputValue()).replace(/^≥ /, "");
    await page.keyboard.press("Home");
    await drawn(page, 0);
    assert.equal((await highest.inputValue()).replace(/^≥ /, ""), held);
    await page.getByRole("button", { name: "held" }).click();
    await page.keyboard.press("End");
    await drawn(page, 60);
    await page.getByLabel("Colour of grains").selectOption("");
  });

  test("draws displacements larger when told to", async () => {
    await goTo(30);
    const number = page.getByLabel("Scale of the displacements, as a number");
    await find(page, "grain", 900);
    const before = await markPlace(page);
    await number.fill("20");
    await number.press("Enter");
    await quiet(page);
    assert.notDeepEqual(await markPlace(page), before);
    await page.getByRole("button", { name: "×1" }).click();
    await goTo(60);
    await page.keyboard.press("Escape");
  });

  test("zooms about the mouse and comes back", async () => {
    await find(page, "grain", 500);
    const start = await markPlace(page);
    await page.mouse.move(start.x, start.y);
    await page.mouse.wheel(0, -300);
    await quiet(page);
    const after = await markPlace(page);
    assert.ok(Math.hypot(after.x - start.x, after.y - start.y) < 1);
    await page.locator(".picture").focus();
    await page.keyboard.press("ArrowLeft");
    await page.keyboard.press("0");
    await quiet(page);
    assert.deepEqual(await markPlace(page), start);
    await page.keyboard.press("Escape");
  });

  test("can be used with the keyboard", async () => {
    await page.locator(".picture").focus();
    await page.keyboard.press("?");
    await page.getByRole("dialog", { name: "Help" }).waitFor();
    await page.keyboard.press("Escape");
    await page.keyboard.press("i");
    assert.match(await page.getByRole("dialog", { name: "About this run" }).textContent(), /seed1.*grains\.dropped/s);
    await page.keyboard.press("Escape");
    await page.keyboard.press(",");
    await drawn(page, 50);
    await page.keyboard.press(".");
    await drawn(page, 60);
    await page.keyboard.press("t");
    await page.locator('[data-theme="dark"]').waitFor();
    await page.keyboard.press("t");
    await page.keyboard.press("g");
    assert.equal(await layer(page, "grains").isChecked(), false);
    await page.keyboard.press("g");
    await page.keyboard.press("Enter");
    await page.locator(".numbers .name").waitFor();
    await page.keyboard.press("/");
    await page.keyboard.type("7");
    await page.keyboard.press("Enter");
    await page.locator(".numbers .name", { hasText: "Grain 7" }).waitFor();
  });

  test("has caused no error in all this", () => assert.deepEqual(page.wrong, []));
});

async function goTo(step) {
  const slider = page.getByLabel("Load step", { exact: true });
  await slider.fill(String(step / 10));
  await drawn(page, step);
}

/** The first contact in the events that broke. */
async function firstBroken() {
  for (let id = 0; id < 3000; id++) {
    const row = await (await fetch(`data/row/contacts/60/${id}`)).json();
    if (row.state === "broken") return id;
  }
  return -1;
}
