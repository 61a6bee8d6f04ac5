// SPDX-License-Identifier: Apache-2.0
// The fleet as a table, what needs attention first.

import { age, clock, distance, number, words } from "../shell/format";
import { select, selected } from "../shell/view";
import { coalition_sign } from "../theme/palette";
import { Badge } from "../theme/badge";
import type { Vehicle } from "../wire/protocol";
import { coalitions, shown, vehicles } from "../wire/store";
import { by_attention, fleet_notes, health_of, odd_versions, problems_of } from "./attention";
import type { Health } from "./attention";
import { VehicleDetails } from "./vehicle_details";

const columns = ["id", "state", "task", "heard", "range", "loads", "mode", "version", "clock"] as const;
const health_marks: Record<Health, string> = { alarm: "!", silent: "?", warning: "▲", unheard: "○", stale: "◌", well: "●" };

export function task_text(vehicle: Vehicle): string {
  const { task } = vehicle;
  if (!task) return "–";
  const what = `S${task.site} ${words(task.kind)}${task.kind === "survey" ? "" : ` ${task.index + 1}`}`;
  return task.time_s === null ? what : `${what} ${clock(task.time_s)}`;
}

function coalition_of(id: number) {
  const { coalition_slots } = shown.value;
  for (let i = coalitions.value.length - 1; i >= 0; --i) {
    const one = coalitions.value[i]!;
    if (one.state === "failed" || one.state === "closed") continue;
    if (one.leader === id || one.members.includes(id)) return coalition_sign(coalition_slots.get(one.key) ?? 0);
  }
  return null;
}

function Row({ vehicle, odd }: { vehicle: Vehicle; odd: ReadonlySet<string> }) {
  const health = health_of(vehicle);
  const problems = problems_of(vehicle);
  const sign = coalition_of(vehicle.id);
  const is_selected = selected.value === vehicle.id;
  return (
    <>
      <tr
        class={`vehicle ${health}${is_selected ? " selected" : ""}`}
        data-testid={`vehicle-${vehicle.id}`}
        data-health={health}
        onClick={() => select(is_selected ? null : vehicle.id)}
      >
        <th scope="row">
          <button type="button" class="row-button" aria-pressed={is_selected} aria-label={`Vehicle ${vehicle.id}, ${health}`}>
            <span class={`health ${health}`} aria-hidden="true">
              {health_marks[health]}
            </span>
            {vehicle.id}
          </button>
        </th>
        <td>
          {words(vehicle.state)}
          {sign && <Badge sign={sign} />}
        </td>
        <td class="task">{task_text(vehicle)}</td>
        <td class="figure">{age(vehicle.heard_age_s)}</td>
        <td class="figure">{distance(vehicle.range_left_m)}</td>
        <td class="figure">{number(vehicle.loads)}</td>
        <td>{vehicle.mode ?? "–"}</td>
        <td class={`figure${vehicle.version && odd.has(vehicle.version) ? " odd" : ""}`}>{vehicle.version ?? "–"}</td>
        <td class="figure">{vehicle.clock_offset_ms === null ? "–" : `${number(vehicle.clock_offset_ms)} ms`}</td>
      </tr>
      {problems.length > 0 && (
        <tr class={`problems${is_selected ? " selected" : ""}`}>
          <td />
          <td colSpan={8} data-testid={`problems-${vehicle.id}`}>
            {problems.map((problem, i) => (
              <span key={i} class={`problem ${problem.level}`}>
                {problem.text}
              </span>
            ))}
          </td>
        </tr>
      )}
    </>
  );
}

export function FleetPanel() {
  const list = by_attention(vehicles.value);
  const odd = odd_versions(list);
  const notes = fleet_notes(list);
  const chosen = list.find((vehicle) => vehicle.id === selected.value);
  return (
    <div class="fleet" data-testid="fleet">
      {notes.length > 0 && (
        <ul class="fleet-notes" data-testid="fleet-notes">
          {notes.map((text) => (
            <li key={text}>{text}</li>
          ))}
        </ul>
      )}
      <div class="scroll" tabIndex={0} role="region" aria-label="Vehicles">
        <table class="fleet-table">
          <caption class="only-spoken">Vehicles, those that need attention first</caption>
          <colgroup>
            {columns.map((name) => (
              <col key={name} class={`col-${name}`} />
            ))}
          </colgroup>
          <thead>
            <tr>
              <th scope="col">Id</th>
              <th scope="col">State</th>
              <th scope="col">Task</th>
              <th scope="col" class="figure">Heard</th>
              <th scope="col" class="figure">Range</th>
              <th scope="col" class="figure" title="Loads left">Loads</th>
              <th scope="col" title="Mode of the flight controller">Mode</th>
              <th scope="col" class="figure">Version</th>
              <th scope="col" class="figure" title="Its clock against ours, link included">Clock</th>
            </tr>
          </thead>
          <tbody>
            {list.map((vehicle) => (
              <Row key={vehicle.id} vehicle={vehicle} odd={odd} />
            ))}
          </tbody>
        </table>
        {list.length === 0 && <p class="empty">No vehicle has been heard yet.</p>}
      </div>
      {chosen && <VehicleDetails vehicle={chosen} />}
    </div>
  );
}
