// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { column_longitude, row_latitude, tile_column, tile_row, zoom_for } from "./mercator";

test("tiles of known places", () => {
  // Null Island is the corner of four tiles; 85.0511 N is the upper edge.
  assert.equal(tile_column(0, 4), 8);
  assert.ok(Math.abs(tile_row(0, 4) - 8) < 1e-9);
  assert.ok(Math.abs(tile_row(85.0511287798, 4)) < 1e-6);
  // 31.522062 N 105.044327 E at zoom 12: worked out by hand from the definition.
  assert.equal(Math.floor(tile_column(105.044327, 12)), 3243);
  assert.equal(Math.floor(tile_row(31.522062, 12)), 1669);
});

test("there and back", () => {
  for (const latitude of [-60, -1, 0, 31.5, 80]) {
    assert.ok(Math.abs(row_latitude(tile_row(latitude, 15), 15) - latitude) < 1e-9);
  }
  assert.ok(Math.abs(column_longitude(tile_column(105.04, 15), 15) - 105.04) < 1e-9);
});

test("a metre a pixel is zoom 17 at the equator, and 16 at 60 degrees", () => {
  assert.equal(zoom_for(1, 0), 17);
  assert.equal(zoom_for(1, 60), 16);
});
