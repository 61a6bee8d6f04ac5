// SPDX-License-Identifier: Apache-2.0
// How far the search of an area is, in words: how much is seen, who has what left, and when it is done.

import { clock, distance, duration, ids, number, utc } from "../shell/format";
import type { SearchArea, SearchShare } from "../wire/protocol";

const hectare_m2 = 1e4;
/** Less is as planned. */
const late_s = 5;

/** "31.2 of 65.0 ha searched (48 %)"; not all of it before it is. */
export function searched_text({ area_m2, seen = 0 }: SearchArea): string {
  const area_ha = area_m2 / hectare_m2;
  return `${number(seen * area_ha, 1)} of ${number(area_ha, 1)} ha searched (${Math.floor(100 * seen)} %)`;
}

const moment = (time_s: number, epoch_unix_s: number | null) => `at ${clock(time_s)}${epoch_unix_s === null ? "" : ` (${utc(time_s, epoch_unix_s)})`}`;

/** When all that is flown will be; empty while nobody flies it. */
export function expected_text({ expected_s, ends_s }: SearchArea, now_s: number | null, epoch_unix_s: number | null): string {
  if (expected_s === null || now_s === null) return "";
  const late = expected_s - ends_s;
  return `expected to be done in ${duration(Math.max(0, expected_s - now_s))}, ${moment(expected_s, epoch_unix_s)}${late < late_s ? "" : `, ${duration(late)} later than planned`}`;
}

/** "2 of 5, 1.2 km" */
export function left_text({ lanes, lanes_left, left_m }: SearchShare): string {
  return lanes_left === 0 ? "nothing" : `${lanes_left} of ${lanes}, ${distance(left_m)}`;
}

export function done_text({ done_s, state }: SearchShare, now_s: number | null): string {
  if (state === "done") return "done";
  if (done_s === null || now_s === null) return "–";
  return `in ${duration(Math.max(0, done_s - now_s))}, at ${clock(done_s)}`;
}

/** Who of these flies a share, or is to fly one. */
export function searching_of(search: SearchArea | null, vehicles: readonly number[]): number[] {
  if (search?.state !== "flown") return [];
  return search.shares.filter(({ id, state }) => vehicles.includes(id) && (state === "flies" || state === "waits")).map(({ id }) => id);
}

/** What orders to these would end besides; empty: nothing. */
export function ends_search_text(search: SearchArea | null, vehicles: readonly number[]): string {
  const of = searching_of(search, vehicles);
  if (search === null || of.length === 0) return "";
  return `Hold, return and land end the search of ${of.length === 1 ? "vehicle" : "vehicles"} ${ids(of)}: ${searched_text(search)}`;
}
