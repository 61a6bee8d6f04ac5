// SPDX-License-Identifier: Apache-2.0
// The wind in a corner of the map: an arrow with it, and its figures.

import { wind } from "../wire/store";
import { who_tells, wind_age_max_s, words_of_wind } from "./wind";

export function WindBadge() {
  const now = wind.value;
  if (!now) return null;
  const old = now.age_s > wind_age_max_s;
  return (
    <div class={`wind-badge${old ? " old" : ""}`} data-testid="wind">
      <svg viewBox="-12 -12 24 24" width="26" height="26" aria-hidden="true">
        {now.from_deg === null ? (
          <circle r="5" class="wind-calm" />
        ) : (
          <path class="wind-arrow" d="M0 10 5 -4 1.2 -4 1.2 -11 -1.2 -11 -1.2 -4 -5 -4Z" transform={`rotate(${now.from_deg})`} />
        )}
      </svg>
      <span>
        <b data-testid="wind-figures">Wind {words_of_wind(now)}</b>
        <small data-testid="wind-tellers">{who_tells(now)}</small>
      </span>
    </div>
  );
}
