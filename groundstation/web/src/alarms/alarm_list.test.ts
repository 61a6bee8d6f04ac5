// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { command } from "../orders/orders";
import { an_alarm } from "../wire/samples";
import type { GivenOrder } from "../wire/protocol";
import { answers_text, closest_text, connection_alarm, counts_of, counts_text, fresh_of, given_of, in_hand, lasted, sound_of, title_of, worst_of } from "./alarm_list";

const seen = { by: "ada", at_s: 70 };

test("what is heard: the worst that stands and nobody has acknowledged", () => {
  const warning = an_alarm(2, { level: "warning" });
  assert.equal(sound_of([]), null);
  assert.equal(sound_of([an_alarm(3, { level: "notice" })]), null);
  assert.equal(sound_of([warning]), "warning");
  assert.equal(sound_of([warning, an_alarm(1)]), "alarm");
  assert.equal(sound_of([warning, an_alarm(1, { acknowledged: seen })]), "warning");
  assert.equal(sound_of([an_alarm(1, { over_s: 65 })]), null, "it is over");
});

test("the one in the bar is open and stands, else the first that there is", () => {
  const over = an_alarm(5, { over_s: 65 });
  const known = an_alarm(1, { acknowledged: seen });
  const open = an_alarm(2, { level: "warning" });
  assert.equal(worst_of([known, open, over])?.number, 2);
  assert.equal(worst_of([known, over])?.number, 1);
  assert.equal(worst_of([over])?.number, 5);
  assert.equal(worst_of([]), null);
});

test("what was taken up stays in the bar, whatever becomes of it, until it is acknowledged", () => {
  const held = an_alarm(2, { level: "warning" });
  assert.equal(in_hand([an_alarm(3, { level: "warning" }), held], 2)?.number, 2);
  assert.equal(in_hand([an_alarm(3, { level: "warning" }), { ...held, over_s: 65 }], 2)?.number, 2);
  assert.equal(in_hand([an_alarm(3, { level: "warning" }), { ...held, acknowledged: seen }], 2)?.number, 3);
  assert.equal(in_hand([an_alarm(1), held], 2)?.number, 1, "only what is worse takes its place");
  assert.equal(in_hand([an_alarm(1)], 2)?.number, 1);
  assert.equal(in_hand([], 2), null);
});

test("counts, and the title of a window that is behind others", () => {
  const counts = counts_of([an_alarm(1), an_alarm(2, { level: "warning", acknowledged: seen }), an_alarm(3, { over_s: 65 })]);
  assert.deepEqual(counts, { alarm: 1, warning: 1, notice: 0, open: 2 });
  assert.equal(counts_text(counts), "1 alarm · 1 warning");
  assert.equal(title_of(counts), "!! 1 alarm · 1 warning – Skein");
  assert.equal(title_of(counts_of([an_alarm(2, { level: "warning" })])), "! 1 warning – Skein");
  assert.equal(title_of(counts_of([])), "Skein");
  assert.equal(counts_text(counts_of([])), "No alarms");
});

test("a page without connection alarms about that by itself", () => {
  assert.equal(connection_alarm(0, 80, false), null);
  const alarm = connection_alarm(4, 80, false)!;
  assert.equal(alarm.level, "alarm");
  assert.equal(alarm.since_s, 76);
  assert.equal(sound_of([alarm]), "alarm");
  assert.equal(sound_of([connection_alarm(4, 80, true)!]), null);
});

test("what is back is fresh: it has another number", () => {
  assert.deepEqual(fresh_of([an_alarm(1)], [an_alarm(1)]), []);
  assert.equal(fresh_of([an_alarm(1)], [an_alarm(9)]).length, 1);
  assert.deepEqual(fresh_of([], [an_alarm(1, { over_s: 65 })]), []);
});

test("how long it is so, and was", () => {
  assert.equal(lasted(an_alarm(1), 72), "12 s");
  assert.equal(lasted(an_alarm(1, { over_s: 65 }), 72), "5.0 s");
});

const given = (other: Partial<GivenOrder> = {}): GivenOrder => ({ kind: "hold", line: "hold all", vehicles: [], site: null, given_s: 50, answered: [], waiting: [1, 2], ...other });

test("an order's answers are found by what it was and when", () => {
  const orders = [given({ given_s: 20 }), given({ given_s: 50 }), given({ given_s: 51, vehicles: [3, 5] })];
  assert.equal(given_of(command("hold", 0), orders, 49)?.given_s, 50);
  assert.equal(given_of({ kind: "commands", command: "hold", vehicles: [5, 3] }, orders, 49)?.given_s, 51);
  assert.equal(given_of(command("hold", 3), orders, 49), null, "it was to two");
  assert.equal(given_of(command("hold", 0), orders, 60), null, "that was before");
  assert.equal(given_of(command("resume", 0), orders, 10), null);
  const decision = given({ kind: "authorise", vehicles: null, site: 4 });
  assert.equal(given_of({ kind: "decision", site: 4, grant: true, coalition: "1-1-1", round: 1 }, [decision], 10), decision);
  assert.equal(given_of({ kind: "decision", site: 4, grant: false, coalition: "1-1-1", round: 1 }, [decision], 10), null);
});

test("who obeys, and the slowest of them", () => {
  assert.equal(answers_text(given()), "0 of 2 obey; not yet 1, 2");
  assert.equal(answers_text(given({ answered: [{ vehicle: 1, after_s: 0.42 }], waiting: [2] })), "1 of 2 obey; the last (1) after 0.4 s; not yet 2");
  assert.equal(answers_text(given({ answered: [{ vehicle: 1, after_s: 0.42 }], waiting: [] })), "1 of 1 obey; after 0.4 s");
  assert.equal(answers_text(given({ waiting: [] })), "nobody in the air is asked");
});

test("what comes near is counted down to its moment, and past it", () => {
  const alarm = an_alarm(1, { closest_s: 100 });
  assert.equal(closest_text(alarm, 22), "closest in 78 s");
  assert.equal(closest_text(alarm, 99.2), "closest in 1 s");
  assert.equal(closest_text(alarm, 112), "was closest 12 s ago");
  assert.equal(closest_text({ ...alarm, over_s: 110 }, 112), "");
  assert.equal(closest_text(an_alarm(1), 112), "");
});
