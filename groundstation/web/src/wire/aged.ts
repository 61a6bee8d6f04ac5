// SPDX-License-Identifier: Apache-2.0
// What a picture is worth that no news comes for.

import type { Picture } from "./picture";

/** The picture as it is `lost_s` after its newest state: every age has grown, nobody is known to be
 *  heard, and what could be decided until then cannot any more. */
export function aged(picture: Picture, lost_s: number): Picture {
  if (lost_s <= 0) return picture;
  const now_s = (picture.time_s ?? 0) + lost_s;
  return {
    ...picture,
    vehicles: picture.vehicles.map((vehicle) => ({
      ...vehicle,
      stale: true,
      heard_age_s: vehicle.heard_age_s === null ? null : vehicle.heard_age_s + lost_s,
      links: vehicle.links.map((link) => ({ ...link, age_s: link.age_s + lost_s })),
    })),
    links: picture.links.map((row) => ({
      ...row,
      told_age_s: row.told_age_s === null ? null : row.told_age_s + lost_s,
      hears: row.hears.map((link) => ({ ...link, age_s: link.age_s + lost_s })),
    })),
    wind: picture.wind && { ...picture.wind, age_s: picture.wind.age_s + lost_s },
    traffic: picture.traffic.map((aircraft) => ({ ...aircraft, age_s: aircraft.age_s + lost_s })),
    authorisations: picture.authorisations.map((request) => ({ ...request, waiting: request.waiting && now_s < request.decide_by_s })),
  };
}
