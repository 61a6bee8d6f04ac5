// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { age, bearing, bearing_digits, clock, distance, duration, from_origin, ids, latitude_longitude, number, utc } from "./format";

test("clock", () => {
  assert.equal(clock(0), "00:00");
  assert.equal(clock(59.96, 1), "01:00.0");
  assert.equal(clock(3725.04, 1), "1:02:05.0");
  assert.equal(clock(-1.5, 1), "−00:01.5");
  assert.equal(clock(null), "–");
});

test("duration, distance, number", () => {
  assert.equal(duration(0.04), "0.0 s");
  assert.equal(duration(9.96), "10 s");
  assert.equal(duration(200), "3 min 20 s");
  assert.equal(duration(7260), "2 h 1 min");
  assert.equal(distance(4.04), "4.0 m");
  assert.equal(distance(999.6), "1.0 km");
  assert.equal(distance(123456), "123 km");
  assert.equal(number(-0.04, 1), "0.0");
  assert.equal(number(-12.34, 1), "−12.3");
  assert.equal(number(null), "–");
});

test("ages fit a column", () => {
  assert.deepEqual([0.04, 12.3, 99.6, 720, 7200, null].map(age), ["0.0 s", "12 s", "2 min", "12 min", "2 h", "–"]);
});

test("bearings have three digits and 360 is 0", () => {
  assert.equal(bearing(7), "007°");
  assert.equal(bearing(359.7), "000°");
  assert.equal(bearing(-90), "270°");
});

test("bearings of typed lines have three digits, too", () => {
  assert.deepEqual([7, 90, -90, 360, 7.5].map(bearing_digits), ["007", "090", "270", "000", "007.5"]);
});

test("at the origin there is no direction", () => {
  assert.equal(from_origin(0, 0), "at the origin");
  assert.equal(from_origin(250, 7), "250 m from the origin towards 007°");
});

test("the time of day beside a mission time", () => {
  assert.equal(utc(71.9, 1700014400), "02:14:31 UTC");
  assert.equal(utc(null, 1700014400), "–");
  assert.equal(utc(5, null), "–");
});

test("places on earth", () => {
  assert.equal(latitude_longitude(-31.5, 105.0443271), "31.500000° S, 105.044327° E");
});

test("ids in runs", () => {
  assert.equal(ids([3, 1, 2, 7]), "1–3, 7");
  assert.equal(ids([5, 4]), "4, 5");
  assert.equal(ids([]), "");
});
