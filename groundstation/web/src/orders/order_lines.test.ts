// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { acknowledgements, formation_line, hazard_line, no_fields } from "./order_lines";

const wedge = { ...no_fields, shape: "wedge" };

test("a form order says what is filled in, and leaves the rest to the ground station", () => {
  assert.deepEqual(formation_line(wedge), { line: "form wedge" });
  assert.deepEqual(
    formation_line({ ...wedge, spacing: "5", heading: "-90", east: "0", north: "40.5", height: "20", places: "3" }),
    { line: "form wedge spacing 5 heading -90 at 0 40.5 20 places 3" },
  );
  assert.deepEqual(formation_line({ ...wedge, kind: "land", spacing: "x" }), { line: "land" });
});

test("what cannot be is said before it is sent", () => {
  for (const wrong of [{ shape: "" }, { spacing: "0.1" }, { spacing: "five" }, { east: "3" }, { places: "0" }]) {
    assert.ok("trouble" in formation_line({ ...wedge, ...wrong }), JSON.stringify(wrong));
  }
});

test("a hazard in whole metres", () => {
  assert.equal(hazard_line({ x: -0.2, y: 12.6, radius_m: 99.5 }), "hazard 0 13 100");
});

test("who has taken the change, who not, who is lost", () => {
  const place = (id: number, change: number, lost = false) => ({
    id, x: 0, y: 0, z: 0, reference: null, off_m: 0, change, at_rest: true, lost,
  });
  const change = { number: 4, start_s: 0, end_s: 1, movers: [] };
  const formation = { in_place: false, moving: true, change, places: [place(1, 4), place(2, 3), place(3, 3, true)] };
  assert.deepEqual(acknowledgements(formation), { yes: [1], no: [2], lost: [3] });
  assert.equal(acknowledgements({ ...formation, change: null }), null);
});
