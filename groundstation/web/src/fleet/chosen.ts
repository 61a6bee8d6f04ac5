// SPDX-License-Identifier: Apache-2.0
// How the operator has set the list, and his groups. Kept by the browser, never sent.

import { computed, effect, signal } from "@preact/signals";
import { note } from "../shell/give";
import { select_all } from "../shell/view";
import { current, hello, vehicles } from "../wire/store";
import { column_names, no_filter, passes, sorted } from "./fleet_list";
import type { Column, Filter, Sorting } from "./fleet_list";
import { all_groups, read_groups, with_group, write_groups } from "./groups";
import type { Group } from "./groups";

export const filter = signal<Filter>(no_filter);
export const sorting = signal<Sorting>({ column: null, descending: false });

const columns_key = "skein.columns";

function kept_columns(): readonly Column[] | null {
  const kept = (localStorage.getItem(columns_key) ?? "").split(" ");
  const there = column_names.filter((column) => kept.includes(column));
  return there.length > 0 ? there : null;
}

/** null: as many as have room. */
export const wanted_columns = signal<readonly Column[] | null>(kept_columns());

export function want_columns(columns: readonly Column[] | null): void {
  wanted_columns.value = columns;
  if (columns) localStorage.setItem(columns_key, columns.join(" "));
  else localStorage.removeItem(columns_key);
}

// Several operators may share a browser.
const groups_key = computed(() => `skein.groups.${hello.value?.user ?? ""}`);
const own_groups = signal<Group[]>([]);
effect(() => {
  own_groups.value = read_groups(localStorage.getItem(groups_key.value));
});

export const groups = computed(() => all_groups(hello.value?.groups ?? [], own_groups.value));

function keep(next: Group[]): void {
  own_groups.value = next;
  localStorage.setItem(groups_key.value, write_groups(next));
}

/** What is wrong; null: it is kept. */
export function keep_group(name: string, ids: Iterable<number>): string | null {
  const next = with_group(own_groups.value, name, ids);
  if (typeof next === "string") return next;
  keep(next);
  return null;
}

export function forget_group(name: string): void {
  if (filter.value.group === name) filter.value = { ...filter.value, group: null };
  keep(own_groups.value.filter((group) => group.name !== name));
}

/** Selects those of it that are known; the first group has number 1. */
export function recall_group(number: number): void {
  const group = groups.value[number - 1];
  if (!group) return note(`There is no group ${number}: select vehicles, and keep them as one`);
  const known = new Set(current().vehicles.map((vehicle) => vehicle.id));
  select_all(group.vehicles.filter((id) => known.has(id)));
}

/** The rows, in their order. */
export const listed = computed(() => sorted(vehicles.value.filter(passes(filter.value, groups.value)), sorting.value, groups.value));
