// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { tabs_that_fit } from "./tab_room";

const all = ["a", "b", "c", "d", "e"];
const widths = [50, 50, 50, 50, 100];

test("all where there is room, and no place is lost to a button then", () => {
  assert.deepEqual(tabs_that_fit(all, widths, 300, 60, 0), all);
});

test("the first ones, and the button's room is kept", () => {
  assert.deepEqual(tabs_that_fit(all, widths, 299, 60, 1), ["a", "b", "c", "d"]);
  assert.deepEqual(tabs_that_fit(all, widths, 220, 60, 1), ["a", "b", "c"]);
});

test("the chosen one is always in sight", () => {
  assert.deepEqual(tabs_that_fit(all, widths, 220, 60, 3), ["a", "b", "d"]);
  assert.deepEqual(tabs_that_fit(all, widths, 220, 60, 4), ["a", "e"]);
  assert.deepEqual(tabs_that_fit(all, widths, 90, 60, 4), ["e"]);
  assert.deepEqual(tabs_that_fit(all, widths, 90, 60, 0), ["a"]);
});
