// SPDX-License-Identifier: Apache-2.0
// Releases, firmware, parameters and configurations of the whole team: who is not as the others are is
// seen at a glance, on the ground and in flight.

import { ids } from "../shell/format";
import { select, select_all, selection } from "../shell/view";
import type { Preflight, PreflightVehicle } from "../wire/protocol";
import { brief, digest_names, kinds_of, tile_of } from "./digests";
import type { DigestName } from "./digests";

const words: Record<DigestName, string> = { release: "Release", firmware: "Firmware", parameters: "Parameters", configuration: "Configuration" };
const letters: Record<DigestName, string> = { release: "R", firmware: "F", parameters: "P", configuration: "C" };

function Lines({ of }: { of: Preflight }) {
  return (
    <table class="kinds">
      <caption class="only-spoken">Who has which</caption>
      <tbody>
        {digest_names.map((name) => {
          const { kinds, unknown } = kinds_of(of.vehicles, name);
          return (
            <tr key={name} data-testid={`kinds-${name}`}>
              <th scope="row">{words[name]}</th>
              <td>
                {kinds.map((kind) => (
                  <button
                    key={`${kind.value} ${kind.odd}`}
                    type="button"
                    class={`kind${kind.odd ? " odd" : ""}`}
                    title={`${kind.value} on ${ids(kind.ids)}. A press selects them`}
                    aria-label={`${words[name]} ${kind.value}${kind.odd ? ", differs" : ""}: ${kind.ids.length}, select them`}
                    data-testid={kind.odd ? `odd-${name}` : undefined}
                    onClick={() => select_all(kind.ids)}
                  >
                    {kind.odd && "≠ "}
                    <b>{brief(kind.value)}</b> {kind.odd ? `on ${ids(kind.ids)}` : `× ${kind.ids.length}`}
                    {kind.old.length > 0 && <span class="muted"> ({kind.old.length} as last told)</span>}
                  </button>
                ))}
                {unknown.length > 0 && (
                  <button type="button" class="kind muted" title={ids(unknown)} onClick={() => select_all(unknown)}>
                    not told × {unknown.length}
                  </button>
                )}
              </td>
            </tr>
          );
        })}
      </tbody>
    </table>
  );
}

function Tile({ vehicle }: { vehicle: PreflightVehicle }) {
  const { odd, unknown } = tile_of(vehicle);
  const is_old = !vehicle.counts;
  const said = [
    odd.length > 0 && `differs in ${odd.map((name) => words[name].toLowerCase()).join(", ")}`,
    unknown.length > 0 && "has not told all",
    is_old && "as last told",
  ].filter(Boolean).join("; ");
  return (
    <button
      type="button"
      class={`tile${odd.length > 0 ? " odd" : ""}${is_old ? " old" : ""}${selection.value.has(vehicle.id) ? " selected" : ""}`}
      aria-label={`Vehicle ${vehicle.id}: ${said || "as the others"}`}
      aria-pressed={selection.value.has(vehicle.id)}
      title={said || "As the others"}
      data-testid={`tile-${vehicle.id}`}
      data-odd={odd.join(" ")}
      onClick={() => select(vehicle.id)}
    >
      {vehicle.id}
      <span class="tile-mark">{odd.length > 0 ? `≠${odd.map((name) => letters[name]).join("")}` : unknown.length > 0 ? "·" : "="}</span>
    </button>
  );
}

export function DigestGrid({ of }: { of: Preflight }) {
  const odd = of.vehicles.filter((vehicle) => vehicle.odd.length > 0);
  return (
    <div class="scroll digest-grid" tabIndex={0} role="region" aria-label="Releases, firmware, parameters and configurations" data-testid="digest-grid">
      <p class={odd.length > 0 ? "problem warning" : "muted"} role="status" data-testid="odd-summary">
        {odd.length === 0 ? "All that have told are alike." : `${odd.length} of ${of.vehicles.length} ${odd.length === 1 ? "is" : "are"} not as the others: ${ids(odd.map(({ id }) => id))}`}
      </p>
      <Lines of={of} />
      <div class="tiles" role="group" aria-label="Vehicles">
        {of.vehicles.map((vehicle) => (
          <Tile key={vehicle.id} vehicle={vehicle} />
        ))}
      </div>
      <p class="muted">≠ differs from most: R release, F firmware, P parameters, C configuration (firmware and parameters among those of its airframe). = as the others. · not told.</p>
    </div>
  );
}
