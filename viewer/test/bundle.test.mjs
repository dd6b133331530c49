import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { here, scratch } from "./browser.mjs";

test("the committed page is what the sources give", () => {
  const made = join(scratch, "dist");
  const build = spawnSync(process.execPath, [join(here, "../build.mjs"), made], { encoding: "utf8" });
  assert.equal(build.status, 0, build.stderr);
  const committed = join(here, "../dist");
  assert.deepEqual(readdirSync(committed).sort(), readdirSync(made).sort());
  for (const name of readdirSync(made)) {
    assert.ok(readFileSync(join(made, name)).equals(readFileSync(join(committed, name))), `${name}: run npm run build`);
  }
});

test("the types of the sources agree", () => {
  const check = spawnSync(process.execPath, [join(here, "../node_modules/typescript/bin/tsc"), "--noEmit", "-p", join(here, "..")], { encoding: "utf8" });
  assert.equal(check.status, 0, check.stdout);
});
