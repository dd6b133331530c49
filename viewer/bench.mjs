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
const before = processorTime();
const times = await page.evaluate(measure, Number(frames));
const busy = (processorTime() - before) / (Number(frames) + 1);
times.sort((a, b) => a - b);
console.log(`first picture ${first.toFixed(0)} ms, all layers ${all.toFixed(0)} ms after the page was asked for`);
console.log(`frame: median ${times[times.length >> 1].toFixed(0)} ms, fastest ${times[0].toFixed(0)}, slowest ${times.at(-1).toFixed(0)}, of ${frames}; ${busy.toFixed(0)} ms of processor time`);
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

/** Processes that draw pages, and the one that stands in for the graphics card. */
function processes() {
  return readdirSync("/proc").filter((name) => /^\d+$/.test(name)).flatMap((id) => {
    try {
      const kind = /--type=(renderer|gpu-process)/.exec(readFileSync(`/proc/${id}/cmdline`, "utf8"))?.[1];
      return kind ? [{ id, kind }] : [];
    } catch {
      return []; // it has ended
    }
  });
}

/** Processor time of these processes in ms, a tick being 10 ms. */
function processorTime() {
  return processes().reduce((sum, { id }) => {
    const fields = readFileSync(`/proc/${id}/stat`, "utf8").replace(/^.*\) /s, "").split(" ");
    return sum + 10 * (Number(fields[11]) + Number(fields[12]));
  }, 0);
}

/** Private memory of these processes. */
function memory() {
  return processes().map(({ id, kind }) => {
    const status = readFileSync(`/proc/${id}/smaps_rollup`, "utf8");
    const kilobytes = [...status.matchAll(/^Private_(?:Clean|Dirty):\s+(\d+)/gm)].reduce((sum, match) => sum + Number(match[1]), 0);
    return `${kind} ${Math.round(kilobytes / 1024)} MB`;
  }).join(", ");
}
