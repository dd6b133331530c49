// Measures the page on a results folder: first picture, median frame, memory of the browser.
//     node bench.mjs RESULTS [FRAMES] [LAYER…]     layers to switch from what they are at first
import { readFileSync, readdirSync } from "node:fs";
import { launch, open, serve } from "./test/browser.mjs";

const [folder, frames = "21", ...layers] = process.argv.slice(2);
const server = await serve(folder);
const browser = await launch();
const page = await open(browser, server.address);
const first = await page.evaluate(() => performance.getEntriesByName("kavics-first-picture")[0].startTime);
for (const layer of layers) await page.locator(`[data-layer="${layer}"]`).click();
await page.waitForTimeout(200);
await page.waitForSelector('.stage[aria-busy="false"]', { timeout: 120_000 });
const all = await page.evaluate(() => performance.now());
const times = await page.evaluate(measure, Number(frames));
times.sort((a, b) => a - b);
console.log(`first picture ${first.toFixed(0)} ms, all layers ${all.toFixed(0)} ms after the page was asked for`);
console.log(`frame: median ${times[times.length >> 1].toFixed(0)} ms, fastest ${times[0].toFixed(0)}, slowest ${times.at(-1).toFixed(0)}, of ${frames}`);
console.log(`memory of the page: ${memory()}; load of the machine: ${readFileSync("/proc/loadavg", "utf8").split(" ").slice(0, 2).join(" ")}`);
await browser.close();
server.stop();

/** Draws the picture anew, moved to and fro, and waits for its pixels. */
async function measure(frames) {
  const canvas = document.querySelector(".picture");
  const gl = canvas.getContext("webgl2");
  const times = [];
  for (let k = -1; k < frames; k++) {
    canvas.dispatchEvent(new KeyboardEvent("keydown", { key: k % 2 ? "ArrowLeft" : "ArrowRight", bubbles: true }));
    const start = performance.now();
    await new Promise((drawn) => requestAnimationFrame(drawn));
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    if (k >= 0) times.push(performance.now() - start);
  }
  return times;
}

/** Private memory of the processes that draw the page and of the one that stands in for the graphics card. */
function memory() {
  const parts = [];
  for (const id of readdirSync("/proc").filter((name) => /^\d+$/.test(name))) {
    try {
      const kind = /--type=(renderer|gpu-process)/.exec(readFileSync(`/proc/${id}/cmdline`, "utf8"))?.[1];
      if (!kind) continue;
      const status = readFileSync(`/proc/${id}/smaps_rollup`, "utf8");
      const kilobytes = [...status.matchAll(/^Private_(?:Clean|Dirty):\s+(\d+)/gm)].reduce((sum, match) => sum + Number(match[1]), 0);
      parts.push(`${kind} ${Math.round(kilobytes / 1024)} MB`);
    } catch {
      continue; // the process has ended
    }
  }
  return parts.join(", ");
}
