// SPDX-License-Identifier: Apache-2.0
// What the person draws: a measured distance, a hazard, the place of a formation.

import { bearing, distance } from "../shell/format";
import { formation_spot, hazard_draft, measure_from, measure_to, site_spot } from "../shell/view";
import type { View } from "./canvas_layer";
import { font, label } from "./draw";
import { distance_and_bearing } from "./geodesy";
import { disc } from "./ground";

export function paint_tools(view: View): void {
  const { context, colours } = view;
  const from = measure_from.value;
  const to = measure_to.value;
  context.font = font(12, true);
  if (from) cross(view, from.x, from.y);
  if (from && to) {
    context.setLineDash([6, 4]);
    context.lineWidth = 1.5;
    context.strokeStyle = colours.accent;
    context.beginPath();
    context.moveTo(view.px(from.x), view.py(from.y));
    context.lineTo(view.px(to.x), view.py(to.y));
    context.stroke();
    context.setLineDash([]);
    cross(view, to.x, to.y);
    const { distance_m, bearing_deg } = distance_and_bearing(from, to);
    context.textAlign = "center";
    context.textBaseline = "bottom";
    label(view, `${distance(distance_m)} · ${bearing(bearing_deg)}`, (view.px(from.x) + view.px(to.x)) / 2, (view.py(from.y) + view.py(to.y)) / 2 - 6);
  }
  const draft = hazard_draft.value;
  if (draft) {
    context.setLineDash([6, 4]);
    disc(view, draft.x, draft.y, draft.radius_m, colours.preview, true);
    context.setLineDash([]);
    cross(view, draft.x, draft.y);
    context.font = font(12, true);
    context.textAlign = "center";
    context.textBaseline = "bottom";
    label(view, `new hazard, radius ${distance(draft.radius_m)}`, view.px(draft.x), view.py(draft.y) - 8, colours.preview);
  }
  const site = site_spot.value;
  if (site) {
    cross(view, site.x, site.y, colours.preview);
    context.textAlign = "center";
    context.textBaseline = "bottom";
    label(view, "new site", view.px(site.x), view.py(site.y) - 8, colours.preview);
  }
  const spot = formation_spot.value;
  if (spot) cross(view, spot.x, spot.y, colours.preview);
}

function cross(view: View, x: number, y: number, colour = view.colours.accent): void {
  const { context } = view;
  const cx = view.px(x);
  const cy = view.py(y);
  context.strokeStyle = colour;
  context.lineWidth = 2;
  context.beginPath();
  context.moveTo(cx - 6, cy);
  context.lineTo(cx + 6, cy);
  context.moveTo(cx, cy - 6);
  context.lineTo(cx, cy + 6);
  context.stroke();
}
