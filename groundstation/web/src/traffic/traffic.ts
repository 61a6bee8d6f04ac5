// SPDX-License-Identifier: Apache-2.0
// What people read of aircraft that are not of the team.

import { distance, number } from "../shell/format";
import type { TrafficAircraft } from "../wire/protocol";

export const name_of = (aircraft: TrafficAircraft) => aircraft.callsign || aircraft.address;

/** Older, its place is a guess. */
const old_s = 10;

export type Standing = "too_near" | "given_way" | "near" | "far";

/** Whether somebody is in danger of it, gives way to it, or it passes within a few hundred metres. */
export function standing_of(aircraft: TrafficAircraft): Standing {
  if (aircraft.warned.some(({ gives_way }) => !gives_way)) return "too_near";
  if (aircraft.warned.length > 0) return "given_way";
  const { nearest } = aircraft;
  const passes = nearest !== null && nearest.closest_in_s < 90 && nearest.closest_m < 1000 && Math.abs(nearest.above_m) < 300;
  return passes && !aircraft.on_ground ? "near" : "far";
}

export const is_old = (aircraft: TrafficAircraft) => aircraft.age_s > old_s;

/** Over the nearest vehicle: +120 m, −30 m. */
export function above_text(aircraft: TrafficAircraft): string {
  if (aircraft.on_ground) return "on the ground";
  if (!aircraft.nearest) return `${number(aircraft.z)} m`;
  const above_m = Math.round(aircraft.nearest.above_m);
  return `${above_m > 0 ? "+" : ""}${number(above_m)} m`;
}

const climbs_mps = 1;
/** What its height does: climbing, descending, level. */
export function climb_sign(aircraft: TrafficAircraft): "↑" | "↓" | "" {
  if (Math.abs(aircraft.climb_mps) < climbs_mps) return "";
  return aircraft.climb_mps > 0 ? "↑" : "↓";
}

export function closest_text(aircraft: TrafficAircraft): string {
  const { nearest } = aircraft;
  if (!nearest) return "–";
  if (nearest.closest_in_s < 1) return "moving away";
  return nearest.closest_in_s > 600 ? "later" : `${distance(nearest.closest_m)} in ${number(nearest.closest_in_s)} s`;
}

/** Who is warned of it; empty: nobody. */
export function warned_text(aircraft: TrafficAircraft): string {
  const who = (gives_way: boolean) => aircraft.warned.filter((one) => one.gives_way === gives_way).map(({ vehicle }) => vehicle);
  const yields = who(true);
  const cannot = who(false);
  const of = (list: number[]) => `${list.length > 1 ? "vehicles" : "vehicle"} ${list.join(", ")}`;
  return [
    ...(cannot.length > 0 ? [`${of(cannot)} ${cannot.length > 1 ? "do" : "does"} not give way`] : []),
    ...(yields.length > 0 ? [`${of(yields)} ${yields.length > 1 ? "give" : "gives"} way`] : []),
  ].join("; ");
}
