// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { a_hello } from "../wire/samples";
import { acknowledgements, command, formation_order, hazard_order, no_fields, words_of_order } from "./orders";

const wedge = { ...no_fields, shape: "wedge" };

const { limits } = a_hello();

test("a form order says what is filled in, and leaves the rest to the ground station", () => {
  const form = { kind: "formation", order: "form", preview: false, shape: "wedge" };
  assert.deepEqual(formation_order(wedge, limits), { order: form });
  const made = formation_order(
    { ...wedge, spacing: "5", heading: "-90", east: "0", north: "40.5", height: "20", places: "3" },
    limits,
  );
  assert.deepEqual(made, { order: { ...form, spacing_m: 5, heading_deg: -90, x: 0, y: 40.5, z: 20, places: 3 } });
  assert.deepEqual(formation_order({ ...wedge, kind: "land", spacing: "x" }, limits), {
    order: { kind: "formation", order: "land", preview: false },
  });
});

test("what cannot be is said before it is sent", () => {
  for (const wrong of [{ shape: "" }, { spacing: "0.1" }, { spacing: "five" }, { east: "3" }, { places: "0" }]) {
    assert.ok("trouble" in formation_order({ ...wedge, ...wrong }, limits), JSON.stringify(wrong));
  }
});

test("a hazard in whole metres", () => {
  assert.deepEqual(hazard_order({ x: -0.2, y: 12.6, radius_m: 99.5 }), { kind: "hazard", x: 0, y: 13, radius_m: 100 });
});

test("an order in words", () => {
  assert.equal(words_of_order(command("return_home", 7)), "return home 7");
  assert.equal(words_of_order(command("hold", 0)), "hold all");
  const made = formation_order({ ...wedge, spacing: "5", places: "3" }, limits);
  assert.equal("order" in made && words_of_order(made.order), "form wedge spacing 5 places 3");
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
