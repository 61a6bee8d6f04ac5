// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { an_event } from "../wire/samples";
import { all_events, filtered, rows_in_sight } from "./event_filter";

const events = [
  an_event(0),
  an_event(1, { vehicle: 2, kind: "fleet_warning", level: "warning", text: "Heard nothing from 3" }),
  an_event(2, { vehicle: 2, kind: "task_done" }),
];
const seqs = (filter: Partial<typeof all_events>, until_s: number | null = null) =>
  filtered(events, { ...all_events, ...filter }, until_s).map((event) => event.seq);

test("filters by vehicle, kind, level and text, and all together", () => {
  assert.deepEqual(seqs({}), [0, 1, 2]);
  assert.deepEqual(seqs({ vehicle: 2 }), [1, 2]);
  assert.deepEqual(seqs({ kind: "task_done" }), [2]);
  assert.deepEqual(seqs({ warnings_only: true }), [1]);
  assert.deepEqual(seqs({ text: " heard NOTHING" }), [1]);
  assert.deepEqual(seqs({ vehicle: 2, kind: "task_done", text: "nothing" }), []);
});

test("a recording shows no event before it has happened", () => {
  assert.deepEqual(seqs({}, 1), [0, 1]);
});

test("of a thousand rows only those in sight are made", () => {
  assert.deepEqual(rows_in_sight(1000, 20, 4000, 300), [190, 225]);
  assert.deepEqual(rows_in_sight(5, 20, 0, 300), [0, 5]);
  assert.deepEqual(rows_in_sight(5, 20, 9000, 300), [5, 5]);
});
