// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { a_preflight_vehicle } from "../wire/samples";
import { kinds_of, tile_of } from "./digests";

const fleet = [
  a_preflight_vehicle(1),
  a_preflight_vehicle(2, { counts: false }),
  a_preflight_vehicle(3, { release: "0.0.9", odd: ["release"] }),
  a_preflight_vehicle(4, { release: null, configuration: null, told_s: null, counts: false }),
];

test("those that are alike stand together, the odd ones and the unknown by themselves", () => {
  const { kinds, unknown } = kinds_of(fleet, "release");
  assert.deepEqual(kinds.map(({ value, ids, odd }) => [value, ids, odd]), [["0.1.0", [1, 2], false], ["0.0.9", [3], true]]);
  assert.deepEqual(kinds[0]!.old, [2]);
  assert.deepEqual(unknown, [4]);
});

test("what is usual of one airframe and odd of another is told apart", () => {
  const mixed = [
    a_preflight_vehicle(1, { firmware: "4.5" }),
    a_preflight_vehicle(2, { firmware: "4.5", odd: ["firmware"] }),
    a_preflight_vehicle(3, { firmware: "4.6" }),
    a_preflight_vehicle(5, { firmware: "4.6" }),
  ];
  assert.deepEqual(kinds_of(mixed, "firmware").kinds.map(({ value, ids, odd }) => [value, ids, odd]), [["4.6", [3, 5], false], ["4.5", [1], false], ["4.5", [2], true]]);
});

test("a tile says in what its vehicle is odd, and what it has not told", () => {
  assert.deepEqual(tile_of(fleet[2]!), { odd: ["release"], unknown: [] });
  assert.deepEqual(tile_of(fleet[3]!), { odd: [], unknown: ["release", "configuration"] });
  // A simulated flight controller has neither firmware nor parameters.
  assert.deepEqual(tile_of(fleet[0]!), { odd: [], unknown: [] });
});
