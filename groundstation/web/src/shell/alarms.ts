// SPDX-License-Identifier: Apache-2.0
// What is said aloud by a screen reader, and counted in the bar at the top.

import { health_of, problems_of } from "../fleet/attention";
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
  const counts: AlarmCounts = { alarms: 0, warnings: 0, heard: 0, expected: 0, waiting: 0 };
  for (const vehicle of picture.vehicles) {
    const health = health_of(vehicle);
    if (health === "alarm" || health === "silent") counts.alarms++;
    if (health === "warning") counts.warnings++;
    if (vehicle.expected) counts.expected++;
    if (vehicle.heard_age_s !== null && !vehicle.silent && !vehicle.stale) counts.heard++;
  }
  counts.waiting = picture.authorisations.filter((request) => request.waiting).length;
  return counts;
}

/** What has become wrong, or begun to wait for the operator, from one picture to the next. */
export function fresh_alarms(before: Picture, after: Picture): string[] {
  const said = new Set<string>();
  for (const vehicle of before.vehicles) for (const { level, text } of problems_of(vehicle)) if (level === "alarm") said.add(`${vehicle.id}:${kind_of(text)}`);
  const fresh: string[] = [];
  for (const vehicle of after.vehicles) {
    for (const { level, text } of problems_of(vehicle)) {
      if (level === "alarm" && !said.has(`${vehicle.id}:${kind_of(text)}`)) fresh.push(`Vehicle ${vehicle.id}: ${text}`);
    }
  }
  const known = new Set(before.authorisations.map(request_key));
  for (const request of after.authorisations) {
    if (request.waiting && !known.has(request_key(request))) fresh.push(`Site ${request.site}: deliveries wait for your decision`);
  }
  return fresh;
}

/** The problem without its figures, which change while it stays the same problem. */
function kind_of(text: string): string {
  return text.replace(/[\d.,−-]+/g, "#");
}
