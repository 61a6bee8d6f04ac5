// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { a_hello } from "../wire/samples";
import { acknowledgements, command, command_to, formation_order, hazard_order, no_fields, no_site, site_order, words_of_order } from "./orders";

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

test("one order to several names them", () => {
  assert.deepEqual(command_to("return_home", new Set([7, 3, 4])), { kind: "commands", command: "return_home", vehicles: [3, 4, 7] });
  assert.equal(words_of_order(command_to("return_home", [7, 3, 4, 5])), "return home 3–5, 7");
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

test("a site says what is filled in, and needs a place unless it changes one", () => {
  const fields = { ...no_site, east: "100", north: "-20", like: "fire", bearings: "90, 180", interval: "4", assessments: "2", reward: "3" };
  const made = site_order(fields, limits, null);
  assert.equal("order" in made && words_of_order(made.order), "site like fire at 100 -20 deliver 090,180 every 4 assess 2 reward 3");
  assert.deepEqual(made, {
    order: { kind: "site", preview: false, x: 100, y: -20, like: "fire", bearings_deg: [90, 180], interval_s: 4, assessments: 2, reward: 3 },
  });
  assert.deepEqual(site_order({ ...no_site, reward: "5" }, limits, 10034), { order: { kind: "site", preview: false, site: 10034, reward: 5 } });
  for (const wrong of [{ east: "" }, { bearings: "90;x" }, { bearings: "900" }, { assessments: "99" }, { interval: "-1" }]) {
    assert.ok("trouble" in site_order({ ...fields, ...wrong }, limits, null), JSON.stringify(wrong));
  }
  assert.ok("trouble" in site_order({ ...no_site, east: "1" }, limits, 10034));
  assert.equal(words_of_order({ kind: "withdraw", hazard: 3 }), "withdraw hazard 3");
  assert.equal(words_of_order({ kind: "withdraw", site: 3 }), "withdraw site 3");
  assert.equal(words_of_order({ kind: "withdraw", decision: 3 }), "withdraw decision 3");
  const decision = { kind: "decision", site: 3, grant: true, coalition: "1-1-1", round: 1 } as const;
  assert.equal(words_of_order(decision), "authorise 3");
  assert.equal(words_of_order({ ...decision, override: true }), "authorise 3 override");
  assert.equal(words_of_order({ kind: "proposal", number: 2, accept: false }), "dismiss 2");
});
