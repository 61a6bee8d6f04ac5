// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { LocalFrame } from "../map/geodesy";
import { add_corner, area_m2, corner_at, corners_max, fence_yaml, move_corner, outline_of_file, remove_corner, typed_corners, why_no_outline } from "./outline";
import type { Outline } from "./outline";

const square: Outline = [[0, 0], [100, 0], [100, 100], [0, 100]];

test("corners are added, found, moved and taken away", () => {
  let drawn: Outline = [];
  for (let i = 0; i < corners_max + 3; ++i) drawn = add_corner(drawn, i + 0.4, -i);
  assert.equal(drawn.length, corners_max);
  assert.deepEqual(drawn[3], [3, -3]);
  assert.equal(corner_at(square, 97, 4, 10), 1);
  assert.equal(corner_at(square, 50, 50, 10), null);
  assert.deepEqual(move_corner(square, 1, 120.2, 5)[1], [120, 5]);
  assert.deepEqual(remove_corner(square, 0), square.slice(1));
});

test("says what is no outline", () => {
  assert.match(why_no_outline([])!, /none are/);
  assert.match(why_no_outline([[0, 0], [100, 100], [100, 0], [0, 100]])!, /crosses/);
  assert.equal(why_no_outline(square), null);
  assert.equal(why_no_outline([[0, 0], [200, 0], [100, 30], [100, 200]]), null);
  assert.equal(area_m2(square), 10_000);
});

test("corners can be typed", () => {
  assert.deepEqual(typed_corners(" 120,-40 300,20;\n5.5,6 "), { corners: [[120, -40], [300, 20], [5.5, 6]] });
  for (const wrong of ["120", "1,2,3", "a,b", "1,", "1e999,2"]) assert.ok("trouble" in typed_corners(wrong), wrong);
  assert.ok("trouble" in typed_corners("1,2 ".repeat(33)));
});

test("outlines come from GeoJSON and from a .plan file", () => {
  const frame = new LocalFrame({ latitude_deg: 47, longitude_deg: 8, height_m: 400 });
  const places = square.map(([x, y]) => frame.to_wgs84({ x, y }));
  const ring = [...places, places[0]!].map((at) => [at.longitude_deg, at.latitude_deg]);
  const geometry = { type: "Polygon", coordinates: [ring] };
  for (const file of [geometry, { type: "Feature", geometry }, { type: "FeatureCollection", features: [{ type: "Feature", geometry: { type: "Point", coordinates: [8, 47] } }, { type: "Feature", geometry }] }, { type: "MultiPolygon", coordinates: [[ring]] }]) {
    assert.deepEqual(outline_of_file(JSON.stringify(file), frame), { corners: square });
  }
  const plan = { fileType: "Plan", geoFence: { polygons: [{ inclusion: true, polygon: places.map((at) => [at.latitude_deg, at.longitude_deg]) }] } };
  assert.deepEqual(outline_of_file(JSON.stringify(plan), frame), { corners: square });
  for (const wrong of ["{", "null", "[]", "{}", '{"type":"Polygon","coordinates":[]}', '{"type":"Polygon","coordinates":[[[8,"x"]]]}', '{"type":"Polygon","coordinates":[[[8,470],[8,47],[8.1,47]]]}', '{"type":"Polygon","coordinates":[[[80,47],[8,47],[8.1,47]]]}']) {
    assert.ok("trouble" in outline_of_file(wrong, frame), wrong);
  }
  const polygon = places.map((at) => [at.latitude_deg, at.longitude_deg]);
  for (const not_one of [
    { geoFence: { polygons: [{ inclusion: false, polygon }] } },
    { geoFence: { polygons: [{ inclusion: true, polygon }, { inclusion: true, polygon }] } },
    { type: "Polygon", coordinates: [ring, ring] },
    { type: "MultiPolygon", coordinates: [[ring], [ring]] },
    { type: "FeatureCollection", features: [{ type: "Feature", geometry }, { type: "Feature", geometry }] },
  ]) {
    assert.ok("trouble" in outline_of_file(JSON.stringify(not_one), frame), "an outline is one, without holes, of what lies within");
  }
});

test("a fence is written for the configuration", () => {
  assert.equal(fence_yaml([[0, 0], [10, 0], [0, 10]], 120), "fence:\n  height_max_m: 120\n  corners:\n    - [0, 0]\n    - [10, 0]\n    - [0, 10]\n");
});
