// SPDX-License-Identifier: Apache-2.0
// Sites, coalitions, what was decided, and who ordered what.

import { progress_of } from "../map/ground";
import { clock, ids } from "../shell/format";
import { highlighted_request, place_to_show } from "../shell/view";
import type { Site } from "../wire/protocol";
import { audit, authorisations, coalitions, sites } from "../wire/store";
import { CoalitionCard } from "./coalition_card";
import { outcome_of, request_key } from "./requests";

function show({ x, y }: Site): void {
  if (x !== null && y !== null) place_to_show.value = { x, y };
}

function Sites() {
  return (
    <section aria-labelledby="sites-title">
      <h2 id="sites-title">Sites</h2>
      {sites.value.length === 0 && <p class="empty">None is known yet.</p>}
      <ul class="rows" data-testid="sites">
        {sites.value.map((site) => (
          <li key={site.id} data-testid={`site-${site.id}`}>
            <button type="button" class="row-button" title="Show on the map" disabled={site.x === null} onClick={() => show(site)}>
              Site {site.id}
            </button>
            <span>{progress_of(site)}</span>
            <span class="muted">
              {site.leader !== null ? `led by ${site.leader}` : site.status === "found" || site.status === "surveyed" ? "no leader" : ""}
              {site.news && ` · ${site.news}`}
            </span>
          </li>
        ))}
      </ul>
    </section>
  );
}

function Coalitions() {
  const newest_first = [...coalitions.value].reverse();
  return (
    <section aria-labelledby="coalitions-title">
      <h2 id="coalitions-title">Coalitions</h2>
      {newest_first.length === 0 && <p class="empty">None has been announced yet.</p>}
      {newest_first.map((coalition, i) => (
        <CoalitionCard key={coalition.key} coalition={coalition} open={i === 0} />
      ))}
    </section>
  );
}

function Decided() {
  const newest_first = [...authorisations.value].reverse();
  if (newest_first.length === 0) return null;
  return (
    <section aria-labelledby="decided-title">
      <h2 id="decided-title">Authorisations</h2>
      <ul class="rows" data-testid="authorisations">
        {newest_first.map((request) => (
          <li
            key={request_key(request)}
            onMouseEnter={() => (highlighted_request.value = request_key(request))}
            onMouseLeave={() => (highlighted_request.value = null)}
          >
            <b>Site {request.site}</b>
            <span class={request.decision && !request.decision.granted ? "problem alarm" : ""}>{outcome_of(request)}</span>
            <span class="muted">
              {request.decision ? clock(request.decision.at_s, 1) : `asked ${clock(request.asked_s, 1)}`} · round {request.round} · vehicles {ids(request.deliveries.map((delivery) => delivery.vehicle))}
            </span>
          </li>
        ))}
      </ul>
    </section>
  );
}

function Audit() {
  const newest_first = [...audit.value].reverse();
  return (
    <section aria-labelledby="audit-title">
      <h2 id="audit-title">Orders and decisions</h2>
      {newest_first.length === 0 && <p class="empty">None has been given yet.</p>}
      <table class="audit" data-testid="audit">
        <tbody>
          {newest_first.map((entry) => (
            <tr key={entry.seq} data-testid={`audit-${entry.seq}`}>
              <td class="figure muted">{clock(entry.time_s, 1)}</td>
              <td class="muted">
                {entry.who}, {entry.from}
              </td>
              <td>
                <code>{entry.line}</code>
              </td>
              <td class={entry.done ? "" : "problem alarm"}>
                {entry.done ? "" : entry.in_part ? "in part: " : "not done: "}
                {entry.text}
              </td>
            </tr>
          ))}
        </tbody>
      </table>
    </section>
  );
}

export function MissionPanel() {
  return (
    <div class="scroll mission" tabIndex={0} role="region" aria-label="Mission">
      <Sites />
      <Coalitions />
      <Decided />
      <Audit />
    </div>
  );
}
