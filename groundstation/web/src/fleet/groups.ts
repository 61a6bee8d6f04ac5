// SPDX-License-Identifier: Apache-2.0
// Named groups of vehicles: those of the ground station's configuration, and the operator's own.

import { ids } from "../shell/format";

export interface Group {
  name: string;
  vehicles: number[];
  /** Of this operator, in this browser; else of the configuration. */
  own: boolean;
}

export const name_max = 24;
const own_max = 100;

/** What the browser has kept; whatever is not as it should be is left out. */
export function read_groups(text: string | null): Group[] {
  let kept: unknown;
  try {
    kept = JSON.parse(text ?? "[]");
  } catch {
    return [];
  }
  if (!Array.isArray(kept)) return [];
  const groups: Group[] = [];
  for (const one of kept.slice(0, own_max) as unknown[]) {
    const { name, vehicles } = (one ?? {}) as { name?: unknown; vehicles?: unknown };
    if (typeof name !== "string" || !name.trim() || !Array.isArray(vehicles)) continue;
    const numbers = vehicles.filter((id): id is number => Number.isInteger(id) && id > 0 && id <= 65535);
    if (numbers.length > 0) groups.push({ name: name.slice(0, name_max), vehicles: numbers, own: true });
  }
  return groups;
}

export function write_groups(groups: readonly Group[]): string {
  return JSON.stringify(groups.map(({ name, vehicles }) => ({ name, vehicles })));
}

/** Those of the configuration first; an own one of the same name stands in place of it. */
export function all_groups(configured: readonly { name: string; vehicles: number[] }[], own: readonly Group[]): Group[] {
  const mine = new Map(own.map((group) => [group.name, group]));
  const first = configured.map(({ name, vehicles }) => mine.get(name) ?? { name, vehicles, own: false });
  const names = new Set(configured.map(({ name }) => name));
  return [...first, ...own.filter(({ name }) => !names.has(name))];
}

/** The names of the groups that it is in. */
export function groups_of(groups: readonly Group[], id: number): string[] {
  return groups.filter((group) => group.vehicles.includes(id)).map((group) => group.name);
}

/** With that one, in place of one of the same name; or what is wrong. */
export function with_group(own: readonly Group[], name: string, vehicles: Iterable<number>): Group[] | string {
  const called = name.trim().slice(0, name_max);
  const sorted = [...new Set(vehicles)].sort((a, b) => a - b);
  if (called === "") return "a group needs a name";
  if (sorted.length === 0) return "select the vehicles first";
  const group: Group = { name: called, vehicles: sorted, own: true };
  const at = own.findIndex((one) => one.name === called);
  if (at >= 0) return own.map((one, i) => (i === at ? group : one));
  return own.length < own_max ? [...own, group] : `there are ${own_max} groups already`;
}

export function group_text(group: Group): string {
  return `${group.name}: ${ids(group.vehicles)}`;
}
