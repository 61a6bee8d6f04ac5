// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { empty_picture } from "../wire/picture";
import { axis_px, names_px, span_text } from "./timeline_painter";
import type { TimelineView } from "./timeline_painter";
import { rows_of } from "./timeline_rows";

test("what is under the pointer is told with its site and from when until when", () => {
  const timeline = {
    states: ["searching", "assessing"],
    vehicles: [
      { id: 3, states: [0, 1, 0], from_s: [10, 70, 130], sites: [null, 4, null] },
      { id: 5, states: [], from_s: [], sites: [] },
    ],
  };
  const picture = { ...empty_picture(), timeline };
  const view = { rows: rows_of([3, 5], new Set(), 100, false), scroll: 0, now_s: 200, known_s: 200 } as unknown as TimelineView;
  const text = (row: number, time_s: number, of = view) => span_text(of, picture, names_px + 1, axis_px + of.rows.rows[row]!.y + 1, time_s);
  assert.equal(text(0, 69.9), "Vehicle 3: searching, 00:10 – 01:10");
  assert.equal(text(0, 70), "Vehicle 3: assessing, site 4, 01:10 – 02:10");
  assert.equal(text(0, 150), "Vehicle 3: searching, 02:10 – now");
  assert.equal(text(0, 150, { ...view, now_s: 230 }), "Vehicle 3: searching, 02:10 – 03:20, not known since");
  for (const time_s of [5, 200]) assert.equal(text(0, time_s), "Vehicle 3");
  assert.equal(text(1, 50), "Vehicle 5");
  assert.equal(span_text(view, picture, 0, axis_px + 1, 50), null);
});
