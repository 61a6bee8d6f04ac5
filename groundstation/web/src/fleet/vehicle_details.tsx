// SPDX-License-Identifier: Apache-2.0
// One vehicle: its figures, and the orders to it alone.

import { EndsSearch } from "../areas/ends_search";
import { bearing, distance, ids, number } from "../shell/format";
import { command } from "../orders/orders";
import { give } from "../shell/give";
import { HoldButton } from "../shell/hold_button";
import { follow, select } from "../shell/view";
import type { Vehicle } from "../wire/protocol";
import { words_of_wind } from "../wind/wind";
import { hello, may_order, wind } from "../wire/store";
import { state_text } from "./texts";

function Orders({ vehicle }: { vehicle: Vehicle }) {
  const { id } = vehicle;
  return (
    <div class="button-row" role="group" aria-label={`Orders to vehicle ${id}`}>
      <button type="button" class="stop" data-testid="vehicle-hold" onClick={() => void give(command("hold", id))}>
        Hold
      </button>
      <HoldButton testid="vehicle-resume" on_held={() => void give(command("resume", id))}>
        Resume
      </HoldButton>
      <HoldButton testid="vehicle-return" on_held={() => void give(command("return_home", id))}>
        Return
      </HoldButton>
      <HoldButton testid="vehicle-land" on_held={() => void give(command("land", id))}>
        Land
      </HoldButton>
      {vehicle.flight_controller !== null && (
        <HoldButton testid="vehicle-give-back" on_held={() => void give(command("give_back", id))}>
          Give back
        </HoldButton>
      )}
    </div>
  );
}

export function VehicleDetails({ vehicle }: { vehicle: Vehicle }) {
  const rows: [string, string][] = [
    ["Place", vehicle.x === null ? "–" : `E ${number(vehicle.x)} N ${number(vehicle.y)} m`],
    ["Height", distance(vehicle.z)],
    ["Heading, course", `${bearing(vehicle.heading_deg)}, ${bearing(vehicle.course_deg)}`],
    ["Ground, air speed", `${number(vehicle.groundspeed, 1)}, ${number(vehicle.airspeed, 1)} m/s`],
    ["Flight controller", [vehicle.flight_controller, vehicle.mode].filter(Boolean).join(", ") || "–"],
    ["Version, clock", `${vehicle.version ?? "–"}, ${number(vehicle.clock_offset_ms)} ms`],
    ["Hears", ids(vehicle.links.map((link) => link.id)) || "nobody"],
    ["Plan", number(vehicle.plan_number)],
    ["Overruns, dropped", `${number(vehicle.control_overruns)}, ${number(vehicle.messages_dropped)}`],
  ];
  const blows = wind.value?.vehicles.find(({ id }) => id === vehicle.id);
  if (blows) rows.splice(4, 0, ["Wind that it has", words_of_wind(blows)]);
  const video = hello.value?.videos?.find((one) => one.vehicle === vehicle.id);
  return (
    <section class="details" aria-label={`Vehicle ${vehicle.id}`} data-testid="vehicle-details">
      <header>
        <h2>Vehicle {vehicle.id}</h2>
        <span class="muted">{state_text(vehicle)}</span>
        <span class="grow" />
        <button type="button" class="quiet" aria-pressed={follow.value} onClick={() => (follow.value = !follow.value)}>
          Follow
        </button>
        <button type="button" class="quiet" aria-label="Close" onClick={() => select(null)}>
          ✕
        </button>
      </header>
      {may_order.value && <Orders vehicle={vehicle} />}
      {may_order.value && <EndsSearch vehicles={[vehicle.id]} />}
      <dl class="figures">
        {rows.map(([name, value]) => (
          <div key={name}>
            <dt>{name}</dt>
            <dd>{value}</dd>
          </div>
        ))}
        {video && (
          <div>
            <dt>Video</dt>
            <dd>
              <a href={video.url} target="_blank" rel="noopener noreferrer" data-testid="vehicle-video">
                {video.url}
              </a>
            </dd>
          </div>
        )}
      </dl>
    </section>
  );
}
