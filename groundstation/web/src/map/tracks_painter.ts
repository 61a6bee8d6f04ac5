// SPDX-License-Identifier: Apache-2.0
// Where vehicles were and where they will go: trails, planned paths, previews of formation orders.

import type { Mover, Plan, Vehicle } from "../wire/protocol";
import type { Tracks } from "../wire/tracks";
import type { View } from "./canvas_layer";
import { font, label, trace } from "./draw";

const trail_samples = 300;

export function paint_trails(view: View, tracks: Tracks, vehicles: readonly Vehicle[], selected: number | null, colour_of: (id: number) => string): void {
  const { context } = view;
  context.lineJoin = "round";
  for (const vehicle of vehicles) {
    const track = tracks.get(vehicle.id);
    if (!track || track.t.length < 2) continue;
    const is_selected = vehicle.id === selected;
    context.beginPath();
    const from = is_selected ? 0 : Math.max(0, track.t.length - trail_samples);
    let last_x = Number.NaN;
    let last_y = Number.NaN;
    for (let i = from; i < track.t.length; ++i) {
      const x = view.px(track.x[i]!);
      const y = view.py(track.y[i]!);
      // Points within a pixel and a half make no line that could be seen.
      if (Math.abs(x - last_x) + Math.abs(y - last_y) < 1.5) continue;
      if (Number.isNaN(last_x)) context.moveTo(x, y);
      else context.lineTo(x, y);
      last_x = x;
      last_y = y;
    }
    if (vehicle.x !== null && vehicle.y !== null) context.lineTo(view.px(vehicle.x), view.py(vehicle.y));
    context.strokeStyle = colour_of(vehicle.id);
    context.globalAlpha = is_selected ? 0.95 : 0.45;
    context.lineWidth = is_selected ? 2 : 1;
    context.stroke();
  }
  context.globalAlpha = 1;
}

/** What is left of the planned paths, dashed, with the orbit that each ends in; `marked` ones bold. */
export function paint_paths(view: View, plans: readonly Plan[], now_s: number, marked: ReadonlySet<number>, colour_of: (id: number) => string): void {
  const { context } = view;
  for (const plan of plans) {
    const is_marked = marked.has(plan.id);
    const next = plan.points.findIndex((point) => point[2] > now_s);
    context.strokeStyle = colour_of(plan.id);
    context.globalAlpha = is_marked ? 1 : 0.6;
    context.lineWidth = is_marked ? 2 : 1;
    context.setLineDash(is_marked ? [7, 4] : [4, 5]);
    if (next >= 0) {
      trace(view, plan.points.slice(Math.max(0, next - 1)));
      context.stroke();
    }
    if (plan.hold.length > 1) {
      context.setLineDash([1.5, 4]);
      trace(view, plan.hold);
      context.stroke();
    }
  }
  context.setLineDash([]);
  context.globalAlpha = 1;
}

/** Where each vehicle of a formation would go, or is going. */
export function paint_movers(view: View, movers: readonly Mover[], colour: string, strong: boolean): void {
  const { context } = view;
  const heights = new Set(movers.map((mover) => mover.points[mover.points.length - 1]?.[2].toFixed(0)));
  context.strokeStyle = context.fillStyle = colour;
  for (const mover of movers) {
    const end = mover.points[mover.points.length - 1];
    if (!end) continue;
    context.lineWidth = strong ? 2 : 1.5;
    context.setLineDash(strong ? [] : [5, 4]);
    trace(view, mover.points);
    context.stroke();
    context.setLineDash([]);
    context.beginPath();
    context.arc(view.px(end[0]), view.py(end[1]), 6, 0, 2 * Math.PI);
    context.stroke();
    if (!strong) continue;
    context.font = font(10, true);
    context.textAlign = "left";
    context.textBaseline = "bottom";
    const height = heights.size > 1 ? ` · ${end[2].toFixed(0)} m` : "";
    label(view, `${mover.id}${height}`, view.px(end[0]) + 8, view.py(end[1]) - 4, colour);
    context.strokeStyle = colour;
  }
}
