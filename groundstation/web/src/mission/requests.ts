// SPDX-License-Identifier: Apache-2.0
// Requests for authorisation.

import type { Authorisation, Problem } from "../wire/protocol";

/** One request's own: a new plan for the same site is another request. */
export function request_key(request: Authorisation): string {
  return `${request.site}/${request.coalition}/${request.round}`;
}

/** Those that can be decided now, the one that runs out first in front. */
export function waiting_requests(all: readonly Authorisation[]): Authorisation[] {
  return all.filter((request) => request.waiting).sort((a, b) => a.decide_by_s - b.decide_by_s || a.site - b.site);
}

/** "2 of 3 deliveries": how many, of those that the site still wants. */
export function count_text(request: Authorisation): string {
  const asked = request.deliveries.length;
  const wanted = asked + request.missing.length;
  const noun = wanted === 1 ? "delivery" : "deliveries";
  return asked === wanted ? `${asked} ${noun}` : `${asked} of ${wanted} ${noun}`;
}

/** Whether something in it must be looked at before it is authorised. */
export function has_alarm(request: Authorisation): boolean {
  const alarms = (marks: readonly Problem[]) => marks.some((mark) => mark.level === "alarm");
  return request.missing.length > 0 || alarms(request.leader_marks) || request.deliveries.some((delivery) => alarms(delivery.marks));
}

export function outcome_of(request: Authorisation): string {
  if (request.decision) {
    const { granted, by } = request.decision;
    return `${granted ? "authorised" : "refused"} by ${by}`;
  }
  return request.waiting ? "waits" : "not decided in time, or no longer wanted";
}
