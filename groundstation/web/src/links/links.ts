// SPDX-License-Identifier: Apache-2.0
// Who hears whom, read for people: what a link is worth, and which are worst.

import { age, number } from "../shell/format";
import type { Link, LinkRow } from "../wire/protocol";

/** Older is no link any more. */
export const link_age_max_s = 5;
/** Of what was sent, lost: more than these is to be looked at, is bad. */
export const loss_some_percent = 5;
export const loss_bad_percent = 25;

export type LinkTone = "good" | "some" | "bad" | "through" | "heard" | "old";

export function tone_of(link: Link): LinkTone {
  if (link.age_s >= link_age_max_s) return "old";
  if (link.through_others) return "through";
  if (link.lost_percent === null) return "heard";
  if (link.lost_percent > loss_bad_percent) return "bad";
  return link.lost_percent > loss_some_percent ? "some" : "good";
}

/** In a cell, so that colour is not all. */
export function sign_of(link: Link): string {
  const tone = tone_of(link);
  if (tone === "old") return "×";
  if (tone === "through") return "↷";
  return link.lost_percent === null ? "·" : `${link.lost_percent}`;
}

export const name_of = (id: number): string => (id === 0 ? "ground station" : `vehicle ${id}`);
export const short_name = (id: number): string => (id === 0 ? "G" : `${id}`);

function figures_of(link: Link): string {
  const parts: string[] = [];
  if (link.through_others) parts.push("through others only");
  else if (link.lost_percent !== null) parts.push(`${link.lost_percent} % lost, ${number(link.per_s, 1)} a second`);
  else parts.push("loss is not told");
  if (link.bytes_per_s !== null) parts.push(`${number(link.bytes_per_s)} B/s`);
  parts.push(`${age(link.age_s)} ago`);
  return parts.join(", ");
}

/** What is known of one who hears another; `link` null: it does not hear it. */
export function sentence_of(row: LinkRow, whom: number, link: Link | null): string {
  const who = name_of(row.id);
  if (row.told_age_s === null) return `${who} has not told whom it hears`;
  const told = row.told_age_s >= link_age_max_s ? `; it told that ${age(row.told_age_s)} ago` : "";
  return link ? `${who} hears ${name_of(whom)}: ${figures_of(link)}${told}` : `${who} does not hear ${name_of(whom)}${told}`;
}

export interface Pair {
  row: LinkRow;
  link: Link;
}

const weight: Record<LinkTone, number> = { old: 0, through: 1, bad: 2, some: 3, heard: 4, good: 5 };

/** All links, the worst first. */
export function sorted_links(rows: readonly LinkRow[]): Pair[] {
  const all = rows.flatMap((row) => row.hears.map((link) => ({ row, link })));
  const rank = ({ link }: Pair) => weight[tone_of(link)];
  return all.sort((a, b) => rank(a) - rank(b) || (b.link.lost_percent ?? 0) - (a.link.lost_percent ?? 0) || a.row.id - b.row.id || a.link.id - b.link.id);
}

/** Whom the ground station hears through others alone. */
export function through_others(rows: readonly LinkRow[]): number[] {
  const ground = rows.find((row) => row.id === 0);
  return (ground?.hears ?? []).filter((link) => tone_of(link) === "through").map((link) => link.id);
}

export function summary_of(rows: readonly LinkRow[]): string {
  const count = (tone: LinkTone) => rows.reduce((sum, row) => sum + row.hears.filter((link) => tone_of(link) === tone).length, 0);
  const parts = [
    `${count("good")} good`,
    [count("some"), "lossy"],
    [count("bad"), "bad"],
    [count("through"), "through others"],
    [count("old"), "silent"],
    [count("heard"), "without figures"],
  ] as const;
  return parts.map((part) => (typeof part === "string" ? part : part[0] > 0 ? `${part[0]} ${part[1]}` : "")).filter(Boolean).join(", ");
}
