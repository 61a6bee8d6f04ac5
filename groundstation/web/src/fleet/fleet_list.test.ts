// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { a_vehicle } from "../wire/samples";
import type { Vehicle } from "../wire/protocol";
import { between, columns_for, counts_by_state, least_width, next_sorting, no_filter, numbers_in, passes, slice_of, sorted } from "./fleet_list";
import { state_text } from "./texts";
import type { Filter } from "./fleet_list";
import { all_groups, groups_of, read_groups, with_group, write_groups } from "./groups";

const ids = (list: readonly Vehicle[]) => list.map(({ id }) => id);
const fleet = [
  a_vehicle(1, { state: "searching" }),
  a_vehicle(2, { state: "holding_by_order", problems: [{ level: "warning", text: "range is short" }] }),
  a_vehicle(3, { state: "silent", silent: true, heard_age_s: 9 }),
  a_vehicle(4, { state: null, heard_age_s: null, x: null, y: null }),
  a_vehicle(5, { state: "searching", mode: "GUIDED", version: "0.0.9" }),
];
const groups = [{ name: "west", vehicles: [2, 5, 77], own: true }];
const found = (some: Partial<Filter>) => ids(fleet.filter(passes({ ...no_filter, ...some }, groups)));

test("states are counted in an order of their own", () => {
  assert.deepEqual(counts_by_state(fleet), [["silent", 1], ["not_heard_yet", 1], ["searching", 2], ["holding_by_order", 1]]);
  assert.deepEqual(counts_by_state([...fleet].reverse()), counts_by_state(fleet));
});

test("filters are combined", () => {
  assert.deepEqual(found({}), [1, 2, 3, 4, 5]);
  assert.deepEqual(found({ states: new Set(["searching", "silent"]) }), [1, 3, 5]);
  assert.deepEqual(found({ attention: true }), [2, 3, 4]);
  assert.deepEqual(found({ group: "west" }), [2, 5]);
  assert.deepEqual(found({ group: "west", attention: true }), [2]);
  assert.deepEqual(found({ group: "gone" }), []);
});

test("a text is numbers, or what stands in the row", () => {
  assert.deepEqual(found({ text: "1" }), [1]);
  assert.deepEqual(found({ text: "2-4" }), [2, 3, 4]);
  assert.deepEqual(found({ text: " 1, 5" }), [1, 5]);
  assert.deepEqual(found({ text: "guid" }), [5]);
  assert.deepEqual(found({ text: "Range is" }), [2]);
  assert.deepEqual(found({ text: "holding by" }), [2]);
  assert.deepEqual(found({ text: "WEST" }), [2, 5]);
  assert.deepEqual(found({ text: "0.0.9" }), [5]);
  assert.equal(numbers_in("1-99999999")!.size, 65535);
  assert.deepEqual([...numbers_in("3-")!], [3]);
});

test("sorted by a column, what is not known last either way", () => {
  const by = (column: Parameters<typeof sorted>[1]["column"], descending = false) => ids(sorted(fleet, { column, descending }, groups));
  assert.deepEqual(by(null), [3, 2, 4, 1, 5]);
  assert.deepEqual(by("id", true), [5, 4, 3, 2, 1]);
  assert.deepEqual(by("heard", true), [3, 1, 2, 5, 4]);
  assert.deepEqual(by("heard"), [1, 2, 5, 3, 4]);
  assert.deepEqual(by("mode"), [5, 1, 2, 3, 4]);
  assert.deepEqual(by("groups"), [2, 5, 1, 3, 4]);
});

test("rows do not jump for figures that tremble", () => {
  const order = (a: number, b: number) => ids(sorted([a_vehicle(1, { heard_age_s: a }), a_vehicle(2, { heard_age_s: b })], { column: "heard", descending: false }, []));
  assert.deepEqual(order(0.1, 0.9), order(0.9, 0.1));
});

test("a column is sorted upwards, downwards, and not", () => {
  const first = next_sorting({ column: null, descending: false }, "id");
  assert.deepEqual(first, { column: "id", descending: false });
  assert.deepEqual(next_sorting(first, "id"), { column: "id", descending: true });
  assert.deepEqual(next_sorting({ column: "id", descending: true }, "id"), { column: null, descending: false });
});

test("a range is as it is listed, either way", () => {
  assert.deepEqual(between([4, 2, 9, 7], 2, 7), [2, 9, 7]);
  assert.deepEqual(between([4, 2, 9, 7], 7, 2), [2, 9, 7]);
  assert.deepEqual(between([4, 2, 9, 7], 99, 7), [7]);
  assert.deepEqual(between([4, 2], null, 2), [2]);
});

test("columns go by need where there is little room, and fit", () => {
  assert.deepEqual(columns_for(250, false, false, 26), ["id", "state"]);
  assert.deepEqual(columns_for(10, false, true, 44), ["id", "state"]);
  for (const room of [300, 340, 500, 563, 700]) {
    const columns = columns_for(room, true, false, 26);
    assert.ok(least_width(columns, false) + 26 <= room, `${room}`);
  }
  assert.ok(columns_for(1000, true, false, 26).includes("groups"));
  assert.ok(!columns_for(1000, false, false, 26).includes("groups"));
});

test("of a thousand rows those in sight are made, and the rest has its height", () => {
  const heights = Array.from({ length: 1000 }, (_, i) => (i % 10 === 0 ? 47 : 27));
  const whole = heights.reduce((sum, one) => sum + one, 0);
  for (const top of [0, 5000, whole - 600, whole + 900]) {
    const { from, to, above_px, below_px } = slice_of(heights, top, 600, 200);
    assert.ok(to - from <= 60, `${to - from}`);
    const inside = heights.slice(from, to).reduce((sum, one) => sum + one, 0);
    assert.equal(above_px + inside + below_px, whole);
    if (top + 600 <= whole) assert.ok(above_px <= top && above_px + inside >= top + 600);
  }
});

test("groups are kept and read again, whatever else stands there", () => {
  const kept = with_group([], " east ", [3, 1, 3]);
  assert.deepEqual(kept, [{ name: "east", vehicles: [1, 3], own: true }]);
  assert.deepEqual(read_groups(write_groups(kept as never)), kept);
  for (const broken of [null, "", "{", "7", '[{"name":1}]', '[{"name":"a","vehicles":["x",0,-1]}]']) assert.deepEqual(read_groups(broken), []);
  assert.equal(typeof with_group([], "  ", [1]), "string");
  assert.equal(typeof with_group([], "a", []), "string");
  assert.deepEqual(with_group(kept as never, "east", [9]), [{ name: "east", vehicles: [9], own: true }]);
});

test("an own group stands in place of a configured one of its name", () => {
  const all = all_groups([{ name: "a", vehicles: [1] }, { name: "b", vehicles: [2] }], [{ name: "b", vehicles: [3], own: true }, { name: "c", vehicles: [1], own: true }]);
  assert.deepEqual(all.map(({ name, vehicles }) => [name, ...vehicles]), [["a", 1], ["b", 3], ["c", 1]]);
  assert.deepEqual(groups_of(all, 1), ["a", "c"]);
});

test("who keeps clear of traffic besides is found by either word", () => {
  const held = a_vehicle(7, { state: "holding_by_order", besides: "keeping_clear_of_traffic" });
  assert.equal(state_text(held), "holding by order, keeping clear of traffic");
  assert.equal(state_text(a_vehicle(8)), "searching");
  for (const text of ["holding", "keeping clear"]) {
    assert.ok(passes({ ...no_filter, text }, [])(held), text);
    assert.ok(!passes({ ...no_filter, text }, [])(a_vehicle(8)), text);
  }
});
