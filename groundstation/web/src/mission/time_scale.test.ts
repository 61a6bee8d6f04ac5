// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { label_step, next_span, time_at, window_of, x_of, zoomed } from "./time_scale";

test("the window follows now, unless it is pinned", () => {
  assert.deepEqual(window_of(1000, 100, null), { from_s: 920, to_s: 1020 });
  assert.deepEqual(window_of(1000, 100, 5), { from_s: 5, to_s: 105 });
  assert.deepEqual(window_of(30, 100, null, -2), { from_s: -2, to_s: 98 });
  assert.deepEqual(window_of(1000, 100, null, -2), { from_s: 920, to_s: 1020 });
});

test("zooming keeps the time under the pointer where it is", () => {
  const window = { from_s: 100, to_s: 400 };
  for (const step of [1, -1] as const) {
    const { span_s, pinned_s } = zoomed(window, step, 250);
    const then = window_of(0, span_s, pinned_s);
    assert.ok(Math.abs(x_of(then, 600, 250) - x_of(window, 600, 250)) < 1e-9);
    assert.notEqual(span_s, 300);
  }
});

test("spans end at the shortest and the longest", () => {
  assert.equal(next_span(30, -1), 30);
  assert.equal(next_span(7200, 1), 7200);
  assert.equal(next_span(300, 1), 600);
});

test("times and places belong together; labels are round and apart", () => {
  const window = { from_s: 0, to_s: 300 };
  assert.ok(Math.abs(time_at(window, 600, x_of(window, 600, 123)) - 123) < 1e-9);
  assert.equal(label_step(window, 600, 70), 60);
  assert.equal(label_step(window, 60, 700), 3600);
});
