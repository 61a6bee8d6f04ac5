// SPDX-License-Identifier: Apache-2.0
// The ways home that are looked at before they are ordered, and how the map shows them.

import { signal } from "@preact/signals";
import type { View } from "../map/canvas_layer";
import { font, label, trace } from "../map/draw";
import { clock } from "../shell/format";
import type { ReturnPreview } from "../wire/protocol";

/** Of whom it is, as it was asked for, and what came of it; null: none is looked at. */
export const return_preview = signal<{ of: string; data: ReturnPreview } | null>(null);

export function paint_return(view: View, data: ReturnPreview): void {
  const { context, colours } = view;
  context.strokeStyle = colours.preview;
  context.lineJoin = "round";
  for (const way of data.ways) {
    context.lineWidth = 2;
    context.setLineDash([]);
    trace(view, way.points);
    context.stroke();
    context.lineWidth = 1.5;
    context.setLineDash([2, 4]);
    trace(view, way.hold);
    context.stroke();
  }
  context.setLineDash([]);
  context.font = font(11, true);
  context.textAlign = "center";
  context.textBaseline = "middle";
  // Where they wait at home is one place for many: the time stands where the way is half flown.
  for (const way of data.ways) {
    const middle = way.points[Math.floor(way.points.length / 2)];
    if (middle) label(view, `${way.id} home ${clock(way.end_s)}`, view.px(middle[0]), view.py(middle[1]), colours.preview);
  }
}
