// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import type { Authorisation } from "../wire/protocol";
import { before_gate, count_text, granted_requests, has_alarm, outcome_of, request_key, silence_text, waiting_requests } from "./requests";

function request(site: number, other: Partial<Authorisation> = {}): Authorisation {
  return {
    site, leader: 1, coalition: "1/1", round: 1, x: 0, y: 0, latitude_deg: 0, longitude_deg: 0,
    asked_s: 0, decide_by_s: 10, waiting: true, decision: null, can_take_back: false, deliveries: [], silent: [], leader_marks: [],
    missing: [], did_not_bid: [], changes: [], ...other,
  };
}

test("what runs out first stands first; what is decided does not wait", () => {
  const all = [
    request(1, { decide_by_s: 20 }),
    request(2, { decide_by_s: 15 }),
    request(3, { waiting: false, decision: { granted: true, taken_back: false, by: "anna", at_s: 3 } }),
  ];
  assert.deepEqual(waiting_requests(all).map((one) => one.site), [2, 1]);
});

test("another plan for the same site is another request", () => {
  assert.notEqual(request_key(request(1)), request_key(request(1, { round: 2 })));
});

const delivery = { vehicle: 2, index: 0, time_s: 50, bearing_deg: 0, before_gate: false, marks: [] };

test("what is missing is counted, and an alarm", () => {
  const missing = [{ index: 1, bearing_deg: 120, why: "1 that can deliver has bid" }];
  assert.equal(count_text(request(1, { deliveries: [delivery] })), "1 delivery");
  assert.equal(count_text(request(1, { deliveries: [delivery], missing })), "1 of 2 deliveries");
  assert.equal(has_alarm(request(1, { deliveries: [delivery] })), false);
  assert.equal(has_alarm(request(1, { deliveries: [delivery], missing })), true);
});

test("a silent vehicle is an alarm, a short range is not", () => {
  const marked = (level: "alarm" | "warning") => request(1, { deliveries: [{ ...delivery, marks: [{ level, text: "" }] }] });
  assert.equal(has_alarm(marked("alarm")), true);
  assert.equal(has_alarm(marked("warning")), false);
});

test("outcomes say who decided", () => {
  assert.equal(outcome_of(request(1, { waiting: false, decision: { granted: false, taken_back: false, by: "anna", at_s: 3 } })), "refused by anna");
  assert.equal(outcome_of(request(1, { waiting: false, decision: { granted: false, taken_back: true, by: "bob", at_s: 3 } })), "taken back by bob");
  assert.match(outcome_of(request(1, { waiting: false })), /not decided/);
});

test("what can be taken back stands by the time of its first delivery that has not begun", () => {
  const granted = (site: number, times: [number, boolean][]) =>
    request(site, { can_take_back: times.some(([, open]) => open), deliveries: times.map(([time_s, open], index) => ({ ...delivery, index, time_s, before_gate: open })) });
  const all = [granted(1, [[40, false], [60, true]]), granted(2, [[50, true]]), granted(3, [[45, false]]), request(4)];
  assert.deepEqual(granted_requests(all).map(({ site }) => site), [2, 1]);
  assert.deepEqual(all.slice(0, 1).flatMap(before_gate).map(({ time_s }) => time_s), [60]);
});

test("who is silent is named", () => {
  assert.equal(silence_text(request(1)), "");
  assert.equal(silence_text(request(1, { silent: [3] })), "vehicle 3 is silent");
  assert.equal(silence_text(request(1, { silent: [3, 5] })), "vehicles 3, 5 are silent");
});
