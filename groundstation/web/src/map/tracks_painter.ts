// SPDX-License-Identifier: Apache-2.0
// Where vehicles were and where they will go: trails, planned paths, previews of formation orders.

import type { Mover, Plan, Vehicle } from "../wire/protocol";
import type { Track, Tracks } from "../wire/tracks";
import type { View } from "./canvas_layer";
import { font, label, trace } from "./draw";

const trail_samples = 300;
// Of all trails together: of very many vehicles each is shorter.
const samples_painted = 60_000;

export function paint_trails(view: View, tracks: Tracks, vehicles: readonly Vehicle[], selected: number | null, colour_of: (id: number) => string): void {
  const { context } = view;
  context.lineJoin = "round";
  const each = Math.max(30, Math.min(trail_samples, Math.floor(samples_painted / Math.max(1, vehicles.length))));
  // One stroke for all of a colour is many times faster than one for each.
  const strokes = new Map<string, Path2D>();
  for (const vehicle of vehicles) {
    const track = tracks.get(vehicle.id);
    if (!track || track.t.length < 2) continue;
    const colour = colour_of(vehicle.id);
    if (vehicle.id === selected) {
      const path = new Path2D();
      trail(view, path, track, vehicle, 0);
      stroke(context, path, colour, 0.95, 2);
      continue;
    }
    const path = strokes.get(colour) ?? new Path2D();
    strokes.set(colour, path);
    trail(view, path, track, vehicle, Math.max(0, track.t.length - each));
  }
  for (const [colour, path] of strokes) stroke(context, path, colour, 0.45, 1);
  context.globalAlpha = 1;
}

function stroke(context: CanvasRenderingContext2D, path: Path2D, colour: string, alpha: number, width: number): void {
  context.strokeStyle = colour;
  context.globalAlpha = alpha;
  context.lineWidth = width;
  context.stroke(path);
}

function trail(view: View, path: Path2D, track: Track, vehicle: Vehicle, from: number): void {
  let last_x = Number.NaN;
  let last_y = Number.NaN;
  for (let i = from; i < track.t.length; ++i) {
    const x = view.px(track.x[i]!);
    const y = view.py(track.y[i]!);
    // Points within a pixel and a half make no line that could be seen.
    if (Math.abs(x - last_x) + Math.abs(y - last_y) < 1.5) continue;
    if (Number.isNaN(last_x)) path.moveTo(x, y);
    else path.lineTo(x, y);
    last_x = x;
    last_y = y;
  }
  if (vehicle.x !== null && vehicle.y !== null) path.lineTo(view.px(vehicle.x), view.py(vehicle.y));
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
