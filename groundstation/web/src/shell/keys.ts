// SPDX-License-Identifier: Apache-2.0
// Keys that work anywhere on the page.

import { recall_group } from "../fleet/chosen";
import { acknowledge_shown, go_to, list_open, worst } from "../alarms/alarm_state";
import { may_order } from "../wire/store";
import { hold_all } from "./give";
import { follow, help_open, layers, measure_from, measure_to, panel, panels, select, selected, switch_theme, timeline_open, tool } from "./view";
import type { LayerName } from "./view";

export interface Key {
  keys: string;
  what: string;
}

export const key_list: readonly Key[] = [
  { keys: "Shift+H or F9", what: "Hold all: every vehicle holds, at once. F9 works while typing too" },
  { keys: "1 … 8", what: "Panel: fleet, mission, orders, log, plots, preflight, links, areas" },
  { keys: "J, K, Shift+J", what: "The worst alarm: go to it, where one acts; acknowledge it; the list of all" },
  { keys: "[ and ]", what: "Select the vehicle before, after" },
  { keys: "Shift+1 … 9", what: "Select the group of that number" },
  { keys: "Shift", what: "On the map: with a press one more or less is selected, with a drag all in the box" },
  { keys: "↑ ↓, Ctrl+A", what: "In the fleet's list: select the one before, after, with Shift several; all that are listed" },
  { keys: "F", what: "Follow the selected vehicle on the map" },
  { keys: "A", what: "Show all vehicles and sites on the map" },
  { keys: "M", what: "Measure distance and bearing" },
  { keys: "G, T, P, R", what: "Map layers: grid, trails, paths, radio links" },
  { keys: "L", what: "Open or close the time line" },
  { keys: "N", what: "Day and night colours" },
  { keys: "Esc", what: "Put a tool away, close, deselect" },
  { keys: "?", what: "This help" },
  { keys: "Enter or Space, 1 s", what: "On a button that asks to be held: kept down" },
  { keys: "Arrows, + and −", what: "On the map: move, zoom; on the time line: move, zoom" },
];

const toggles: Record<string, LayerName> = { g: "grid", t: "trails", p: "paths", r: "links" };

/** Called for `A`: the map is not known here. */
export const on_fit = new Set<() => void>();

function next_vehicle(ids: readonly number[], step: 1 | -1): void {
  if (ids.length === 0) return;
  const at = selected.value === null ? -1 : ids.indexOf(selected.value);
  const next = at < 0 ? (step > 0 ? 0 : ids.length - 1) : (at + step + ids.length) % ids.length;
  select(ids[next]!);
}

function put_away(): void {
  if (help_open.value) help_open.value = false;
  else if (tool.value !== "select") tool.value = "select";
  else if (measure_from.value) measure_from.value = measure_to.value = null;
  else select(null);
}

export function listen_to_keys(vehicle_ids: () => readonly number[]): () => void {
  const on_key = (event: KeyboardEvent) => {
    if (event.key === "F9" || (event.key === "H" && event.shiftKey && !is_typing(event))) {
      if (may_order.value && !event.repeat) hold_all();
      event.preventDefault();
      return;
    }
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key === "Escape") return put_away();
    if (is_typing(event)) return;
    // By where the key is: with Shift it makes another sign on each keyboard.
    const number = /^(?:Digit|Numpad)([1-9])$/.exec(event.code)?.[1];
    if (event.shiftKey && number) return recall_group(Number(number));
    const digit = Number(event.key);
    const toggled = toggles[event.key];
    const wanted = panels[digit - 1];
    if (wanted) panel.value = wanted === "orders" && !may_order.value ? panel.value : wanted;
    else if (toggled) layers.value = { ...layers.value, [toggled]: !layers.value[toggled] };
    else if (event.key === "[") next_vehicle(vehicle_ids(), -1);
    else if (event.key === "]") next_vehicle(vehicle_ids(), 1);
    else if (event.key === "f") follow.value = selected.value !== null && !follow.value;
    else if (event.key === "a") on_fit.forEach((fit) => fit());
    else if (event.key === "j" && worst.value) go_to(worst.value);
    else if (event.key === "J") list_open.value = !list_open.value;
    else if (event.key === "k") acknowledge_shown();
    else if (event.key === "m") tool.value = tool.value === "measure" ? "select" : "measure";
    else if (event.key === "l") timeline_open.value = !timeline_open.value;
    else if (event.key === "n") switch_theme();
    else if (event.key === "?") help_open.value = true;
  };
  window.addEventListener("keydown", on_key);
  return () => window.removeEventListener("keydown", on_key);
}

function is_typing(event: KeyboardEvent): boolean {
  const target = event.target;
  if (!(target instanceof HTMLElement)) return false;
  if (target instanceof HTMLInputElement) return !["checkbox", "radio", "range", "button"].includes(target.type);
  return target instanceof HTMLTextAreaElement || target instanceof HTMLSelectElement || target.isContentEditable;
}
