// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { coalition_sign, corners, line_colour, shapes } from "./palette";

test("no two of 49 coalitions have the same colour and shape, and no letters come twice", () => {
  const signs = Array.from({ length: 49 }, (_, slot) => coalition_sign(slot));
  assert.equal(new Set(signs.map((sign) => sign.colour + sign.shape)).size, 49);
  assert.equal(new Set(signs.map((sign) => sign.letter)).size, 49);
  assert.deepEqual(signs.slice(24, 28).map((sign) => sign.letter), ["Y", "Z", "AA", "AB"]);
});

test("lines are darker by day", () => {
  assert.equal(line_colour(coalition_sign(0), false), "#e69f00");
  assert.equal(line_colour(coalition_sign(0), true), "#a16f00");
});

test("shapes stay within their circle", () => {
  for (const shape of shapes) {
    for (const [x, y] of corners(shape)) assert.ok(Math.hypot(x, y) < 1.1);
  }
});
