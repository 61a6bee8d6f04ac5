// SPDX-License-Identifier: Apache-2.0
// Two aircraft on the ground, one of them without a parameter: the page says who is ready, what to
// do, and takes nothing for good that it does not hear.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { once } from "node:events";
import { mkdir, readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { after, before, test } from "node:test";

import { free_port, programs, until, work } from "./bench.mjs";
import { barriers, browse } from "./browser.mjs";

const folder = join(work, "preflight");
const children = new Map();
let view;
let text = "";

function start(name, program, more) {
  const child = spawn(join(programs, program), more, { cwd: folder, stdio: ["ignore", "pipe", "pipe"] });
  child.stdout.on("data", (data) => (text += data));
  child.stderr.on("data", (data) => (text += data));
  children.set(name, child);
  return child;
}
async function end(name) {
  const child = children.get(name);
  children.delete(name);
  if (!child || child.exitCode !== null) return;
  const exited = once(child, "exit");
  child.kill("SIGTERM");
  await exited;
}

const place = "origin: {latitude_deg: 31.522062, longitude_deg: 105.044327, height_m: 480}";
// Others may run on this machine.
const bus = (id) => `mcast:${20 + (process.pid % 100) * 2 + id}`;

async function start_vehicle(id, common, more = []) {
  const file = `v${id}.yaml`;
  await writeFile(
    join(folder, file),
    `version: 1
vehicle: {id: ${id}, cruise_speed_mps: 50, speed_min_mps: 42, speed_max_mps: 58, turn_radius_m: 150,
  range_m: 40000, capabilities: [survey], sensor_radius_m: 300, height_m: 100}
start: {east_m: 0, north_m: 0, heading_deg: 90}
search: [[2000, 0]]
flight_controller: {kind: ardupilot, can: "${bus(id)}"}
${common}`,
  );
  start(`fc-${id}`, "skein-fc", ["--bus", bus(id), "--failsafe", "--speed-min", "40", "--speed-max", "60", ...more]);
  start(`onboard-${id}`, "skein-onboard", ["--config", file]);
}

before(async () => {
  await mkdir(folder, { recursive: true });
  const console_port = await free_port();
  const common = `${place}
network: {address: 127.0.0.1, port: ${await free_port()}}
time: {epoch_unix_ns: ${Math.floor(Date.now() / 1000)}000000000}
`;
  await writeFile(
    join(folder, "ground.yaml"),
    `version: 1
vehicles: [1, 2, 3]
console: {port: ${console_port}}
control_socket: skein-preflight-${console_port}
recording_folder: ground
${common}`,
  );
  start("ground", "skein-ground", ["--config", "ground.yaml"]);
  const token = await until(`the console\n${text}`, () => readFile(join(folder, "ground", "console.token"), "utf8").catch(() => null));
  await until("the page", () => fetch(`http://127.0.0.1:${console_port}/`).then((answer) => answer.ok, () => false));
  view = await browse(`http://127.0.0.1:${console_port}/#${token.trim()}`);
  await view.part("tab-preflight").click();
  await until("the page Preflight", async () => (await summary()).startsWith("0 of 3 ready, 3 not: 1 (never heard)"));
  await start_vehicle(1, common);
  await start_vehicle(2, common, ["--without", "FS_LONG_ACTN"]);
});
after(async () => {
  await view?.browser.close();
  for (const name of [...children.keys()]) await end(name);
});

const summary = () => view.part("preflight-summary").innerText();
const readiness = (id) => view.part(`preflight-${id}`).getAttribute("data-readiness");
const marks = (id) => view.part(`preflight-${id}`).locator("[data-mark]").evaluateAll((cells) => cells.map((cell) => cell.dataset.mark));

test("a fault on one vehicle stands on the page within seconds, the other is ready", async () => {
  const begun = Date.now();
  await until(`the fault\n${text}`, async () => (await readiness(2)) === "not_ready" && (await summary()).includes("2 (parameters)"));
  console.log(`the fault was on the page ${Date.now() - begun} ms after the vehicle was started`);
  await until("the other", async () => (await readiness(1)) === "ready");
  assert.match(await summary(), /^1 of 3 ready, 2 not: 2 \(parameters\), 3 \(never heard\)$/);
  assert.ok((await marks(1)).includes("ok"));
  assert.ok((await marks(2)).includes("fail"));
  assert.ok(!(await marks(3)).includes("ok"));
  assert.match(await view.part("preflight-2-parameters").innerText(), /^≠/);
  await view.picture("preflight");
});

test("a row opens to its lines by the keyboard, with what to do", async () => {
  await view.part("tab-preflight").focus();
  const button = view.part("preflight-2").getByRole("button");
  for (let i = 0; i < 20 && !(await button.evaluate((element) => element === document.activeElement)); ++i) await view.page.keyboard.press("Tab");
  await view.page.keyboard.press("Enter");
  assert.equal(await button.getAttribute("aria-expanded"), "true");
  assert.match(await view.part("preflight-lines-2").innerText(), /FAIL FS_LONG_ACTN: not told\s+it does not tell FS_LONG_ACTN, which must be 1/);
  await view.page.keyboard.press("1");
  await view.part("fleet").waitFor();
  await view.page.keyboard.press("6");
  await view.part("preflight").waitFor();
});

test("no serious barrier, in either colours", async () => {
  for (const colours of ["these", "the others"]) {
    assert.deepEqual(await barriers(view.page), [], colours);
    await view.part("theme").click();
  }
});

test("on a telephone all groups and the lines are in sight", async () => {
  await view.page.setViewportSize({ width: 390, height: 844 });
  await view.picture("preflight-390");
  const right = (locator) => locator.evaluate((element) => element.getBoundingClientRect().right);
  assert.ok((await right(view.part("preflight-2").locator("[data-mark]").last())) <= 390);
  assert.ok((await right(view.part("preflight-lines-2"))) <= 390);
  assert.ok((await right(view.part("preflight-summary"))) <= 390);
  assert.ok((await right(view.part("tab-preflight"))) <= 390);
  assert.equal(await view.page.evaluate(() => document.documentElement.scrollWidth), 390);
  await view.page.setViewportSize({ width: 1280, height: 720 });
});

test("what is not heard any more is not green, and its age grows", async () => {
  await end("onboard-1");
  await until("silence", async () => (await summary()).includes("1 (silent)"));
  assert.deepEqual([...new Set(await marks(1))].filter((tone) => !["old", "none"].includes(tone)), []);
  const age = () => view.part("preflight-1").locator("td.figure").innerText();
  const before = await age();
  await until("an older one", async () => (await age()) !== before);
  await view.picture("preflight-silent");
});

test("without the ground station nothing is", async () => {
  await end("ground");
  await until("the loss", async () => (await summary()).startsWith("Not known now"));
  for (const id of [1, 2, 3]) assert.ok((await marks(id)).every((tone) => ["old", "none"].includes(tone)), `vehicle ${id}`);
  assert.deepEqual(view.foreign, []);
  assert.deepEqual(view.complaints, []);
});
