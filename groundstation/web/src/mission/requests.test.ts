// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import type { Authorisation } from "../wire/protocol";
import { outcome_of, request_key, waiting_requests } from "./requests";

function request(site: number, other: Partial<Authorisation> = {}): Authorisation {
  return {
    site, leader: 1, coalition: "1/1", round: 1, x: 0, y: 0, latitude_deg: 0, longitude_deg: 0,
    asked_s: 0, decide_by_s: 10, waiting: true, decision: null, deliveries: [], ...other,
  };
}

test("what runs out first stands first; what is decided does not wait", () => {
  const all = [
    request(1, { decide_by_s: 20 }),
    request(2, { decide_by_s: 15 }),
    request(3, { waiting: false, decision: { granted: true, by: "anna", at_s: 3 } }),
  ];
  assert.deepEqual(waiting_requests(all).map((one) => one.site), [2, 1]);
});

test("another plan for the same site is another request", () => {
  assert.notEqual(request_key(request(1)), request_key(request(1, { round: 2 })));
});

test("outcomes say who decided", () => {
  assert.equal(outcome_of(request(1, { waiting: false, decision: { granted: false, by: "anna", at_s: 3 } })), "refused by anna");
  assert.match(outcome_of(request(1, { waiting: false })), /not decided/);
});
