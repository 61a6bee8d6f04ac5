// SPDX-License-Identifier: Apache-2.0
// What is authorised and has not begun: it can be taken back, at once.

import { clock, ids } from "../shell/format";
import { give } from "../shell/give";
import { highlighted_request } from "../shell/view";
import type { Authorisation } from "../wire/protocol";
import { lost_s, may_order } from "../wire/store";
import { before_gate, request_key } from "./requests";

export function Granted({ request }: { request: Authorisation }) {
  const { site, decision } = request;
  const left = before_gate(request);
  const begun = request.deliveries.filter((delivery) => !delivery.before_gate);
  const first_s = Math.min(...left.map((delivery) => delivery.time_s));
  return (
    <article
      class="request granted"
      data-testid={`granted-${site}`}
      onMouseEnter={() => (highlighted_request.value = request_key(request))}
      onMouseLeave={() => (highlighted_request.value = null)}
    >
      <p>
        <b>Site {site}</b>: authorised by {decision?.by}; before {left.length === 1 ? "its gate" : "their gates"}: {ids(left.map((delivery) => delivery.vehicle))}, the first over the
        site at {clock(first_s, 1)}
        {begun.length > 0 && <>; flown to the end: {ids(begun.map((delivery) => delivery.vehicle))}</>}
      </p>
      {may_order.value && lost_s.value === 0 && (
        <button type="button" class="stop tall" data-testid={`take-back-${site}`} onClick={() => void give({ kind: "withdraw", decision: site })}>
          Take back
        </button>
      )}
    </article>
  );
}
