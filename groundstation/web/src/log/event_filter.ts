// SPDX-License-Identifier: Apache-2.0
import type { MissionEvent } from "../wire/protocol";

export interface EventFilter {
  vehicle: number | null;
  kind: string | null;
  warnings_only: boolean;
  text: string;
}

export const all_events: EventFilter = { vehicle: null, kind: null, warnings_only: false, text: "" };

/** Those that the filter lets through; in a recording, none that is later than `until_s`. */
export function filtered(events: readonly MissionEvent[], filter: EventFilter, until_s: number | null): MissionEvent[] {
  const text = filter.text.trim().toLowerCase();
  return events.filter(
    (event) =>
      (until_s === null || event.time_s <= until_s) &&
      (filter.vehicle === null || event.vehicle === filter.vehicle) &&
      (filter.kind === null || event.kind === filter.kind) &&
      (!filter.warnings_only || event.level === "warning") &&
      (text === "" || event.text.toLowerCase().includes(text)),
  );
}

/** Which of `count` rows of `row_px` are in sight, and some around them. */
export function rows_in_sight(count: number, row_px: number, scroll: number, height: number): [first: number, end: number] {
  const first = Math.max(0, Math.floor(scroll / row_px) - 10);
  return [Math.min(first, count), Math.min(count, Math.ceil((scroll + height) / row_px) + 10)];
}
