import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { find, launch, layer, markPlace, open, quiet, results, serve } from "./browser.mjs";

const SCENE = `
[box]
width = 120.0
height = "fit"
[grains.hexagonal]
radius = 1.0
rows = { count = 60, longest = 60 }
[contact.mortar.cemented]
stiffness.layer = { normal = 1.0, shear = 0.6 }
[[support]]
grains = { edge = "bottom" }
fix = ["x", "y"]
[[load]]
name = "press"
edge = "top"
normal = [-1e-6, -1e-6]
[[stage]]
factors = [1.0]
`;
let browser, server, page;

before(async () => {
  browser = await launch();
  server = await serve(results("small", SCENE));
  page = await open(browser, server.address);
});

after(async () => {
  server?.stop();
  await browser?.close();
});

test("a click finds a grain of a pixel", async () => {
  await layer(page, "forces").uncheck();
  await page.locator(".picture").focus();
  for (let k = 0; k < 10; k++) await page.keyboard.press("-");
  for (const id of [0, 59, 1234, 3500]) {
    await find(page, "grain", id);
    await quiet(page);
    const place = await markPlace(page);
    await page.keyboard.press("Escape");
    await page.mouse.click(place.x, place.y);
    const heading = page.locator(".numbers .name");
    await heading.waitFor();
    assert.equal(await heading.textContent(), `Grain ${id}×`);
  }
});

test("every grain of a pixel is drawn", async () => {
  await layer(page, "container").uncheck();
  const [first, last] = [await placeOf(0), await placeOf(59)];
  await page.keyboard.press("Escape");
  await quiet(page);
  const stage = await page.locator(".stage").boundingBox();
  const scale = (last.x - first.x) / 118;
  assert.ok(2 * scale < 1.3);
  const centres = [];
  for (let row = 0; row < 60; row++) {
    for (let k = 0; k < 60 - (row % 2); k++) {
      centres.push([first.x - stage.x + (2 * k + (row % 2)) * scale, first.y - stage.y - Math.sqrt(3) * row * scale]);
    }
  }
  assert.equal(await page.evaluate(bare, centres), 0);
  assert.deepEqual(page.wrong, []);
});

async function placeOf(id) {
  await find(page, "grain", id);
  await quiet(page);
  return markPlace(page);
}

/** How many of the places have the colour of the ground, as the lower left corner has. */
async function bare(places) {
  const canvas = document.querySelector(".picture");
  const gl = canvas.getContext("webgl2");
  for (const key of ["ArrowLeft", "ArrowRight"]) canvas.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true }));
  await new Promise((drawn) => requestAnimationFrame(drawn));
  const pixels = new Uint32Array(canvas.width * canvas.height);
  gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(pixels.buffer));
  return places.filter(([x, y]) => pixels[(canvas.height - 1 - Math.floor(y)) * canvas.width + Math.floor(x)] === pixels[0]).length;
}
