// SPDX-License-Identifier: Apache-2.0
// What is said aloud by a screen reader, and counted in the bar at the top.

import { fresh_of } from "../alarms/alarm_list";
import { request_key } from "../mission/requests";
import type { Picture } from "../wire/picture";

export interface AlarmCounts {
  alarms: number;
  warnings: number;
  heard: number;
  expected: number;
  waiting: number;
}

export function count_alarms(picture: Picture): AlarmCounts {
  const { alarm = 0, warning = 0 } = picture.alarms?.counts ?? {};
  const counts: AlarmCounts = { alarms: alarm, warnings: warning, heard: 0, expected: 0, waiting: 0 };
  for (const vehicle of picture.vehicles) {
    if (vehicle.expected) counts.expected++;
    if (vehicle.heard_age_s !== null && !vehicle.silent && !vehicle.stale) counts.heard++;
  }
  counts.waiting = picture.authorisations.filter((request) => request.waiting).length;
  return counts;
}

/** What has become wrong, or begun to wait for the operator, from one picture to the next. */
export function fresh_alarms(before: Picture, after: Picture): string[] {
  const fresh = fresh_of(before.alarms?.list ?? [], after.alarms?.list ?? []);
  const known = new Set(before.authorisations.map(request_key));
  for (const request of after.authorisations) {
    if (request.waiting && !known.has(request_key(request))) fresh.push(`Site ${request.site}: deliveries wait for your decision`);
  }
  return fresh;
}
