// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { LocalFrame, distance_and_bearing, moved, on_path } from "./geodesy";

const origins = [
  { latitude_deg: 31.522062, longitude_deg: 105.044327, height_m: 480 },
  { latitude_deg: -67.2, longitude_deg: -179.95, height_m: 0 },
  { latitude_deg: 0, longitude_deg: 0, height_m: 2500 },
];

// CartConvert -l 31.522062 105.044327 480, for points of that height: latitude, longitude, east, north.
const reference: readonly (readonly [number, number, number, number])[] = [
  [31.7000, 105.044327, -0.000, 19731.229],
  [31.522062, 105.250000, 19536.250, 18.333],
  [31.4000, 104.900000, -13726.990, -13525.893],
  [31.6500, 105.180000, 12869.584, 14194.740],
];

test("20 km north and east are where GeographicLib's LocalCartesian has them", () => {
  const frame = new LocalFrame(origins[0]!);
  for (const [latitude, longitude, x, y] of reference) {
    const point = frame.to_local(latitude, longitude);
    assert.ok(Math.hypot(point.x - x, point.y - y) < 0.01, `${point.x} ${point.y}`);
  }
});

test("there and back within 20 km is nowhere", () => {
  for (const origin of origins) {
    const frame = new LocalFrame(origin);
    for (const [x, y] of [[0, 0], [20000, 0], [0, -20000], [-14000, 14000], [123.4, -567.8]] as const) {
      const { latitude_deg, longitude_deg } = frame.to_wgs84({ x, y });
      const back = frame.to_local(latitude_deg, longitude_deg);
      assert.ok(Math.hypot(back.x - x, back.y - y) < 0.001, `${x} ${y}`);
    }
  }
});

test("bearings are compass degrees", () => {
  const from = { x: 10, y: 10 };
  assert.deepEqual(distance_and_bearing(from, { x: 10, y: 20 }), { distance_m: 10, bearing_deg: 0 });
  assert.equal(distance_and_bearing(from, { x: 20, y: 10 }).bearing_deg, 90);
  assert.equal(distance_and_bearing(from, { x: 0, y: 10 }).bearing_deg, 270);
});

test("a course of 90 degrees leads east", () => {
  const there = moved({ x: 1, y: 2 }, 90, 20, 0.5);
  assert.ok(Math.abs(there.x - 11) < 1e-9 && Math.abs(there.y - 2) < 1e-9);
});

test("a path is followed by time", () => {
  const path = [[0, 0, 10], [10, 0, 20], [10, 20, 30]] as [number, number, number][];
  assert.deepEqual(on_path(path, 5), { x: 0, y: 0 });
  assert.deepEqual(on_path(path, 15), { x: 5, y: 0 });
  assert.deepEqual(on_path(path, 25), { x: 10, y: 10 });
  assert.deepEqual(on_path(path, 99), { x: 10, y: 20 });
  assert.equal(on_path([], 1), null);
});
