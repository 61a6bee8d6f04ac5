// SPDX-License-Identifier: Apache-2.0
// Who is ready before the flight: vehicles by what their checks are about, and each one's lines with
// what to do.

import { signal } from "@preact/signals";
import { lost_for_s } from "../shell/connection";
import { age } from "../shell/format";
import type { Preflight, PreflightVehicle } from "../wire/protocol";
import { preflight, shown, since_state_s } from "../wire/store";
import { DigestGrid } from "./digest_grid";
import { brief } from "./digests";
import { shown_mark, shown_vehicle, told_age_s } from "./marks";

const opened = signal<ReadonlySet<number>>(new Set());

/** What is asked of the team: whether it is ready, or whether it is of one kind. */
const face = signal<"checks" | "versions">("checks");

function toggle(id: number): void {
  const next = new Set(opened.value);
  if (!next.delete(id)) next.add(id);
  opened.value = next;
}

const digests = [
  ["release", "Release", "Of its program"],
  ["firmware", "Firmware", "Of its autopilot"],
  ["parameters", "Param.", "A digest of the autopilot's parameters that are looked at"],
  ["configuration", "Config.", "A digest of what the team has in common"],
] as const;

function Lines({ vehicle, columns }: { vehicle: PreflightVehicle; columns: number }) {
  const heard = vehicle.counts;
  return (
    <tr class="preflight-lines">
      <td colSpan={columns}>
        <div class="lines-sheet" id={`preflight-lines-${vehicle.id}`} data-testid={`preflight-lines-${vehicle.id}`}>
          {vehicle.why && (
            <p>
              <b>{shown_vehicle(vehicle, true).label}</b>
            </p>
          )}
          {!heard && vehicle.told_s !== null && <p class="muted">What follows is as it was told last.</p>}
          <ul>
            {vehicle.lines.map((line, i) => (
              <li key={i}>
                <b class={heard ? `problem ${line.verdict === "fail" ? "alarm" : "warning"}` : "muted"}>
                  {line.verdict === "fail" ? "FAIL" : "warn"} {line.what}:
                </b>{" "}
                {line.found}
                {line.remedy && <span class="remedy"> {line.remedy}</span>}
              </li>
            ))}
          </ul>
          {vehicle.lines.length === 0 && <p class="muted">{vehicle.told_s === null ? "It has told nothing yet." : "It has named nothing that is not ok."}</p>}
          {vehicle.lines_left_out > 0 && <p class="muted">And {vehicle.lines_left_out} more, which skein-onboard check there has.</p>}
        </div>
      </td>
    </tr>
  );
}

function Row({ vehicle, groups, connected, lost_s }: { vehicle: PreflightVehicle; groups: string[]; connected: boolean; lost_s: number }) {
  const open = opened.value.has(vehicle.id);
  const whole = shown_vehicle(vehicle, connected);
  const heard = vehicle.counts && connected;
  const told_s = told_age_s(vehicle, shown.value.time_s, connected ? since_state_s() : lost_s);
  return (
    <>
      <tr class={`vehicle${heard ? "" : " old"}`} data-testid={`preflight-${vehicle.id}`} data-readiness={connected ? vehicle.readiness : "not_known"} onClick={() => toggle(vehicle.id)}>
        <th scope="row">
          <button type="button" class="row-button" aria-expanded={open} aria-controls={open ? `preflight-lines-${vehicle.id}` : undefined} aria-label={`Vehicle ${vehicle.id}, ${whole.label}`}>
            <span class={`mark ${whole.tone}`} aria-hidden="true">
              {whole.sign}
            </span>
            {vehicle.id}
          </button>
        </th>
        <td class="figure">{age(told_s)}</td>
        {vehicle.marks.map((mark, i) => {
          const { sign, tone, label } = shown_mark(mark, heard);
          return (
            <td key={i} class={`mark ${tone}`} title={`${groups[i]}: ${label}`} data-mark={tone}>
              <span aria-hidden="true">{sign}</span>
              <span class="only-spoken">{label}</span>
            </td>
          );
        })}
        {digests.map(([name]) => {
          const odd = vehicle.odd.includes(name);
          return (
            <td key={name} class={odd && heard ? "digest odd" : "digest"} title={`${vehicle[name] ?? "Not known"}${odd ? ": others of the team have another one" : ""}`} data-testid={`preflight-${vehicle.id}-${name}`}>
              {odd && <span aria-hidden="true">≠ </span>}
              {odd && <span class="only-spoken">differs: </span>}
              {brief(vehicle[name]) ?? "–"}
            </td>
          );
        })}
      </tr>
      {open && <Lines vehicle={vehicle} columns={2 + groups.length + digests.length} />}
    </>
  );
}

function Table({ of, connected, lost_s }: { of: Preflight; connected: boolean; lost_s: number }) {
  return (
    <table class="preflight-table">
      <caption class="only-spoken">What the vehicles' checks find, by what they are about</caption>
      <thead>
        <tr>
          <th scope="col" class="col-id">
            Id
          </th>
          <th scope="col" class="figure col-told" title="Since it has told what its checks find">
            Told
          </th>
          {of.groups.map((group) => (
            <th key={group} scope="col" class="group">
              <span>{group}</span>
            </th>
          ))}
          {digests.map(([name, title, what]) => (
            <th key={name} scope="col" class="col-digest" title={what}>
              {title}
            </th>
          ))}
        </tr>
      </thead>
      <tbody>
        {of.vehicles.map((vehicle) => (
          <Row key={vehicle.id} vehicle={vehicle} groups={of.groups} connected={connected} lost_s={lost_s} />
        ))}
      </tbody>
    </table>
  );
}

export function PreflightPanel() {
  const of = preflight.value;
  const lost_s = lost_for_s();
  const connected = lost_s === 0;
  const odd = of?.vehicles.filter((vehicle) => vehicle.odd.length > 0).length ?? 0;
  if (!of) return <p class="empty">Nothing has been told yet.</p>;
  return (
    <div class="preflight" data-testid="preflight">
      <p class={`preflight-summary${connected ? "" : " old"}`} role="status" data-testid="preflight-summary">
        {connected ? of.summary : `Not known now; last: ${of.summary}`}
      </p>
      <div class="preflight-faces" role="group" aria-label="What is shown">
        <button type="button" class="quiet" aria-pressed={face.value === "checks"} data-testid="preflight-checks" onClick={() => (face.value = "checks")}>
          Checks
        </button>
        <button type="button" class="quiet" aria-pressed={face.value === "versions"} data-testid="preflight-versions" onClick={() => (face.value = "versions")}>
          Versions and digests
          {odd > 0 && <span class="tab-count">{odd} ≠</span>}
        </button>
      </div>
      {face.value === "versions" ? (
        <DigestGrid of={of} />
      ) : (
        <div class="scroll" tabIndex={0} role="region" aria-label="Checks of the vehicles">
          <Table of={of} connected={connected} lost_s={lost_s} />
          {of.vehicles.length === 0 && <p class="empty">No vehicle has been heard yet.</p>}
        </div>
      )}
    </div>
  );
}
