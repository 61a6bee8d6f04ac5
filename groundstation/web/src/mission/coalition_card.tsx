// SPDX-License-Identifier: Apache-2.0
// One coalition: what was announced, who bid, what was awarded, and why it failed where it did.

import { clock, distance, ids, number } from "../shell/format";
import { Badge } from "../theme/badge";
import { coalition_sign } from "../theme/palette";
import type { Coalition, Round } from "../wire/protocol";
import { shown } from "../wire/store";

function RoundTable({ round }: { round: Round }) {
  const awarded = new Map(round.award.map((award) => [award.vehicle, award]));
  const answers = new Map(round.answers.map((answer) => [answer.vehicle, answer]));
  const bidders = new Set(round.bids.map((bid) => bid.vehicle));
  const others = round.award.filter((award) => !bidders.has(award.vehicle));
  const outcome = (vehicle: number) => {
    const answer = answers.get(vehicle);
    if (!answer) return awarded.has(vehicle) ? "no answer yet" : "";
    return answer.accepted ? "accepted" : `refused: ${answer.why ?? "no reason given"}`;
  };
  const award_text = (vehicle: number) => {
    const award = awarded.get(vehicle);
    return award ? `${award.task}${award.time_s === null ? "" : ` at ${clock(award.time_s)}`}` : "–";
  };
  return (
    <section class="round">
      <h3>
        Round {round.number}
        <span class="muted">
          announced {clock(round.announced_s, 1)}
          {round.bids_until_s !== null && `, bids until ${clock(round.bids_until_s, 1)}`}
          {round.reward !== null && `, reward ${number(round.reward, 2)}`}
        </span>
      </h3>
      <p>
        <span class="muted">Tasks:</span> {round.tasks.join("; ") || "none"}
      </p>
      {(round.bids.length > 0 || others.length > 0) && (
        <table class="bids">
          <thead>
            <tr>
              <th scope="col">Bid of</th>
              <th scope="col" class="figure">There at</th>
              <th scope="col" class="figure">Range</th>
              <th scope="col" class="figure">Loads</th>
              <th scope="col">Awarded</th>
              <th scope="col">Answer</th>
            </tr>
          </thead>
          <tbody>
            {round.bids.map((bid) => (
              <tr key={bid.vehicle}>
                <td>{bid.vehicle}</td>
                <td class="figure">{clock(bid.eta_s, 1)}</td>
                <td class="figure">{distance(bid.range_left_m)}</td>
                <td class="figure">{number(bid.loads)}</td>
                <td>{award_text(bid.vehicle)}</td>
                <td class={answers.get(bid.vehicle)?.accepted === false ? "problem alarm" : ""}>{outcome(bid.vehicle)}</td>
              </tr>
            ))}
            {others.map((award) => (
              <tr key={award.vehicle}>
                <td>{award.vehicle}</td>
                <td colSpan={3} class="muted">
                  bid not heard
                </td>
                <td>{award_text(award.vehicle)}</td>
                <td>{outcome(award.vehicle)}</td>
              </tr>
            ))}
          </tbody>
        </table>
      )}
      {round.bids.length === 0 && round.award.length === 0 && <p class="muted">No bids were heard.</p>}
      {round.declined.length > 0 && (
        <p>
          <span class="muted">Did not bid:</span> {round.declined.map(({ vehicle, why }) => `${vehicle} (${why})`).join("; ")}
        </p>
      )}
      {round.cancelled && <p class="problem alarm">Cancelled: {round.cancelled}</p>}
    </section>
  );
}

export function CoalitionCard({ coalition, open }: { coalition: Coalition; open: boolean }) {
  const sign = coalition_sign(shown.value.coalition_slots.get(coalition.key) ?? 0);
  return (
    <details class={`coalition ${coalition.state}`} open={open} data-testid={`coalition-${coalition.key}`}>
      <summary>
        <Badge sign={sign} />
        <b>Site {coalition.site}</b>
        <span class={`state ${coalition.state}`}>{coalition.state}</span>
        <span class="muted">
          led by {coalition.leader}
          {coalition.members.length > 0 && `, members ${ids(coalition.members)}`}
          {coalition.lease_until_s !== null && `, leases to ${clock(coalition.lease_until_s)}`}
        </span>
        {coalition.why && <span class={`why${coalition.state === "failed" ? " problem alarm" : ""}`}>{coalition.why}</span>}
      </summary>
      {[...coalition.rounds].reverse().map((round) => (
        <RoundTable key={round.number} round={round} />
      ))}
    </details>
  );
}
