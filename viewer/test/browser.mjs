// What the tests share: the program, results, a browser, and a page that notes what goes wrong in it.
import { spawn, spawnSync } from "node:child_process";
import { cpSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";

export const here = dirname(fileURLToPath(import.meta.url));
export const root = join(here, "../..");
export const program = process.env.KAVICS_BINARY ?? join(root, "target/release/kavics");
export const scratch = mkdtempSync(join(tmpdir(), "kavics-viewer-"));
process.on("exit", () => rmSync(scratch, { recursive: true, force: true }));

const FLAGS = [
  "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
  "--disable-component-update", "--disable-sync", "--force-color-profile=srgb",
];

export function launch() {
  const found = spawnSync("sh", ["-c", "command -v chromium || command -v chromium-browser || command -v google-chrome"], { encoding: "utf8" });
  const executablePath = process.env.KAVICS_CHROMIUM ?? found.stdout.trim();
  if (!executablePath) throw new Error("no Chromium on PATH; name one in KAVICS_CHROMIUM");
  return chromium.launch({ executablePath, headless: true, args: FLAGS });
}

/** Runs a scene of the project, or the text of one; gives the results folder. */
export function results(name, text, ...options) {
  const folder = join(scratch, `${name}.results`);
  const scene = text ? join(scratch, `${name}.toml`) : join(root, "scenes", `${name}.toml`);
  if (text) writeFileSync(scene, text);
  const run = spawnSync(program, ["run", scene, "-o", folder, "--force", ...options], { encoding: "utf8" });
  if (![0, 3].includes(run.status)) throw new Error(`${program} run ${scene}: ${run.stderr}`);
  return folder;
}

export function copy(folder, name) {
  const to = join(scratch, name);
  cpSync(folder, to, { recursive: true });
  return to;
}

/** Serves a results folder; gives the address and what ends it. */
export async function serve(folder) {
  const child = spawn(program, ["view", folder, "--no-open"], { stdio: ["ignore", "pipe", "pipe"] });
  const address = await new Promise((resolve, reject) => {
    let said = "";
    const listen = (data) => {
      said += data;
      const found = /http:\/\/127\.0\.0\.1:\d+\//.exec(said);
      if (found) resolve(found[0]);
    };
    child.stdout.on("data", listen);
    child.stderr.on("data", listen);
    child.on("exit", () => reject(new Error(`kavics view ended: ${said}`)));
  });
  return { address, stop: () => child.kill("SIGTERM") };
}

/** A page with the viewer at an address, once its first picture is there. */
export async function open(browser, address, settings = {}) {
  const context = await browser.newContext({ viewport: { width: 1000, height: 800 }, colorScheme: "light", ...settings });
  const page = await context.newPage();
  page.wrong = [];
  page.asked = [];
  page.on("pageerror", (error) => page.wrong.push(error.message));
  page.on("console", (message) => message.type() === "error" && page.wrong.push(message.text()));
  page.on("request", (request) => page.asked.push(request.url()));
  if (process.env.KAVICS_FRESH_PAGE) await freshPage(page);
  await page.goto(address);
  await page.waitForSelector("[data-drawn]", { timeout: 60_000 });
  return page;
}

/** With KAVICS_FRESH_PAGE the page of dist/ takes the place of the one that the program was built with. */
async function freshPage(page) {
  const names = ["index.html", "viewer.js", "viewer.css"];
  await page.route((url) => url.protocol === "http:" && names.includes(url.pathname.slice(1) || "index.html"), async (route) => {
    const name = new URL(route.request().url()).pathname.slice(1) || "index.html";
    await route.fulfill({ response: await route.fetch(), body: readFileSync(join(here, "../dist", name)) });
  });
}

/** Waits until a load step is in the picture. */
export function drawn(page, step) {
  return page.waitForSelector(`[data-drawn="${step}"]`, { timeout: 30_000 });
}

/** Waits until nothing is asked for and all is drawn. */
export async function quiet(page) {
  await page.waitForSelector('.stage[aria-busy="false"]', { timeout: 30_000 });
}

export async function find(page, kind, id) {
  await page.getByLabel("What to find").selectOption(kind);
  await page.getByLabel("Number of the grain or contact").fill(String(id));
  await page.getByRole("button", { name: "Find" }).click();
  await page.locator(".numbers .name").filter({ hasText: new RegExp(`${kind} ${id}\\b`, "i") }).waitFor();
}

/** Middle of the mark around the selected grain, in the window. */
export async function markPlace(page) {
  const mark = page.locator(".mark circle").first();
  const [x, y] = [Number(await mark.getAttribute("cx")), Number(await mark.getAttribute("cy"))];
  const box = await page.locator(".stage").boundingBox();
  return { x: box.x + x, y: box.y + y };
}

export function layer(page, name) {
  return page.locator(`[data-layer="${name}"]`);
}
