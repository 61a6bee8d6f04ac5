// SPDX-License-Identifier: Apache-2.0
// Search areas with each vehicle's way, the fence, and the outline that is being drawn.

import { distance } from "../shell/format";
import type { Areas, Fence, SearchArea } from "../wire/protocol";
import type { View } from "../map/canvas_layer";
import { font, label } from "../map/draw";
import { disc } from "../map/ground";
import { cover_shown, held_corner, outline, outline_use } from "./outline";
import type { Outline } from "./outline";

function trace(view: View, points: Outline, closed: boolean): void {
  const { context } = view;
  context.beginPath();
  points.forEach(([x, y], i) => (i === 0 ? context.moveTo(view.px(x), view.py(y)) : context.lineTo(view.px(x), view.py(y))));
  if (closed) context.closePath();
}

/** What stands on the ground; `given` is the search that is flown, or a preview. */
export function paint_areas(view: View, areas: Areas | null, fence: Fence | null, colour_of: (id: number) => string): void {
  const { context, colours } = view;
  context.save();
  if (fence) {
    trace(view, fence.corners, true);
    context.strokeStyle = colours.warning;
    context.lineWidth = 2.5;
    context.setLineDash([14, 5, 3, 5]);
    context.stroke();
    context.setLineDash([]);
    const top = fence.corners.reduce((high, corner) => (corner[1] > high[1] ? corner : high));
    context.font = font(11);
    context.textAlign = "center";
    context.textBaseline = "bottom";
    label(view, `fence, up to ${distance(fence.height_m)}`, view.px(top[0]), view.py(top[1]) - 4, colours.warning);
  }
  for (const group of areas?.hazards ?? []) {
    if (group.corners.length === 0) continue;
    trace(view, group.corners, true);
    context.strokeStyle = colours.hazard;
    context.lineWidth = 2;
    context.stroke();
    const middle = centre(group.corners);
    context.font = font(11);
    context.textAlign = "center";
    context.textBaseline = "middle";
    label(view, `keep out ${group.hazard}`, view.px(middle[0]), view.py(middle[1]), colours.hazard);
  }
  if (areas?.search) paint_search(view, areas.search, colour_of, false);
  context.restore();
}

function centre(of: Outline): [number, number] {
  const sum = of.reduce<[number, number]>(([x, y], corner) => [x + corner[0], y + corner[1]], [0, 0]);
  return [sum[0] / of.length, sum[1] / of.length];
}

export function paint_search(view: View, search: SearchArea, colour_of: (id: number) => string, is_preview: boolean): void {
  const { context, colours } = view;
  context.save();
  trace(view, search.corners, true);
  context.strokeStyle = is_preview ? colours.preview : colours.accent;
  context.lineWidth = 2;
  context.stroke();
  for (const share of search.shares) {
    const colour = is_preview ? colours.preview : colour_of(share.id);
    context.strokeStyle = colour;
    // What is left to be flown, and the route that the vehicle has.
    context.lineWidth = 1;
    context.setLineDash([3, 5]);
    for (const [ax, ay, bx, by] of share.ways) {
      trace(view, [[ax, ay], [bx, by]], false);
      context.stroke();
    }
    context.setLineDash([]);
    if (share.state === "left" || share.points.length === 0) continue;
    context.globalAlpha = share.state === "done" ? 0.4 : 1;
    context.lineWidth = 1.5;
    trace(view, share.points, false);
    context.stroke();
    context.globalAlpha = 1;
    const [x, y] = share.points[0]!;
    context.font = font(11, true);
    context.textAlign = "center";
    context.textBaseline = "bottom";
    label(view, `${share.id}`, view.px(x), view.py(y) - 4, colour);
  }
  context.restore();
}

/** The outline in work, with a grip at each corner. */
export function paint_outline(view: View): void {
  const corners = outline.value;
  if (corners.length === 0) return;
  const { context, colours } = view;
  context.save();
  for (const [x, y, radius_m] of cover_shown.value) disc(view, x, y, radius_m, colours.preview, false);
  trace(view, corners, corners.length > 2);
  context.strokeStyle = colours.preview;
  context.lineWidth = 2;
  context.setLineDash([6, 4]);
  context.stroke();
  context.setLineDash([]);
  corners.forEach(([x, y], i) => {
    context.beginPath();
    context.arc(view.px(x), view.py(y), held_corner.value === i ? 10 : 7, 0, 2 * Math.PI);
    context.fillStyle = colours.halo;
    context.fill();
    context.stroke();
    context.font = font(10, true);
    context.textAlign = "center";
    context.textBaseline = "middle";
    label(view, `${i + 1}`, view.px(x), view.py(y), colours.preview);
  });
  const words = { search: "search area", hazard: "new hazard", fence: "new fence" };
  const [x, y] = centre(corners);
  context.font = font(12, true);
  label(view, words[outline_use.value], view.px(x), view.py(y), colours.preview);
  context.restore();
}
