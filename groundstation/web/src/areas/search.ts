// SPDX-License-Identifier: Apache-2.0
// The search of an area, from the fields of its form.

import { signal } from "@preact/signals";
import type { AreaHazard, Hazard, SearchArea, SearchOrder } from "../wire/protocol";
import type { Outline } from "./outline";
import { why_no_outline } from "./outline";

/** What a search would be, and the order that it is of. */
export const search_preview = signal<{ line: string; data: SearchArea | null; text: string; done: boolean } | null>(null);

/** Texts of the fields; an empty one is left to the ground station. */
export interface SearchFields {
  vehicles: string;
  spacing: string;
  in_s: string;
}

export const no_search_fields: SearchFields = { vehicles: "", spacing: "", in_s: "" };

/** The order; of what is left of the last area where `rest`. */
export function search_order(of: Outline, fields: SearchFields, rest: boolean): { order: SearchOrder } | { trouble: string } {
  const order: SearchOrder = { kind: "search", preview: false };
  if (rest) {
    order.rest = true;
  } else {
    const wrong = why_no_outline(of);
    if (wrong) return { trouble: wrong };
    order.corners = of.map(([east, north]) => [east, north]);
  }
  const vehicles = fields.vehicles.trim();
  if (vehicles !== "") {
    const ids = vehicles.split(/[\s,]+/).map(Number);
    if (!ids.every((id) => Number.isInteger(id) && id > 0 && id < 65536)) return { trouble: "vehicles are numbers with commas between, such as 1, 2, 5" };
    order.vehicles = ids;
  }
  for (const [name, key, low, high] of [["spacing", "spacing_m", 1, 1e4], ["in_s", "in_s", 5, 86400]] as const) {
    const text = fields[name].trim();
    if (text === "") continue;
    const value = Number(text);
    if (!Number.isFinite(value) || value < low || value > high) return { trouble: `${name === "in_s" ? "begin in" : name} is to be from ${low} to ${high}` };
    order[key] = value;
  }
  return { order };
}

export function words_of_corners(corners: Outline): string {
  return corners.map(([east, north]) => `${east},${north}`).join(" ");
}

/** Hazards as an operator knows them: a polygon is one, however many circles hold it. */
export function hazards_by_number(circles: readonly Hazard[], groups: readonly AreaHazard[]): { alone: Hazard[]; groups: readonly AreaHazard[] } {
  const held = new Set(groups.flatMap((group) => [group.hazard, ...group.circles]));
  return { alone: circles.filter((circle) => !held.has(circle.id)), groups };
}
