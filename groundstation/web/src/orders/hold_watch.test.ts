// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { a_vehicle } from "../wire/samples";
import { hold_progress, told_to_hold } from "./hold_watch";
import { command, command_to } from "./orders";

const holding = { activity: "holding" as const };

test("who is told to hold", () => {
  const vehicles = [a_vehicle(1), a_vehicle(2), a_vehicle(3, { heard_age_s: null })];
  assert.deepEqual(told_to_hold(command("hold", 0), vehicles), [1, 2]);
  assert.deepEqual(told_to_hold(command("hold", 7), vehicles), [7]);
  assert.equal(told_to_hold(command("resume", 0), vehicles), null);
  assert.deepEqual(told_to_hold(command_to("hold", new Set([9, 2])), vehicles), [2, 9]);
  assert.equal(told_to_hold(command_to("land", [2]), vehicles), null);
});

test("who does, who does not yet, and who cannot be heard", () => {
  const vehicles = [a_vehicle(1, holding), a_vehicle(2), a_vehicle(3, { ...holding, silent: true })];
  assert.deepEqual(hold_progress([1], vehicles), { all: true, text: "1 of 1 hold" });
  assert.deepEqual(hold_progress([1, 2, 3], vehicles), { all: false, text: "1 of 3 hold; not yet 2, 3; not heard: 3" });
  assert.equal(hold_progress([9], vehicles).all, false);
  const stopping = (groundspeed: number) => hold_progress([1], [a_vehicle(1, { activity: "forming", groundspeed })]);
  assert.equal(stopping(2).all, false);
  assert.equal(stopping(0.1).all, true);
});
