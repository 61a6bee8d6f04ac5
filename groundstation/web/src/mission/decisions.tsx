// SPDX-License-Identifier: Apache-2.0
// Deliveries that wait for the operator: above every panel, since the time to decide runs out.

import { bearing, clock, duration, from_origin, latitude_longitude } from "../shell/format";
import { give } from "../shell/give";
import { HoldButton } from "../shell/hold_button";
import { tick } from "../shell/ticker";
import { highlighted_request, place_to_show } from "../shell/view";
import type { Authorisation, Problem } from "../wire/protocol";
import { authorisations, lost_s, may_order, mission_now_s } from "../wire/store";
import { distance_and_bearing } from "../map/geodesy";
import { Authorise } from "./authorise";
import { Granted } from "./granted";
import { count_text, granted_requests, has_alarm, request_key, waiting_requests } from "./requests";

function Countdown({ request }: { request: Authorisation }) {
  void tick.value;
  const now = mission_now_s() ?? request.asked_s;
  const left = Math.max(0, request.decide_by_s - now);
  const whole = Math.max(1, request.decide_by_s - request.asked_s);
  return (
    <div class="countdown">
      <progress max={whole} value={Math.min(left, whole)} aria-label="Time left to decide" />
      <span class={left < 5 ? "urgent" : ""} data-testid={`countdown-${request.site}`}>
        {duration(left)}
      </span>
    </div>
  );
}

function Marks({ marks }: { marks: readonly Problem[] }) {
  return (
    <>
      {marks.map(({ level, text }) => (
        <span key={text} class={`problem ${level}`}>
          {text}
        </span>
      ))}
    </>
  );
}

/** Why vehicles did not bid, and what is another than in the request before. */
function Reasons({ request }: { request: Authorisation }) {
  const { did_not_bid, changes, site } = request;
  return (
    <>
      {did_not_bid.length > 0 && (
        <p data-testid={`did-not-bid-${site}`}>
          <span class="muted">Did not bid:</span> {did_not_bid.map(({ vehicle, why }) => `${vehicle} (${why})`).join("; ")}
        </p>
      )}
      {changes.length > 0 && (
        <p data-testid={`changes-${site}`}>
          <span class="muted">Changed:</span> {changes.join("; ")}
        </p>
      )}
    </>
  );
}

function Request({ request }: { request: Authorisation }) {
  const { site, coalition, round } = request;
  const plan = { kind: "decision", site, coalition, round } as const;
  const where = distance_and_bearing({ x: 0, y: 0 }, request);
  const key = request_key(request);
  const point_out = (on: boolean) => (highlighted_request.value = on ? key : null);
  return (
    <article class={`request${has_alarm(request) ? " has-alarm" : ""}`} data-testid={`request-${request.site}`} onMouseEnter={() => point_out(true)} onMouseLeave={() => point_out(false)}>
      <header>
        <h2>
          Site {request.site}: {count_text(request)} to authorise
        </h2>
        <Countdown request={request} />
        <button type="button" class="quiet" data-testid={`show-${request.site}`} onClick={() => (place_to_show.value = { x: request.x, y: request.y })}>
          Show
        </button>
      </header>
      <p class="muted">
        {from_origin(where.distance_m, where.bearing_deg)} · {latitude_longitude(request.latitude_deg, request.longitude_deg)} · led by {request.leader}, round{" "}
        {request.round} <Marks marks={request.leader_marks} />
      </p>
      <table class="deliveries">
        <thead>
          <tr>
            <th scope="col">Vehicle</th>
            <th scope="col">Flies towards</th>
            <th scope="col" class="figure">At</th>
            <th scope="col">Look at</th>
          </tr>
        </thead>
        <tbody>
          {request.deliveries.map((delivery) => (
            <tr key={delivery.index}>
              <td>{delivery.vehicle}</td>
              <td>{bearing(delivery.bearing_deg)}</td>
              <td class="figure">{clock(delivery.time_s, 1)}</td>
              <td>
                <Marks marks={delivery.marks} />
              </td>
            </tr>
          ))}
          {request.missing.map((missing) => (
            <tr key={`missing ${missing.index}`} class="missing" data-testid={`missing-${request.site}-${missing.index}`}>
              <td>nobody</td>
              <td>{bearing(missing.bearing_deg)}</td>
              <td class="figure">–</td>
              <td>
                <span class="problem alarm">missing: {missing.why}</span>
              </td>
            </tr>
          ))}
        </tbody>
      </table>
      <Reasons request={request} />
      {may_order.value && lost_s.value > 0 && <p class="problem alarm">It cannot be decided here: there is no connection.</p>}
      {may_order.value && lost_s.value === 0 && (
        <div class="button-row">
          <Authorise request={request} />
          <HoldButton kind="stop" testid={`refuse-${request.site}`} on_held={() => void give({ ...plan, grant: false })}>
            Refuse
          </HoldButton>
        </div>
      )}
    </article>
  );
}

export function Decisions() {
  const waiting = waiting_requests(authorisations.value);
  const granted = granted_requests(authorisations.value);
  if (waiting.length === 0 && granted.length === 0) return null;
  return (
    <section class="decisions" aria-label="Waiting for your decision, or authorised and not begun" data-testid="decisions">
      {waiting.map((request) => (
        // By its key: a press that has begun on one plan must not end on another.
        <Request key={request_key(request)} request={request} />
      ))}
      {granted.map((request) => (
        <Granted key={request_key(request)} request={request} />
      ))}
    </section>
  );
}
