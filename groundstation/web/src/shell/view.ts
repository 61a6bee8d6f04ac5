// SPDX-License-Identifier: Apache-2.0
// What the person has chosen to look at. Kept by the page, never sent.

import { batch, signal } from "@preact/signals";
import type { Preview } from "../wire/protocol";

export const panels = ["fleet", "mission", "orders", "log", "plots", "preflight", "links", "areas"] as const;
export type Panel = (typeof panels)[number];

export const panel = signal<Panel>("fleet");
/** The vehicle that details, paths and `follow` are of: the one that was touched last of the selection. */
export const selected = signal<number | null>(null);
/** To whom an order to the selection goes. */
export const selection = signal<ReadonlySet<number>>(new Set());
/** The map keeps the selected vehicle in its middle. */
export const follow = signal(false);
// On an upright tablet the map needs its room.
export const timeline_open = signal(!window.matchMedia("(max-width: 820px)").matches);
export const help_open = signal(false);

export type Theme = "night" | "day";
const stored_theme = localStorage.getItem("skein.theme");
const prefers_day = window.matchMedia("(prefers-color-scheme: light)").matches;
export const theme = signal<Theme>(
  stored_theme === "day" || stored_theme === "night" ? stored_theme : prefers_day ? "day" : "night",
);

export function switch_theme(): void {
  theme.value = theme.value === "night" ? "day" : "night";
  localStorage.setItem("skein.theme", theme.value);
}

export const layer_names = ["grid", "trails", "paths", "links", "sites", "hazards", "traffic", "labels"] as const;
export type LayerName = (typeof layer_names)[number];
export const layers = signal<Record<LayerName, boolean>>({
  grid: true,
  trails: true,
  paths: true,
  links: false,
  sites: true,
  hazards: true,
  traffic: true,
  labels: true,
});
export const tiles_shown = signal(true);
export const overlays_hidden = signal<ReadonlySet<string>>(new Set());

/** What a press on the map means. */
export type Tool = "select" | "box" | "measure" | "hazard" | "hazard_edge" | "place" | "site" | "outline";
export const tool = signal<Tool>("select");
export interface Spot {
  x: number;
  y: number;
}
export const measure_from = signal<Spot | null>(null);
export const measure_to = signal<Spot | null>(null);
/** A hazard that is being drawn; not yet the server's. */
export const hazard_draft = signal<(Spot & { radius_m: number }) | null>(null);
/** Where a site shall be; of the order's form. */
export const site_spot = signal<Spot | null>(null);
/** The site that the form changes; null: it makes a new one. */
export const site_changed = signal<number | null>(null);
/** Where a formation shall be; of the order's form. */
export const formation_spot = signal<Spot | null>(null);

/** A place that the map is to show; a new object each time. */
export const place_to_show = signal<Spot | null>(null);
/** Vehicles that the map is to show, all of them; a new list each time. */
export const vehicles_to_show = signal<readonly number[] | null>(null);

/** The preview of a formation order, and the order that it is of. */
export const preview = signal<{ line: string; data: Preview | null; text: string; done: boolean } | null>(null);
/** The request for authorisation that the map points out, by its key. */
export const highlighted_request = signal<string | null>(null);

/** That vehicle alone, or nobody. */
export function select(id: number | null): void {
  select_all(id === null ? [] : [id], id);
}

/** Those; `touched`, or the last of them, is the one that details are of. */
export function select_all(ids: Iterable<number>, touched: number | null = null): void {
  const next = new Set(ids);
  const before = selection.peek();
  const same = next.size === before.size && [...next].every((id) => before.has(id));
  const last = touched !== null && next.has(touched) ? touched : ([...next].at(-1) ?? null);
  batch(() => {
    if (!same) selection.value = next;
    selected.value = last;
    if (last === null) follow.value = false;
  });
}

export function toggle_selected(id: number): void {
  const next = new Set(selection.peek());
  if (!next.delete(id)) next.add(id);
  select_all(next, id);
}
