// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { describe, it } from "node:test";
import { a_traffic_aircraft } from "../wire/samples";
import { above_text, closest_text, climb_sign, is_old, name_of, standing_of, warned_text } from "./traffic";

describe("an aircraft that is not of the team", () => {
  it("has its callsign for a name, or else its address", () => {
    assert.equal(name_of(a_traffic_aircraft({ callsign: "RYR12" })), "RYR12");
    assert.equal(name_of(a_traffic_aircraft({ callsign: "" })), "4ca2d6");
  });

  it("is in the way of whoever does not give way, before it is of those who do", () => {
    const warned = [{ vehicle: 3, gives_way: true }];
    assert.equal(standing_of(a_traffic_aircraft()), "far");
    assert.equal(standing_of(a_traffic_aircraft({ warned })), "given_way");
    assert.equal(standing_of(a_traffic_aircraft({ warned: [...warned, { vehicle: 4, gives_way: false }] })), "too_near");
  });

  it("is near where it will pass near, and not on the ground", () => {
    const nearest = { vehicle: 1, distance_m: 4000, above_m: 200, closest_m: 300, closest_in_s: 60 };
    assert.equal(standing_of(a_traffic_aircraft({ nearest })), "near");
    assert.equal(standing_of(a_traffic_aircraft({ nearest, on_ground: true })), "far");
    assert.equal(standing_of(a_traffic_aircraft({ nearest: { ...nearest, above_m: 900 } })), "far");
  });

  it("tells its height over the nearest vehicle", () => {
    const nearest = { vehicle: 1, distance_m: 4000, above_m: 120.4, closest_m: 300, closest_in_s: 60 };
    assert.equal(above_text(a_traffic_aircraft({ nearest })), "+120 m");
    assert.equal(above_text(a_traffic_aircraft({ nearest: { ...nearest, above_m: -30 } })), "−30 m");
    assert.equal(above_text(a_traffic_aircraft({ nearest: null, z: 500 })), "500 m");
    assert.equal(above_text(a_traffic_aircraft({ on_ground: true })), "on the ground");
    assert.deepEqual([climb_sign(a_traffic_aircraft({ climb_mps: 3 })), climb_sign(a_traffic_aircraft({ climb_mps: -3 })), climb_sign(a_traffic_aircraft({ climb_mps: 0.2 }))], ["↑", "↓", ""]);
  });

  it("tells how near it will come, while it does", () => {
    const nearest = { vehicle: 1, distance_m: 4000, above_m: 120, closest_m: 300, closest_in_s: 60 };
    assert.equal(closest_text(a_traffic_aircraft({ nearest })), "300 m in 60 s");
    assert.equal(closest_text(a_traffic_aircraft({ nearest: { ...nearest, closest_in_s: 0 } })), "moving away");
    assert.equal(closest_text(a_traffic_aircraft({ nearest: null })), "–");
  });

  it("names those who are warned", () => {
    assert.equal(warned_text(a_traffic_aircraft()), "");
    assert.equal(warned_text(a_traffic_aircraft({ warned: [{ vehicle: 3, gives_way: true }, { vehicle: 5, gives_way: true }, { vehicle: 4, gives_way: false }] })), "vehicle 4 does not give way; vehicles 3, 5 give way");
  });

  it("is old when nothing was heard of it for a while", () => {
    assert.equal(is_old(a_traffic_aircraft({ age_s: 2 })), false);
    assert.equal(is_old(a_traffic_aircraft({ age_s: 12 })), true);
  });
});
