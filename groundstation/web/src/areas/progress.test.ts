// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { a_search, a_share } from "../wire/samples";
import { done_text, ends_search_text, expected_text, left_text, searched_text } from "./progress";

test("how much is searched, in hectares, and never all before it is", () => {
  assert.equal(searched_text(a_search({ area_m2: 650_000, seen: 0.4801 })), "31.2 of 65.0 ha searched (48 %)");
  assert.equal(searched_text(a_search({ area_m2: 650_000, seen: 0.9999 })), "65.0 of 65.0 ha searched (99 %)");
});

test("when it will be done, in mission time and UTC, and how much later than planned", () => {
  assert.equal(expected_text(a_search({ expected_s: 310, ends_s: 310 }), 180, 0), "expected to be done in 2 min 10 s, at 05:10 (00:05:10 UTC)");
  assert.equal(expected_text(a_search({ expected_s: 340, ends_s: 310 }), 330, null), "expected to be done in 10 s, at 05:40, 30 s later than planned");
  assert.equal(expected_text(a_search({ expected_s: 310, ends_s: 310 }), 320, null), "expected to be done in 0.0 s, at 05:10");
  assert.equal(expected_text(a_search({ expected_s: null }), 180, 0), "");
});

test("who has what left", () => {
  assert.equal(left_text(a_share(1, { lanes: 5, lanes_left: 2, left_m: 1240 })), "2 of 5, 1.2 km");
  assert.equal(left_text(a_share(1, { lanes: 5, lanes_left: 0, left_m: 0 })), "nothing");
  assert.equal(done_text(a_share(1, { done_s: 250 }), 180), "in 70 s, at 04:10");
  assert.equal(done_text(a_share(1, { state: "done", done_s: null }), 180), "done");
  assert.equal(done_text(a_share(1, { state: "left", done_s: null }), 180), "–");
});

test("whose search an order would end", () => {
  const search = a_search({ area_m2: 650_000, seen: 0.5, shares: [a_share(1), a_share(2, { state: "waits" }), a_share(3, { state: "left" })] });
  assert.equal(ends_search_text(search, [1, 2, 3, 9]), "Hold, return and land end the search of vehicles 1, 2: 32.5 of 65.0 ha searched (50 %)");
  assert.equal(ends_search_text(search, [3, 9]), "");
  assert.equal(ends_search_text({ ...search, state: "over" }, [1]), "");
  assert.equal(ends_search_text(null, [1]), "");
});
