// SPDX-License-Identifier: Apache-2.0
// The aircraft that are not of the team, the nearest first; nothing while there are none.

import { signal } from "@preact/signals";
import { age, bearing, distance, number } from "../shell/format";
import { lost_for_s } from "../shell/connection";
import { place_to_show } from "../shell/view";
import type { TrafficAircraft } from "../wire/protocol";
import { traffic } from "../wire/store";
import { above_text, climb_sign, closest_text, is_old, name_of, standing_of, warned_text } from "./traffic";

const open = signal(false);
const signs = { too_near: "✕", given_way: "▲", near: "△", far: "" } as const;
const meanings = { too_near: "too near", given_way: "given way to", near: "will pass near", far: "" } as const;

function Row({ aircraft }: { aircraft: TrafficAircraft }) {
  const standing = standing_of(aircraft);
  const warned = warned_text(aircraft);
  const { nearest } = aircraft;
  return (
    <tr class={`traffic-row ${standing}${is_old(aircraft) ? " old" : ""}`} data-testid={`traffic-${aircraft.address}`} data-standing={standing}>
      <th scope="row">
        <button type="button" class="row-button" title="Show it on the map" onClick={() => (place_to_show.value = { x: aircraft.x, y: aircraft.y })}>
          <span class="traffic-sign" aria-hidden="true">
            {signs[standing]}
          </span>
          {name_of(aircraft)}
          {meanings[standing] && <span class="only-spoken">, {meanings[standing]}</span>}
        </button>
      </th>
      <td class="figure" title={aircraft.barometric ? "Its height is from pressure, as good as the pressure that was set" : "Over the nearest vehicle"}>
        {above_text(aircraft)}
        {climb_sign(aircraft)}
        {aircraft.barometric ? " p" : ""}
      </td>
      <td class="figure">{nearest ? `${distance(nearest.distance_m)} from ${nearest.vehicle}` : "–"}</td>
      <td class="figure">{closest_text(aircraft)}</td>
      <td class="figure">
        {bearing(aircraft.track_deg)} {number(aircraft.speed_mps)} m/s
      </td>
      <td class="figure">{age(aircraft.age_s)}</td>
      <td>{warned}</td>
    </tr>
  );
}

/** What is to be read without opening it: the one that matters most. */
function summary(all: readonly TrafficAircraft[]): string {
  const worst = all.find((one) => standing_of(one) === "too_near") ?? all.find((one) => standing_of(one) === "given_way") ?? all[0]!;
  const warned = warned_text(worst);
  return `${name_of(worst)} ${above_text(worst)}, ${warned || closest_text(worst)}`;
}

export function TrafficList() {
  const all = traffic.value;
  if (all.length === 0) return null;
  const alarm = all.some((one) => standing_of(one) === "too_near");
  const lost = lost_for_s() > 0;
  return (
    <section class={`traffic${lost ? " is-old" : ""}`} aria-label="Other aircraft" data-testid="traffic">
      <button type="button" class="traffic-head" aria-expanded={open.value} aria-controls={open.value ? "traffic-list" : undefined} data-testid="traffic-open" onClick={() => (open.value = !open.value)}>
        <b>{all.length} other aircraft</b>
        <span class={alarm ? "alarm-text" : ""} role="status" data-testid="traffic-summary">
          {lost ? "last: " : ""}
          {summary(all)}
        </span>
      </button>
      {open.value && (
        <div class="scroll traffic-scroll" id="traffic-list" tabIndex={0} role="region" aria-label="List of other aircraft">
          <table class="traffic-table">
            <thead>
              <tr>
                <th scope="col">Aircraft</th>
                <th scope="col" class="figure" title="Over the vehicle that is nearest; p: from pressure">
                  Height
                </th>
                <th scope="col" class="figure">
                  Nearest
                </th>
                <th scope="col" class="figure">
                  Closest
                </th>
                <th scope="col" class="figure">
                  Track
                </th>
                <th scope="col" class="figure">
                  Heard
                </th>
                <th scope="col">Warned</th>
              </tr>
            </thead>
            <tbody>
              {all.map((aircraft) => (
                <Row key={aircraft.address} aircraft={aircraft} />
              ))}
            </tbody>
          </table>
        </div>
      )}
    </section>
  );
}
