// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { a_vehicle } from "./samples";
import { Tracks, aligned, samples_kept } from "./tracks";

test("states ten times a second leave one sample a second", () => {
  const tracks = new Tracks();
  for (let i = 0; i <= 50; ++i) {
    tracks.add([a_vehicle(1, { x: i, heard_age_s: 0 })], Number((i / 10).toFixed(3)));
  }
  assert.deepEqual(tracks.get(1)?.x, [0, 10, 20, 30, 40, 50]);
});

test("a silent vehicle adds nothing, and its age is taken off", () => {
  const tracks = new Tracks();
  tracks.add([a_vehicle(1, { heard_age_s: 0.5 })], 10);
  tracks.add([a_vehicle(1, { heard_age_s: 20.5 })], 30);
  tracks.add([a_vehicle(2, { x: null, y: null, heard_age_s: null })], 30);
  assert.deepEqual(tracks.get(1)?.t, [9.5]);
  assert.equal(tracks.get(2), undefined);
});

test("history takes the place of what there was, and does not grow for ever", () => {
  const tracks = new Tracks();
  tracks.add([a_vehicle(2)], 500);
  const one = { id: 1, t: [1, 2], x: [0, 1], y: [0, 1], z: [0, 1], speed: [0, 1], range: [0, 1], delay: [null, 1] };
  tracks.load([one]);
  assert.equal(tracks.get(2), undefined);
  for (let t = 3; t < 1000; ++t) tracks.add([a_vehicle(1, { heard_age_s: 0 })], t);
  assert.deepEqual(tracks.get(1)?.t, Array.from({ length: samples_kept }, (_, i) => 1000 - samples_kept + i));
  assert.deepEqual(one.t, [1, 2]);
});

test("tracks of different seconds are put side by side", () => {
  const tracks = new Tracks();
  const rest = { x: [0, 0], y: [0, 0], z: [0, 0], range: [0, 0], delay: [0, 0] };
  tracks.load([
    { id: 1, t: [1.1, 2.1], speed: [10, 11], ...rest },
    { id: 2, t: [1.9, 3.2], speed: [20, 21], ...rest },
  ]);
  assert.deepEqual(
    aligned([tracks.get(1), tracks.get(2), undefined], (track) => track.speed),
    [[1, 2, 3], [10, 11, null], [null, 20, 21], [null, null, null]],
  );
});
