// SPDX-License-Identifier: Apache-2.0
// Requests for authorisation.

import type { Authorisation } from "../wire/protocol";

/** One request's own: a new plan for the same site is another request. */
export function request_key(request: Authorisation): string {
  return `${request.site}/${request.coalition}/${request.round}`;
}

/** Those that can be decided now, the one that runs out first in front. */
export function waiting_requests(all: readonly Authorisation[]): Authorisation[] {
  return all.filter((request) => request.waiting).sort((a, b) => a.decide_by_s - b.decide_by_s || a.site - b.site);
}

export function outcome_of(request: Authorisation): string {
  if (request.decision) {
    const { granted, by } = request.decision;
    return `${granted ? "authorised" : "refused"} by ${by}`;
  }
  return request.waiting ? "waits" : "not decided in time, or no longer wanted";
}
