// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { health_of } from "../fleet/attention";
import { count_alarms } from "../shell/alarms";
import { aged } from "./aged";
import { empty_picture, reduce } from "./picture";
import { a_hello, a_vehicle } from "./samples";

const picture = () =>
  reduce(reduce(empty_picture(), a_hello()), { type: "state", time_s: 10, vehicles: [a_vehicle(1, { heard_age_s: 0.1, links: [{ id: 2, age_s: 0.2 }] }), a_vehicle(2)] });

test("a picture that is fed is as it was told", () => {
  const now = picture();
  assert.equal(aged(now, 0), now);
  assert.equal(count_alarms(now).heard, 2);
});

test("without news ages grow, and nobody counts as heard or well", () => {
  const old = aged(picture(), 12);
  assert.deepEqual(old.vehicles.map((vehicle) => vehicle.heard_age_s), [12.1, 12.1]);
  assert.equal(old.vehicles[0]!.links[0]!.age_s, 12.2);
  assert.equal(count_alarms(old).heard, 0);
  assert.deepEqual(old.vehicles.map(health_of), ["stale", "stale"]);
});

test("who was never heard stays so", () => {
  const old = aged(reduce(picture(), { type: "state", time_s: 11, vehicles: [a_vehicle(1, { heard_age_s: null })] }), 5);
  assert.equal(old.vehicles[0]!.heard_age_s, null);
});

test("the end of a ground station is told, and over with the next hello", () => {
  const ended = reduce(picture(), { type: "ended", time_s: 45, text: "1 of 1 sites done" });
  assert.deepEqual(ended.ended, { time_s: 45, text: "1 of 1 sites done" });
  assert.equal(reduce(ended, a_hello()).ended, null);
});
