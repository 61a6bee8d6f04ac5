// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { words_of_order } from "../orders/orders";
import type { Outline } from "./outline";
import { hazards_by_number, no_search_fields, search_order } from "./search";

const square: Outline = [[0, 0], [100, 0], [100, 100], [0, 100]];

test("a search is ordered of an outline, or of what is left", () => {
  const made = search_order(square, { vehicles: "1, 2", spacing: "150", in_s: "" }, false);
  assert.ok("order" in made);
  assert.deepEqual(made.order, { kind: "search", preview: false, corners: square, vehicles: [1, 2], spacing_m: 150 });
  assert.equal(words_of_order(made.order), "search 0,0 100,0 100,100 0,100 by 1,2 spacing 150");
  const rest = search_order([], no_search_fields, true);
  assert.ok("order" in rest);
  assert.equal(words_of_order(rest.order), "search rest");
});

test("says what is wrong with its fields", () => {
  assert.ok("trouble" in search_order(square.slice(0, 2), no_search_fields, false));
  for (const fields of [{ ...no_search_fields, vehicles: "1,x" }, { ...no_search_fields, spacing: "0" }, { ...no_search_fields, in_s: "2" }]) {
    assert.ok("trouble" in search_order(square, fields, false), JSON.stringify(fields));
  }
});

test("the circles of a polygon are one hazard", () => {
  const circle = (id: number) => ({ id, x: 0, y: 0, radius_m: 5 });
  const group = { hazard: 10, corners: square.map(([x, y]) => [x, y] as [number, number]), x: 0, y: 0, radius_m: 0, more: 0.2, circles: [10, 11] };
  const by_number = hazards_by_number([circle(3), circle(10), circle(11)], [group]);
  assert.deepEqual(by_number.alone.map((one) => one.id), [3]);
  assert.equal(by_number.groups.length, 1);
});
