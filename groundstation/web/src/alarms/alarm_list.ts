// SPDX-License-Identifier: Apache-2.0
// The standing list of alarms as the page shows it: the ground station's, and its own that it does
// not hear one.

import { duration } from "../shell/format";
import type { Alarm, GivenOrder, Order } from "../wire/protocol";

export type SoundLevel = "alarm" | "warning" | null;

export const own_number = 0;

/** The page's own: nobody else can tell of it. */
export function connection_alarm(lost_s: number, now_s: number, acknowledged: boolean): Alarm | null {
  if (lost_s <= 0) return null;
  return {
    number: own_number,
    key: "no_connection",
    kind: "no_connection",
    level: "alarm",
    since_s: now_s - lost_s,
    over_s: null,
    what: "This page has no connection to the ground station: nothing here is known to be so now",
    remedy: "look at the ground station and the network; its prompt and other pages may still work",
    closest_s: null,
    times: 1,
    vehicle: null,
    other: null,
    site: null,
    panel: "fleet",
    offers: [],
    acknowledged: acknowledged ? { by: "you", at_s: now_s } : null,
  };
}

export const is_open = (alarm: Alarm): boolean => alarm.acknowledged === null;
const stands = (alarm: Alarm): boolean => alarm.over_s === null;

/** What asks for the operator first: the list is sorted so. */
export function worst_of(list: readonly Alarm[]): Alarm | null {
  return list.find((alarm) => stands(alarm) && is_open(alarm)) ?? list[0] ?? null;
}

const rank = { alarm: 0, warning: 1, notice: 2 } as const;

/** What the bar shows: what was taken up stays there until it is acknowledged, so that nothing else comes
 *  under a hand that reaches for it; only what is worse takes its place. */
export function in_hand(list: readonly Alarm[], taken: number | null): Alarm | null {
  const worst = worst_of(list);
  const held = list.find((alarm) => alarm.number === taken && is_open(alarm));
  if (!held || !worst) return worst;
  const is_worse = stands(worst) && is_open(worst) && rank[worst.level] < rank[held.level];
  return is_worse ? worst : held;
}

/** What is to be heard: what stands, and nobody has acknowledged. */
export function sound_of(list: readonly Alarm[]): SoundLevel {
  const heard = list.filter((alarm) => stands(alarm) && is_open(alarm));
  if (heard.some(({ level }) => level === "alarm")) return "alarm";
  return heard.some(({ level }) => level === "warning") ? "warning" : null;
}

export interface Counts {
  alarm: number;
  warning: number;
  notice: number;
  /** That wait to be acknowledged, what is over included. */
  open: number;
}

export function counts_of(list: readonly Alarm[]): Counts {
  const counts: Counts = { alarm: 0, warning: 0, notice: 0, open: 0 };
  for (const alarm of list) {
    if (stands(alarm)) counts[alarm.level]++;
    if (is_open(alarm)) counts.open++;
  }
  return counts;
}

const plural = (count: number, word: string) => `${count} ${word}${count === 1 ? "" : "s"}`;

export function counts_text(counts: Counts): string {
  const parts = (["alarm", "warning", "notice"] as const).filter((level) => counts[level] > 0).map((level) => plural(counts[level], level));
  return parts.length > 0 ? parts.join(" · ") : "No alarms";
}

/** Of the window, which may be behind others. */
export function title_of(counts: Counts): string {
  if (counts.alarm + counts.warning === 0) return "Skein";
  return `${counts.alarm > 0 ? "!! " : "! "}${counts_text({ ...counts, notice: 0 })} – Skein`;
}

/** Newly there, as it is said aloud. */
export function fresh_of(before: readonly Alarm[], after: readonly Alarm[]): string[] {
  const known = new Set(before.map(({ number, key }) => `${number} ${key}`));
  return after.filter((alarm) => stands(alarm) && !known.has(`${alarm.number} ${alarm.key}`)).map(({ what, remedy }) => (remedy ? `${what}. ${remedy}` : what));
}

const is_to = (one: GivenOrder, vehicles: readonly number[]): boolean => one.vehicles?.length === vehicles.length && vehicles.every((id) => one.vehicles?.includes(id));

/** The newest order that may be what came of `order`. */
export function given_of(order: Order, given: readonly GivenOrder[], since_s: number): GivenOrder | null {
  const same = (one: GivenOrder) => {
    if (order.kind === "command") return one.kind === order.command && is_to(one, order.vehicle === 0 ? [] : [order.vehicle]);
    if (order.kind === "commands") return one.kind === order.command && is_to(one, order.vehicles);
    if (order.kind === "decision") return (order.grant ? one.kind === "authorise" : one.kind === "refuse" || one.kind === "take back") && one.site === order.site;
    return false;
  };
  return [...given].reverse().find((one) => one.given_s >= since_s && same(one)) ?? null;
}

/** Who has shown that he obeys, and how long that took. */
export function answers_text({ answered, waiting }: GivenOrder): string {
  const all = answered.length + waiting.length;
  if (all === 0) return "nobody in the air is asked";
  const slowest = answered.reduce<GivenOrder["answered"][number] | null>((most, one) => (most && most.after_s >= one.after_s ? most : one), null);
  const parts = [`${answered.length} of ${all} obey`];
  if (slowest) parts.push(all === 1 ? `after ${slowest.after_s.toFixed(1)} s` : `the last (${slowest.vehicle}) after ${slowest.after_s.toFixed(1)} s`);
  if (waiting.length > 0) parts.push(`not yet ${waiting.join(", ")}`);
  return parts.join("; ");
}

/** From now to when two are closest to each other, or since; empty of all else, and of what is over. */
export function closest_text({ closest_s, over_s }: Alarm, now_s: number | null): string {
  if (typeof closest_s !== "number" || over_s !== null || now_s === null) return "";
  const in_s = closest_s - now_s;
  return in_s > 0 ? `closest in ${Math.round(in_s)} s` : `was closest ${Math.round(-in_s)} s ago`;
}

/** How long it has been so, or was. */
export function lasted(alarm: Alarm, now_s: number | null): string {
  const until = alarm.over_s ?? now_s ?? alarm.since_s;
  return duration(Math.max(0, until - alarm.since_s));
}
