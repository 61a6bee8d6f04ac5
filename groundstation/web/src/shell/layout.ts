// SPDX-License-Identifier: Apache-2.0
// How much room there is. What style sheets can tell by themselves they do.

import { effect, signal } from "@preact/signals";
import type { Signal } from "@preact/signals";
import { panel, place_to_show, tool, vehicles_to_show } from "./view";
import type { Tool } from "./view";

function matches(query: string): Signal<boolean> {
  const list = window.matchMedia(query);
  const is_so = signal(list.matches);
  list.addEventListener("change", () => (is_so.value = list.matches));
  return is_so;
}

/** What is seldom used goes into menus, and what can be pressed is as large as a finger wants it. */
export const narrow = matches("(max-width: 820px)");
/** Map and panels have no room at the same time: the map is a tab as the panels are (layout.css). */
export const single = matches("(max-width: 639px) and (max-height: 599px)");
/** As in controls.css. */
export const for_fingers = matches("(pointer: coarse), (max-width: 820px)");

/** Of a layout that shows one thing at a time. */
export const map_in_front = signal(false);

/** Brings the map to the front for what is done on it, and the panel for which somebody asks. */
export function follow_what_is_asked_for(): () => void {
  let before: Tool = "select";
  let was_in_front = false;
  const undo = [
    effect(() => {
      void panel.value;
      map_in_front.value = false;
    }),
    effect(() => {
      const next = tool.value;
      if (before === "select" && next !== "select") {
        was_in_front = map_in_front.peek();
        map_in_front.value = true;
      }
      // What was measured is on the map; what was drawn is of the form that asked for it.
      if (before !== "select" && next === "select") map_in_front.value = was_in_front || before === "measure";
      before = next;
    }),
    effect(() => {
      if (place_to_show.value || vehicles_to_show.value) map_in_front.value = true;
    }),
  ];
  return () => undo.forEach((stop) => stop());
}
