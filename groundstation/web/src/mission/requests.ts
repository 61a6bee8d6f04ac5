// SPDX-License-Identifier: Apache-2.0
// Requests for authorisation.

import type { Authorisation, Delivery, Problem } from "../wire/protocol";

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

/** Those of which something can be taken back, the one that is flown first in front. */
export function granted_requests(all: readonly Authorisation[]): Authorisation[] {
  const first_s = (request: Authorisation) => Math.min(...before_gate(request).map((delivery) => delivery.time_s));
  return all.filter((request) => request.can_take_back).sort((a, b) => first_s(a) - first_s(b) || a.site - b.site);
}

export const before_gate = (request: Authorisation): Delivery[] => request.deliveries.filter((delivery) => delivery.before_gate);

/** "vehicle 3 is silent", "vehicles 3, 4 are silent"; empty: all that it names are heard. */
export function silence_text(request: Authorisation): string {
  const { silent } = request;
  if (silent.length === 0) return "";
  return `${silent.length === 1 ? "vehicle" : "vehicles"} ${silent.join(", ")} ${silent.length === 1 ? "is" : "are"} silent`;
}

export function outcome_of(request: Authorisation): string {
  if (request.decision) {
    const { granted, taken_back, by } = request.decision;
    return `${granted ? "authorised" : taken_back ? "taken back" : "refused"} by ${by}`;
  }
  return request.waiting ? "waits" : "not decided in time, or no longer wanted";
}
