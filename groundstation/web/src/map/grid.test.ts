// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { metres_text, round_step } from "./grid";

test("grid lines stand at round metres", () => {
  for (const [least, step] of [[0.03, 0.05], [1, 1], [1.01, 2], [4, 5], [6, 10], [900, 1000], [1000, 1000]] as const) {
    assert.ok(Math.abs(round_step(least) - step) < 1e-9, `${least}: ${round_step(least)}`);
  }
});

test("labels say metres, or kilometres where they are shorter", () => {
  assert.equal(metres_text(-500, 100), "−500 m");
  assert.equal(metres_text(1500, 500), "1.5 km");
  assert.equal(metres_text(1500, 10), "1500 m");
  assert.equal(metres_text(0.5, 0.5), "0.5 m");
});
