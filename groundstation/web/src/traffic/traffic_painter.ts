// SPDX-License-Identifier: Apache-2.0
// Aircraft that are not of the team: where they are, and where they will be in a minute.

import type { View } from "../map/canvas_layer";
import { font, label } from "../map/draw";
import { moved } from "../map/geodesy";
import type { TrafficAircraft } from "../wire/protocol";
import { above_text, climb_sign, is_old, name_of, standing_of } from "./traffic";
import type { Standing } from "./traffic";

const vector_s = 60;

function colour_of(view: View, standing: Standing): string {
  if (standing === "too_near") return view.colours.alarm;
  if (standing === "given_way" || standing === "near") return view.colours.warning;
  return view.colours.text;
}

/** An open diamond: nothing of the team has one. */
function diamond(view: View, x: number, y: number, radius: number): void {
  const { context } = view;
  context.beginPath();
  context.moveTo(x, y - radius);
  context.lineTo(x + radius, y);
  context.lineTo(x, y + radius);
  context.lineTo(x - radius, y);
  context.closePath();
  context.stroke();
}

/** `ahead_s`: since the newest state. */
export function paint_traffic(view: View, all: readonly TrafficAircraft[], ahead_s: number): void {
  const { context } = view;
  for (const aircraft of all) {
    const standing = standing_of(aircraft);
    const colour = colour_of(view, standing);
    const at = moved({ x: aircraft.x, y: aircraft.y }, aircraft.track_deg, aircraft.speed_mps, Math.min(ahead_s, 1));
    const then = moved(at, aircraft.track_deg, aircraft.speed_mps, vector_s);
    const x = view.px(at.x);
    const y = view.py(at.y);
    context.globalAlpha = is_old(aircraft) ? 0.5 : 1;
    context.strokeStyle = colour;
    context.lineWidth = 1.5;
    if (aircraft.speed_mps > 1) {
      context.setLineDash([6, 4]);
      context.beginPath();
      context.moveTo(x, y);
      context.lineTo(view.px(then.x), view.py(then.y));
      context.stroke();
      context.setLineDash([]);
    }
    context.lineWidth = standing === "far" ? 2 : 3;
    diamond(view, x, y, 8);
    context.font = font(11, standing !== "far");
    context.textAlign = "left";
    context.textBaseline = "middle";
    label(view, `${name_of(aircraft)} ${above_text(aircraft)}${climb_sign(aircraft)}`, x + 13, y, colour);
  }
  context.globalAlpha = 1;
}
