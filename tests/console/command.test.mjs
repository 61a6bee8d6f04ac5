// SPDX-License-Identifier: Apache-2.0
// Two ground stations of one mission, a page of each: the command is handed over, taken back, and
// taken from a ground station that has died; a delivery is authorised by who has it then.
import assert from "node:assert/strict";
import { mkdir, readFile, writeFile } from "node:fs/promises";
import { join, relative } from "node:path";
import { after, before, test } from "node:test";

import { fly, scenarios, until, work } from "./bench.mjs";
import { barriers, browse, hold, say } from "./browser.mjs";

const take_ms = 2300;
let mission;
let first;
let second;

const text = (view, id) => view.part(id).innerText().catch(() => "");
const mark = (view, words) => until(`'${words}' at the top`, async () => words.test(await text(view, "command-mark")), 20_000);
/** By the page's own socket, past its buttons. */
const order = (view, what) => say(view.page, { type: "order", order: what });
const take = (view) => hold(view.part("take-command"), take_ms);
const audit_of = async (folder) =>
  (await readFile(join(mission.folder, folder, "audit.jsonl"), "utf8")).split("\n").filter(Boolean).map((line) => JSON.parse(line));

/** The small mission, longer, and its first ground station is killed. */
async function with_the_first_killed() {
  const small = await readFile(join(scenarios, "coalition-6.yaml"), "utf8");
  const longer = small
    .replace("duration_max_s: 120", "duration_max_s: 400")
    .replace("range_m: 6000", "range_m: 20000")
    .replace("\nexpect:", "\nfaults:\n  - {at_s: 75, kill_vehicle: 0}\nexpect:");
  assert.match(longer, /400[^]*20000[^]*kill_vehicle/);
  await mkdir(work, { recursive: true });
  const file = join(work, "two-ground-stations.yaml");
  await writeFile(file, longer);
  return relative(scenarios, file);
}

before(async () => {
  mission = await fly(await with_the_first_killed(), "command", ["--ground-stations", "2"]);
  first = await browse(mission.url);
  second = await browse(await until("the second console", () => /^console of the second: (\S+)$/m.exec(mission.text())?.[1]));
});
after(async () => {
  await first?.browser.close();
  await second?.browser.close();
  await mission?.stop();
});

test("one is in command, the other watches, sees all, and gives no orders", async () => {
  await mark(first, /in command/);
  await mark(second, /WATCHING \(ground-1 has the command\)/);
  await until("six vehicles", async () => (await text(second, "count-heard")).includes("6/6"));
  assert.match(await text(second, "banner-command"), /WATCHING\.\s+ground-1 has the command/);
  assert.equal(await second.part("hold-all").count(), 0);
  assert.equal(await second.part("tab-orders").count(), 0);
  assert.equal(await first.part("hold-all").count(), 1);
  const refused = await order(second, { kind: "command", command: "hold", vehicle: 0 });
  assert.equal(refused.done, false);
  assert.match(refused.text, /ground-1 has the command; this ground station watches; 'take command' takes it/);
  assert.deepEqual(await barriers(second.page), []);
  await second.picture("watching");
});

test("a short press takes nothing", async () => {
  await hold(second.part("take-command"), 1000);
  assert.match(await text(second, "command-mark"), /WATCHING/);
  assert.deepEqual((await audit_of("ground-2")).filter(({ line, done }) => done && line.startsWith("take")), []);
});

test("the one in command asks, the other takes it, and the first says so and watches", async () => {
  await first.part("command-mark").click();
  await first.part("hand-over").click();
  await until("the wish", async () => /asks the others to take the command/.test(await text(second, "banner-command")));
  assert.match(await text(first, "command-mark"), /in command/);
  await second.part("take-reason").fill("moving the van");
  await take(second);
  await mark(second, /in command/);
  await mark(first, /WATCHING \(ground-2.*moving the van has the command\)/);
  await first.part("tab-log").click();
  await until("the event", async () => /moving the van has the command: this ground station only watches/.test(await text(first, "log")));
  assert.equal(await first.part("hold-all").count(), 0);
  assert.equal(await second.part("hold-all").count(), 1);
  assert.equal((await order(first, { kind: "command", command: "hold", vehicle: 2 })).done, false);
  await first.picture("handed-over");
});

test("vehicles obey the one that has it now", async () => {
  assert.equal((await order(second, { kind: "command", command: "hold", vehicle: 2 })).done, true);
  const state = async (view) => text(view, "vehicle-2");
  for (const view of [first, second]) await view.part("tab-fleet").click();
  for (const view of [first, second]) await until("vehicle 2 to hold", async () => /holding by order/.test(await state(view)), 15_000);
  assert.match(await text(second, "team-state"), /Some hold/);
  assert.equal((await order(second, { kind: "command", command: "resume", vehicle: 2 })).done, true);
  await until("vehicle 2 to go on", async () => !/holding by order/.test(await state(second)), 15_000);
});

test("the first takes it back", async () => {
  await take(first);
  await mark(first, /in command/);
  await mark(second, /WATCHING \(ground-1/);
});

test("a dead ground station leaves nobody in command, and the watching one is told", async () => {
  await until("the end of the first", () => /the ground station is killed/.test(mission.text()), 90_000);
  await until("the alarm", async () => /NOBODY in command/.test(await text(second, "command-mark")), 20_000);
  assert.match(await text(second, "banner-command"), /NOBODY is in command\.\s+ground-1.* had it, and is not heard/);
  assert.match(await text(second, "team-state"), /Nobody is in command/);
  await second.part("team-state").click();
  assert.match(await text(second, "team-rows"), /Take the command here/);
  assert.deepEqual(await barriers(second.page), []);
  await second.picture("nobody");
  await second.part("team-state").click();
});

test("it takes the command, authorises the delivery, and the mission is done with every check held", async () => {
  await take(second);
  await mark(second, /in command/);
  await until("a decision", async () => {
    const button = second.part("authorise-1").first();
    if (await button.isVisible()) await hold(button).catch(() => {});
    return (await audit_of("ground-2")).some(({ line, done, from }) => line === "authorise 1" && done && from === "console");
  }, 90_000);
  assert.equal(await mission.ended(), 0, mission.text());
});

test("nothing was asked of anybody else, and nothing was complained about", () => {
  for (const view of [first, second]) {
    assert.deepEqual(view.foreign, []);
    assert.deepEqual(view.complaints.filter((complaint) => !/ERR_CONNECTION|WebSocket/.test(complaint)), []);
  }
});
