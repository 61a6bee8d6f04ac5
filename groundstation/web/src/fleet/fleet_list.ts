// SPDX-License-Identifier: Apache-2.0
// Which vehicles the list shows, and in what order.

import { words } from "../shell/format";
import type { Vehicle } from "../wire/protocol";
import { health_of, problems_of, rank_of } from "./attention";
import type { Group } from "./groups";
import { groups_of } from "./groups";
import { task_text } from "./texts";

export const column_names = ["id", "state", "task", "heard", "range", "loads", "mode", "version", "clock", "groups"] as const;
export type Column = (typeof column_names)[number];

export interface Filter {
  /** Numbers as 3, 5-9, or a part of what stands in a row. */
  text: string;
  /** Empty: whatever they do. */
  states: ReadonlySet<string>;
  group: string | null;
  attention: boolean;
}

export const no_filter: Filter = { text: "", states: new Set(), group: null, attention: false };

export interface Sorting {
  /** null: what needs attention first. */
  column: Column | null;
  descending: boolean;
}

/** As it is counted and filtered; `not heard yet` of one that has none. */
export function state_of(vehicle: Vehicle): string {
  return vehicle.state ?? "not_heard_yet";
}

// As a flight goes on; what is not named comes last.
const state_order = [
  "silent", "not_heard_yet", "on_the_ground", "waiting_for_the_start", "taking_off", "searching", "surveying", "leading", "bidding",
  "waiting_for_authorisation", "delivering", "assessing", "executing", "too_late_for_its_task", "monitoring", "holding", "holding_by_order",
  "not_worked_with", "forming", "en_route", "standing_by", "range_reserve", "back_into_its_fence", "keeping_clear_of_traffic", "piloted", "returning", "at_home", "landing",
  "landed",
];
const place_of = new Map(state_order.map((state, i) => [state, i]));

/** How many do what, in an order that does not change with the counts. */
export function counts_by_state(vehicles: readonly Vehicle[]): [state: string, count: number][] {
  const counts = new Map<string, number>();
  for (const vehicle of vehicles) {
    const state = state_of(vehicle);
    counts.set(state, (counts.get(state) ?? 0) + 1);
  }
  const place = (state: string) => place_of.get(state) ?? state_order.length;
  return [...counts].sort(([a], [b]) => place(a) - place(b) || a.localeCompare(b));
}

/** Whether it is to be looked at: whatever is not well, but for a picture that is old as a whole. */
export function needs_attention(vehicle: Vehicle): boolean {
  const health = health_of(vehicle);
  return health !== "well" && health !== "stale";
}

/** Numbers as 3, 5-9 12; null: it is no list of numbers. */
export function numbers_in(text: string): Set<number> | null {
  if (!/^\s*\d[\d\s,–-]*$/.test(text)) return null;
  const all = new Set<number>();
  for (const part of text.split(/[\s,]+/).filter(Boolean)) {
    const [first, last] = part.split(/[–-]/).map((one) => (one === "" ? NaN : Number(one)));
    const to = last === undefined || Number.isNaN(last) ? first! : last;
    // Ids have 16 bits; a typed range is not to fill the memory.
    for (let id = first!; id <= Math.min(to, 65535); ++id) all.add(id);
  }
  return all;
}

function text_of(vehicle: Vehicle, groups: readonly Group[]): string {
  return [
    words(state_of(vehicle)), vehicle.besides ? words(vehicle.besides) : "", task_text(vehicle), vehicle.mode ?? "", vehicle.version ?? "", vehicle.flight_controller ?? "",
    ...groups_of(groups, vehicle.id), ...problems_of(vehicle).map((problem) => problem.text),
  ].join("\n").toLowerCase();
}

/** The filter as a test of one vehicle after the other. */
export function passes(filter: Filter, groups: readonly Group[]): (vehicle: Vehicle) => boolean {
  const text = filter.text.trim().toLowerCase();
  const numbers = numbers_in(text);
  const of_group = filter.group === null ? null : new Set(groups.find((group) => group.name === filter.group)?.vehicles ?? []);
  return (vehicle) =>
    (filter.states.size === 0 || filter.states.has(state_of(vehicle))) &&
    (!of_group || of_group.has(vehicle.id)) &&
    (!filter.attention || needs_attention(vehicle)) &&
    (text === "" || (numbers ? numbers.has(vehicle.id) : text_of(vehicle, groups).includes(text)));
}

type Key = number | string | null;

// Rows that jump cannot be read: figures that change with every state are compared coarsely.
const keys: Record<Column, (vehicle: Vehicle, groups: readonly Group[]) => Key> = {
  id: (vehicle) => vehicle.id,
  state: (vehicle) => place_of.get(state_of(vehicle)) ?? state_order.length,
  task: (vehicle) => (vehicle.task ? vehicle.task.site * 100 + vehicle.task.index : null),
  heard: (vehicle) => (vehicle.heard_age_s === null ? null : Math.floor(vehicle.heard_age_s / 2)),
  range: (vehicle) => (vehicle.range_left_m === null ? null : Math.floor(vehicle.range_left_m / 250)),
  loads: (vehicle) => vehicle.loads,
  mode: (vehicle) => vehicle.mode,
  version: (vehicle) => vehicle.version,
  clock: (vehicle) => (vehicle.clock_offset_ms === null ? null : Math.floor(Math.abs(vehicle.clock_offset_ms) / 20)),
  groups: (vehicle, groups) => groups_of(groups, vehicle.id).join(", ") || null,
};

function compare(a: Key, b: Key): number {
  if (typeof a === "number" && typeof b === "number") return a - b;
  return String(a).localeCompare(String(b), undefined, { numeric: true });
}

/** What is not known comes last either way; by id among equals. */
export function sorted(vehicles: readonly Vehicle[], sorting: Sorting, groups: readonly Group[]): Vehicle[] {
  const of = sorting.column === null ? rank_of : (vehicle: Vehicle) => keys[sorting.column!](vehicle, groups);
  const sign = sorting.column !== null && sorting.descending ? -1 : 1;
  return vehicles
    .map((vehicle) => ({ vehicle, key: of(vehicle) as Key }))
    .sort((a, b) => {
      if (a.key === null || b.key === null) return Number(a.key === null) - Number(b.key === null) || a.vehicle.id - b.vehicle.id;
      return sign * compare(a.key, b.key) || a.vehicle.id - b.vehicle.id;
    })
    .map(({ vehicle }) => vehicle);
}

/** Upwards, downwards, and then again what needs attention first. */
export function next_sorting(now: Sorting, column: Column): Sorting {
  if (now.column !== column) return { column, descending: false };
  return now.descending ? { column: null, descending: false } : { column, descending: true };
}

/** Everybody from one to the other as they are listed; that one alone where nobody was touched before. */
export function between(listed: readonly number[], from: number | null, to: number): number[] {
  const a = from === null ? -1 : listed.indexOf(from);
  const b = listed.indexOf(to);
  if (a < 0 || b < 0) return [to];
  return listed.slice(Math.min(a, b), Math.max(a, b) + 1);
}

const widths_px: Record<Column, number> = { id: 86, state: 128, task: 104, heard: 46, range: 54, loads: 46, mode: 62, version: 52, clock: 50, groups: 78 };
// For fingers the first column has a larger box to tick.
const finger_px = 24;
const by_need: readonly Column[] = ["id", "state", "heard", "task", "range", "groups", "loads", "mode", "version", "clock"];

/** The columns that have room, in the table's order; the others are in a row that is opened. */
export function columns_for(room_px: number, has_groups: boolean, for_fingers: boolean, more_px: number): Column[] {
  let left = room_px - more_px - (for_fingers ? finger_px : 0);
  const taken = new Set<Column>();
  for (const column of by_need) {
    if (column === "groups" && !has_groups) continue;
    left -= widths_px[column];
    if (left < 0 && taken.size >= 2) break;
    taken.add(column);
  }
  return column_names.filter((column) => taken.has(column));
}

export function least_width(columns: readonly Column[], for_fingers: boolean): number {
  return columns.reduce((sum, column) => sum + widths_px[column], for_fingers ? finger_px : 0);
}

export interface Slice {
  from: number;
  to: number;
  above_px: number;
  below_px: number;
}

/** Which rows are in sight, and as high as what the others are. */
export function slice_of(heights: readonly number[], top_px: number, room_px: number, more_px: number): Slice {
  let from = 0;
  let above = 0;
  while (from < heights.length && above + heights[from]! < top_px - more_px) above += heights[from++]!;
  let to = from;
  let end = above;
  while (to < heights.length && end < top_px + room_px + more_px) end += heights[to++]!;
  let below = 0;
  for (let i = to; i < heights.length; ++i) below += heights[i]!;
  return { from, to, above_px: above, below_px: below };
}
