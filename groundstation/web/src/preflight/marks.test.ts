// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { a_preflight_vehicle } from "../wire/samples";
import type { CheckMark, Readiness } from "../wire/protocol";
import { shown_mark, shown_vehicle, told_age_s } from "./marks";

const marks: CheckMark[] = ["ok", "warn", "fail", "not_looked_at", "not_known"];
const readinesses: Readiness[] = ["ready", "not_ready", "in_flight", "not_known"];

test("only what is heard is green", () => {
  assert.deepEqual(marks.filter((mark) => shown_mark(mark, true).tone === "ok"), ["ok"]);
  for (const mark of marks) assert.ok(["old", "none"].includes(shown_mark(mark, false).tone), mark);
  for (const readiness of readinesses) {
    const vehicle = a_preflight_vehicle(1, { readiness });
    assert.equal(shown_vehicle(vehicle, true).tone === "ok", readiness === "ready");
    assert.equal(shown_vehicle(vehicle, false).tone, "old");
  }
});

test("what is old differs from what is heard without its colour, too", () => {
  const signs = marks.flatMap((mark) => [shown_mark(mark, true).sign, shown_mark(mark, false).sign]);
  assert.equal(new Set(signs).size, 8); // those that nothing was told of look the same
});

test("a silent vehicle is not shown as one that fails now", () => {
  const silent = a_preflight_vehicle(7, { readiness: "not_ready", why: "silent", counts: false });
  assert.deepEqual(shown_vehicle(silent, true), { sign: "!", tone: "old", label: "not ready: silent" });
  assert.equal(shown_vehicle({ ...silent, counts: true }, true).tone, "fail");
});

test("an age grows with the mission's clock, and beyond it where no state comes", () => {
  const vehicle = a_preflight_vehicle(1, { told_s: 100 });
  assert.equal(told_age_s(vehicle, 130, 0), 30);
  assert.equal(told_age_s(vehicle, 130, 12), 42);
  assert.equal(told_age_s(vehicle, 99.9, 0), 0);
  assert.equal(told_age_s(vehicle, null, 0), null);
  assert.equal(told_age_s(a_preflight_vehicle(1, { told_s: null }), 130, 0), null);
});
