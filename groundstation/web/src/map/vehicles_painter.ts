// SPDX-License-Identifier: Apache-2.0
// Vehicles where they are.

import { health_of } from "../fleet/attention";
import type { Health } from "../fleet/attention";
import { coalition_sign, line_colour } from "../theme/palette";
import type { CoalitionSign } from "../theme/palette";
import type { Picture } from "../wire/picture";
import type { Coalition, Vehicle } from "../wire/protocol";
import type { View } from "./canvas_layer";
import { badge, font, kept_label, label } from "./draw";
import { moved } from "./geodesy";
import type { Point } from "./geodesy";

export interface Membership {
  coalition: Coalition;
  sign: CoalitionSign;
}

/** The coalition that each vehicle is in now: the newest that has not ended. */
export function memberships(picture: Picture): Map<number, Membership> {
  const result = new Map<number, Membership>();
  for (const coalition of picture.coalitions) {
    if (coalition.state === "failed" || coalition.state === "closed") continue;
    const sign = coalition_sign(picture.coalition_slots.get(coalition.key) ?? 0);
    for (const id of [coalition.leader, ...coalition.members]) result.set(id, { coalition, sign });
  }
  return result;
}

// Beyond it a guess says less than the last known place.
const ahead_s_max = 0.6;

/** Where it is drawn: moved on by `ahead_s` where states are too rare for the scale. */
export function drawn_at(vehicle: Vehicle, ahead_s: number): Point | null {
  if (vehicle.x === null || vehicle.y === null) return null;
  const at = { x: vehicle.x, y: vehicle.y };
  if (ahead_s <= 0 || vehicle.silent || vehicle.course_deg === null || !vehicle.groundspeed) return at;
  return moved(at, vehicle.course_deg, vehicle.groundspeed, Math.min(ahead_s, ahead_s_max));
}

/** Whether states ten times a second would be seen as steps: then frames between them are painted. */
export function needs_frames(picture: Picture, scale: number): boolean {
  return picture.vehicles.some((vehicle) => (vehicle.groundspeed ?? 0) * scale * 0.1 > 1.5);
}

// Further out, height and speed stand at the selected vehicle only.
const least_scale_of_figures = 1;

export interface VehicleOptions {
  selected: number | null;
  /** All that are selected; `selected` is one of them. */
  selection: ReadonlySet<number>;
  labels: boolean;
  ahead_s: number;
  members: ReadonlyMap<number, Membership>;
}

export function paint_vehicles(view: View, picture: Picture, options: VehicleOptions): void {
  // Those that are selected last, over the others.
  const place = ({ id }: Vehicle) => (id === options.selected ? 2 : options.selection.has(id) ? 1 : 0);
  const order = [...picture.vehicles].sort((a, b) => place(a) - place(b));
  const drawn = order.flatMap((vehicle) => {
    const at = drawn_at(vehicle, options.ahead_s);
    return at && view.sees(at.x, at.y) ? [{ vehicle, health: health_of(vehicle), x: view.px(at.x), y: view.py(at.y) }] : [];
  });
  const has_room = view.scale < least_scale_of_figures ? () => false : room_around(drawn);
  for (const one of drawn) paint_rings(view, one, options);
  paint_darts(view, drawn, options);
  for (const one of drawn) paint_words(view, one, has_room(one.x, one.y), options);
}

interface Drawn {
  vehicle: Vehicle;
  health: Health;
  x: number;
  y: number;
}

const room_x_px = 90;
const room_y_px = 26;

/** Whether one at (x, y) has no other of them near; by cells, since every pair would be too many of a thousand. */
export function room_around(drawn: readonly { x: number; y: number }[]): (x: number, y: number) => boolean {
  const cells = new Map<string, { x: number; y: number }[]>();
  const column = (x: number) => Math.floor(x / room_x_px);
  const row = (y: number) => Math.floor(y / room_y_px);
  for (const one of drawn) {
    const key = `${column(one.x)} ${row(one.y)}`;
    const cell = cells.get(key);
    if (cell) cell.push(one);
    else cells.set(key, [one]);
  }
  return (x, y) => {
    let near = 0;
    for (let i = column(x) - 1; i <= column(x) + 1; ++i) {
      for (let j = row(y) - 1; j <= row(y) + 1; ++j) {
        for (const one of cells.get(`${i} ${j}`) ?? []) {
          if (Math.abs(one.x - x) < room_x_px && Math.abs(one.y - y) < room_y_px && ++near > 1) return false;
        }
      }
    }
    return true;
  };
}

/** Around who is selected, and who leads. */
function paint_rings(view: View, { vehicle, x, y }: Drawn, options: VehicleOptions): void {
  const { context, colours } = view;
  if (options.selection.has(vehicle.id)) {
    context.beginPath();
    context.arc(x, y, 17, 0, 2 * Math.PI);
    context.strokeStyle = colours.accent;
    context.lineWidth = vehicle.id === options.selected ? 3 : 2;
    context.stroke();
  }
  const member = options.members.get(vehicle.id);
  if (member?.coalition.leader !== vehicle.id) return;
  context.beginPath();
  context.arc(x, y, 13, 0, 2 * Math.PI);
  context.strokeStyle = line_colour(member.sign, colours.day);
  context.lineWidth = 1.5;
  context.stroke();
}

// Point, right, notch, left, point; ahead is upwards. (To close a path of a thousand of them is slow.)
const dart = [[0, -10], [7, 8], [0, 4], [-7, 8], [0, -10]] as const;

function add_dart(path: Path2D, { vehicle, x, y }: Drawn): void {
  const angle = ((vehicle.heading_deg ?? 0) * Math.PI) / 180;
  const cos = Math.cos(angle);
  const sin = Math.sin(angle);
  dart.forEach(([dx, dy], i) => {
    const px = x + dx * cos - dy * sin;
    const py = y + dx * sin + dy * cos;
    if (i === 0) path.moveTo(px, py);
    else path.lineTo(px, py);
  });
}

/** All of one colour at once: one stroke for each is many times slower. */
function paint_darts(view: View, drawn: readonly Drawn[], options: VehicleOptions): void {
  const { context, colours } = view;
  const heard = new Map<string, Path2D>();
  const lost = new Path2D();
  for (const one of drawn) {
    if (one.health === "silent" || one.health === "unheard") {
      add_dart(lost, one);
      continue;
    }
    const member = options.members.get(one.vehicle.id);
    const colour = member ? line_colour(member.sign, colours.day) : colours.vehicle;
    const path = heard.get(colour) ?? new Path2D();
    heard.set(colour, path);
    add_dart(path, one);
  }
  context.lineWidth = 1;
  context.strokeStyle = colours.halo;
  for (const [colour, path] of heard) {
    context.fillStyle = colour;
    context.fill(path);
    context.stroke(path);
  }
  context.fillStyle = colours.ground;
  context.fill(lost);
  context.lineWidth = 1.5;
  context.strokeStyle = colours.alarm;
  context.setLineDash([3, 2]);
  context.stroke(lost);
  context.setLineDash([]);
}

function paint_words(view: View, { vehicle, health, x, y }: Drawn, alone: boolean, options: VehicleOptions): void {
  const { context, colours } = view;
  const member = options.members.get(vehicle.id);
  const lost = health === "silent" || health === "unheard";
  if (health !== "well") paint_mark(view, x - 12, y - 9, health === "warning" ? colours.warning : colours.alarm, lost ? "?" : "!");
  if (member) badge(view, member.sign, x + 13, y - 10);
  if (!options.labels && !options.selection.has(vehicle.id)) return;
  kept_label(view, `${vehicle.id}`, x + 9, y + 4, 11, true);
  if (vehicle.id !== options.selected && (view.scale < least_scale_of_figures || !alone)) return;
  context.textAlign = "left";
  context.textBaseline = "top";
  context.font = font(10);
  const speed = vehicle.groundspeed === null ? "" : ` · ${vehicle.groundspeed.toFixed(0)} m/s`;
  label(view, `${vehicle.z === null ? "" : `${vehicle.z.toFixed(0)} m`}${speed}`, x + 9, y + 17, colours.muted);
}

function paint_mark(view: View, x: number, y: number, colour: string, text: string): void {
  const { context } = view;
  context.beginPath();
  context.arc(x, y, 6.5, 0, 2 * Math.PI);
  context.fillStyle = colour;
  context.fill();
  context.font = font(10, true);
  context.textAlign = "center";
  context.textBaseline = "middle";
  context.fillStyle = view.colours.halo;
  context.fillText(text, x, y + 0.5);
}

/** What is nearest to a press at (x, y) in pixels, within a finger's reach. */
export function vehicle_near(picture: Picture, view: Pick<View, "px" | "py">, x: number, y: number, reach: number): number | null {
  let best: number | null = null;
  let best_distance = reach;
  for (const vehicle of picture.vehicles) {
    if (vehicle.x === null || vehicle.y === null) continue;
    const distance = Math.hypot(view.px(vehicle.x) - x, view.py(vehicle.y) - y);
    if (distance > best_distance) continue;
    best = vehicle.id;
    best_distance = distance;
  }
  return best;
}
