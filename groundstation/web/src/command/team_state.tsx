// SPDX-License-Identifier: Apache-2.0
// The team's state as a whole, what it means and what there is to do.

import { signal } from "@preact/signals";
import type { TeamRow } from "../wire/protocol";
import { lost_s, team } from "../wire/store";
import "./command.css";

const is_open = signal(false);

export function TeamMark() {
  const rows = team.value;
  const first = rows[0];
  if (!first) return null;
  const is_old = lost_s.value > 0;
  return (
    <button
      type="button"
      class={`count team-mark ${is_old ? "" : first.level}`}
      data-testid="team-state"
      data-state={is_old ? "" : first.state}
      aria-expanded={is_open.value}
      aria-controls="team-rows"
      title="The team's state, what it means and what to do"
      onClick={() => (is_open.value = !is_open.value)}
    >
      Team: <b>{is_old ? "–" : first.title}</b>
      {!is_old && rows.length > 1 && ` +${rows.length - 1}`}
    </button>
  );
}

const ids_shown = 12;

/** "3, 5 and 7 more" */
export function ids_text(ids: number[]): string {
  const more = ids.length - ids_shown;
  return ids.slice(0, ids_shown).join(", ") + (more > 0 ? ` and ${more} more` : "");
}

function Row({ row }: { row: TeamRow }) {
  return (
    <li class={row.level} data-testid={`team-${row.state}`}>
      <b>
        {row.title}
        {row.vehicles.length > 0 && `: ${ids_text(row.vehicles)}`}
      </b>{" "}
      {row.means} {row.to_do && <em>{row.to_do}</em>}
    </li>
  );
}

/** All of it where it is asked for. */
export function TeamBanner() {
  if (!is_open.value || lost_s.value > 0 || team.value.length === 0) return null;
  return (
    <div class="banner team-rows" id="team-rows" role="status" data-testid="team-rows">
      <ul>
        {team.value.map((row) => (
          <Row key={row.state} row={row} />
        ))}
      </ul>
    </div>
  );
}
