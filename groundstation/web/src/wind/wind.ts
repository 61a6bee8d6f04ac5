// SPDX-License-Identifier: Apache-2.0
// The wind in words.

import { age, bearing, number } from "../shell/format";
import type { Wind, WindFigures } from "../wire/protocol";

/** Older says nothing of now. */
export const wind_age_max_s = 30;

/** From 240°, 4.1 m/s, gusts 6.0 */
export function words_of_wind({ from_deg, speed_mps, gust_mps }: WindFigures): string {
  const from = from_deg === null ? "calm" : `from ${bearing(from_deg)}`;
  return `${from}, ${number(speed_mps, 1)} m/s, gusts ${number(gust_mps, 1)}`;
}

export function who_tells(wind: Wind): string {
  const count = wind.vehicles.length;
  const apart = count > 1 ? `, ${number(wind.spread_mps, 1)} m/s apart` : "";
  return `${count} ${count === 1 ? "plane tells" : "planes tell"}${apart}, ${age(wind.age_s)} old`;
}
