// SPDX-License-Identifier: Apache-2.0
// What presses on the map do while a tool is out.

import { add_corner, outline } from "../areas/outline";
import { formation_spot, hazard_draft, measure_from, measure_to, site_spot, tool } from "../shell/view";
import type { Spot } from "../shell/view";
import { distance_and_bearing } from "./geodesy";

const radius_m_first = 100;
const radius_m_least = 5;

export function press(at: Spot): void {
  switch (tool.value) {
    case "measure":
      if (!measure_from.value || measure_to.value) {
        measure_from.value = at;
        measure_to.value = null;
      } else {
        measure_to.value = at;
      }
      break;
    case "hazard":
      hazard_draft.value = { ...at, radius_m: radius_m_first };
      tool.value = "hazard_edge";
      break;
    case "hazard_edge":
      drag_edge(at);
      tool.value = "select";
      break;
    case "place":
      formation_spot.value = at;
      tool.value = "select";
      break;
    case "outline":
      outline.value = add_corner(outline.value, at.x, at.y);
      break;
    case "site":
      site_spot.value = at;
      tool.value = "select";
      break;
    case "box":
    case "select":
  }
}

/** The edge of a hazard follows the pointer until it is pressed; a finger only presses. */
export function drag_edge(at: Spot): void {
  const draft = hazard_draft.value;
  if (tool.value !== "hazard_edge" || !draft) return;
  const { distance_m } = distance_and_bearing(draft, at);
  hazard_draft.value = { ...draft, radius_m: Math.max(radius_m_least, Math.round(distance_m)) };
}
