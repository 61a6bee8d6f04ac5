// SPDX-License-Identifier: Apache-2.0
// The fleet: what needs attention, who does what, the list, and one vehicle's details.

import { selected, selection } from "../shell/view";
import { vehicles } from "../wire/store";
import { fleet_notes } from "./attention";
import { listed } from "./chosen";
import { FleetTable } from "./fleet_table";
import { FleetTools } from "./fleet_tools";
import { VehicleDetails } from "./vehicle_details";

export function FleetPanel() {
  const all = vehicles.value;
  const notes = fleet_notes(all);
  const chosen = selection.value.size === 1 ? all.find((vehicle) => vehicle.id === selected.value) : undefined;
  return (
    <div class="fleet" data-testid="fleet">
      {notes.length > 0 && (
        <ul class="fleet-notes" data-testid="fleet-notes">
          {notes.map((text) => (
            <li key={text}>{text}</li>
          ))}
        </ul>
      )}
      <FleetTools all={all} shown={listed.value.length} />
      <FleetTable list={listed.value} empty={all.length === 0 ? "No vehicle has been heard yet." : "None of the fleet is so: clear the filter to see all."} />
      {chosen && <VehicleDetails vehicle={chosen} />}
    </div>
  );
}
