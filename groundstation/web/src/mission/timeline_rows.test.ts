// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { first_span, row_at, row_px, rows_of } from "./timeline_rows";

const ids = (count: number) => Array.from({ length: count }, (_, i) => i + 1);

test("where there is room each has a row, in order", () => {
  const { rows, condensed } = rows_of(ids(12), new Set([7]), 180, true);
  assert.equal(condensed, false);
  assert.deepEqual(rows.map(({ id }) => id), ids(12));
});

test("all are in sight when it is condensed, those that come first on top in rows of their own", () => {
  for (const count of [32, 100, 150]) {
    const { rows, height, condensed } = rows_of(ids(count), new Set([9, 30]), 190, true);
    assert.ok(condensed);
    assert.ok(height <= 190.001, `${count}: ${height}`);
    assert.equal(rows.length, count);
    assert.equal(new Set(rows.map(({ id }) => id)).size, count);
    assert.deepEqual(rows.slice(0, 2).map(({ id, height: of }) => [id, of]), [[9, row_px], [30, row_px]]);
    assert.ok(rows[2]!.height >= 1);
  }
});

test("of a thousand they are as low as can be seen, and are scrolled", () => {
  const { rows, height } = rows_of(ids(1000), new Set(), 190, true);
  assert.equal(rows[0]!.height, 1);
  assert.equal(height, 1000);
});

test("those that come first leave room for the others", () => {
  const { rows } = rows_of(ids(100), new Set(ids(100)), 150, true);
  assert.equal(rows.filter(({ height }) => height === row_px).length, 6);
});

test("without condensing they are scrolled", () => {
  assert.equal(rows_of(ids(32), new Set(), 190, false).height, 32 * row_px);
});

test("a row is found by where it stands", () => {
  const { rows } = rows_of(ids(32), new Set([20]), 190, true);
  assert.equal(row_at(rows, 3)!.id, 20);
  for (const row of rows) assert.equal(row_at(rows, row.y + row.height / 2), row);
  assert.equal(row_at(rows, 1e4), null);
  assert.equal(row_at(rows, -1), null);
});

test("spans that are over before what is shown are passed over", () => {
  const begin_s = [0, 10, 20];
  assert.equal(first_span(begin_s, 15), 1);
  assert.equal(first_span(begin_s, 20), 2);
  assert.equal(first_span(begin_s, -5), 0);
  assert.equal(first_span([], 5), 0);
});
