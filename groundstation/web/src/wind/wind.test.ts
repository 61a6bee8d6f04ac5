// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import test from "node:test";
import { who_tells, words_of_wind } from "./wind";

const figures = { from_deg: 7, speed_mps: 4.06, gust_mps: 6, age_s: 0.3 };

test("the wind is told from where it blows, and a calm from nowhere", () => {
  assert.equal(words_of_wind(figures), "from 007°, 4.1 m/s, gusts 6.0");
  assert.equal(words_of_wind({ ...figures, from_deg: null, speed_mps: 0.2, gust_mps: 0.4 }), "calm, 0.2 m/s, gusts 0.4");
});

test("how many tell, how alike and how old it is", () => {
  const one = { ...figures, id: 1 };
  assert.equal(who_tells({ ...figures, spread_mps: 0, vehicles: [one] }), "1 plane tells, 0.3 s old");
  assert.equal(who_tells({ ...figures, spread_mps: 0.42, age_s: 12, vehicles: [one, { ...one, id: 2 }] }), "2 planes tell, 0.4 m/s apart, 12 s old");
});
