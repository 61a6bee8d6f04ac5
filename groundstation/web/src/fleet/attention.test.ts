// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { a_vehicle } from "../wire/samples";
import { by_attention, fleet_notes, health_of, odd_versions, problems_of } from "./attention";

const never = { heard_age_s: null, x: null, y: null };

test("worst first, by id among equals", () => {
  const vehicles = [
    a_vehicle(1),
    a_vehicle(2, { problems: [{ level: "warning", text: "range is short" }] }),
    a_vehicle(3, { silent: true, heard_age_s: 9 }),
    a_vehicle(4, never),
    a_vehicle(5, { duplicate: true }),
    a_vehicle(6, { problems: [{ level: "alarm", text: "flight controller silent" }] }),
    a_vehicle(7, { silent: true, heard_age_s: 4 }),
  ];
  assert.deepEqual(by_attention(vehicles).map((vehicle) => vehicle.id), [5, 6, 3, 7, 2, 4, 1]);
  assert.deepEqual(by_attention(vehicles.reverse()).map((vehicle) => vehicle.id), [5, 6, 3, 7, 2, 4, 1]);
});

test("ages and ranges do not move rows", () => {
  const order = (age: number) =>
    by_attention([a_vehicle(2, { heard_age_s: age }), a_vehicle(1, { range_left_m: age })]).map((v) => v.id);
  assert.deepEqual(order(0), order(2));
});

test("there is a reason wherever it is not well", () => {
  for (const vehicle of [a_vehicle(1, never), a_vehicle(1, { silent: true }), a_vehicle(1, { duplicate: true }), a_vehicle(1, { expected: false })]) {
    assert.notEqual(health_of(vehicle), "well");
    assert.ok(problems_of(vehicle)[0]!.text.length > 0);
  }
  assert.equal(health_of(a_vehicle(1)), "well");
});

test("duplicate ids, strangers and versions are named", () => {
  const notes = fleet_notes([
    a_vehicle(1),
    a_vehicle(2, { duplicate: true }),
    a_vehicle(3, { version: "0.0.9" }),
    a_vehicle(4),
    a_vehicle(9, { expected: false }),
  ]);
  assert.equal(notes.length, 3);
  assert.match(notes[0]!, /id 2/);
  assert.match(notes[1]!, /9/);
  assert.match(notes[2]!, /0\.0\.9 on 3; 0\.1\.0 on 1, 2, 4, 9/);
  assert.deepEqual(fleet_notes([a_vehicle(1), a_vehicle(2)]), []);
});

test("the version of the fewer is the odd one", () => {
  const odd = odd_versions([a_vehicle(1), a_vehicle(2), a_vehicle(3, { version: "0.0.9" })]);
  assert.deepEqual([...odd], ["0.0.9"]);
  assert.equal(odd_versions([a_vehicle(1)]).size, 0);
});
