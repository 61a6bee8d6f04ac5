// SPDX-License-Identifier: Apache-2.0
// The list itself. Of however many vehicles only the rows in sight are in the page.

import { signal } from "@preact/signals";
import type { ComponentChildren } from "preact";
import { useLayoutEffect, useRef, useState } from "preact/hooks";
import { age, distance, number } from "../shell/format";
import { for_fingers } from "../shell/layout";
import { select, select_all, selected, selection, toggle_selected } from "../shell/view";
import { Badge } from "../theme/badge";
import { coalition_sign } from "../theme/palette";
import type { Vehicle } from "../wire/protocol";
import { coalitions, shown, vehicles } from "../wire/store";
import { health_of, odd_versions, problems_of } from "./attention";
import type { Health } from "./attention";
import { groups, sorting, wanted_columns } from "./chosen";
import { between, column_names, columns_for, least_width, next_sorting, slice_of } from "./fleet_list";
import type { Column } from "./fleet_list";
import { groups_of } from "./groups";
import { state_text, task_text } from "./texts";

export const column_titles: Record<Column, string> = {
  id: "Id", state: "State", task: "Task", heard: "Heard", range: "Range", loads: "Loads", mode: "Mode", version: "Version", clock: "Clock", groups: "Groups",
};
const column_notes: Partial<Record<Column, string>> = {
  loads: "Loads left",
  mode: "Mode of the flight controller",
  clock: "Its clock against ours, link included",
};
const figures: ReadonlySet<Column> = new Set(["heard", "range", "loads", "version", "clock"]);
const health_marks: Record<Health, string> = { alarm: "!", silent: "?", warning: "▲", unheard: "○", stale: "◌", well: "●" };

// As in fleet.css.
const row_px = (fingers: boolean) => (fingers ? 45 : 27);
const more_px = (fingers: boolean) => (fingers ? 44 : 26);
const problems_px_first = 20;
const open_px_first = 70;

/** Rows that are opened, to what has no column. */
const opened = signal<ReadonlySet<number>>(new Set());

function toggle_open(id: number): void {
  const next = new Set(opened.value);
  if (!next.delete(id)) next.add(id);
  opened.value = next;
}

function coalition_of(id: number) {
  const { coalition_slots } = shown.value;
  for (let i = coalitions.value.length - 1; i >= 0; --i) {
    const one = coalitions.value[i]!;
    if (one.state === "failed" || one.state === "closed") continue;
    if (one.leader === id || one.members.includes(id)) return coalition_sign(coalition_slots.get(one.key) ?? 0);
  }
  return null;
}

interface Shown {
  content: ComponentChildren;
  odd?: boolean;
}

function cell(vehicle: Vehicle, column: Column, odd: ReadonlySet<string>): Shown {
  switch (column) {
    case "id":
      return { content: vehicle.id };
    case "state": {
      const sign = coalition_of(vehicle.id);
      return {
        content: (
          <>
            {state_text(vehicle)}
            {sign && <Badge sign={sign} />}
          </>
        ),
      };
    }
    case "task":
      return { content: task_text(vehicle) };
    case "heard":
      return { content: age(vehicle.heard_age_s) };
    case "range":
      return { content: distance(vehicle.range_left_m) };
    case "loads":
      return { content: number(vehicle.loads) };
    case "mode":
      return { content: vehicle.mode ?? "–" };
    case "version":
      return { content: vehicle.version ?? "–", odd: vehicle.version !== null && odd.has(vehicle.version) };
    case "clock":
      return { content: vehicle.clock_offset_ms === null ? "–" : `${number(vehicle.clock_offset_ms)} ms` };
    case "groups":
      return { content: groups_of(groups.value, vehicle.id).join(", ") || "–" };
  }
}

interface RowProps {
  vehicle: Vehicle;
  index: number;
  columns: readonly Column[];
  hidden: readonly Column[];
  odd: ReadonlySet<string>;
  /** Whether Tab stops here. */
  is_stop: boolean;
  on_pick: (id: number, range: boolean, more: boolean) => void;
}

function Row({ vehicle, index, columns, hidden, odd, is_stop, on_pick }: RowProps) {
  const { id } = vehicle;
  const health = health_of(vehicle);
  const problems = problems_of(vehicle);
  const is_selected = selection.value.has(id);
  const is_open = opened.value.has(id);
  const stop = is_stop ? 0 : -1;
  const mark = is_selected ? " selected" : "";
  return (
    <>
      <tr
        class={`vehicle ${health}${mark}${selected.value === id ? " touched" : ""}`}
        data-testid={`vehicle-${id}`}
        data-health={health}
        aria-rowindex={index + 2}
        onClick={(event) => on_pick(id, event.shiftKey, event.ctrlKey || event.metaKey)}
      >
        <th scope="row">
          <label class="pick" onClick={(event) => event.stopPropagation()}>
            <input
              type="checkbox"
              checked={is_selected}
              tabIndex={stop}
              aria-label={`Select vehicle ${id} too`}
              data-testid={`pick-${id}`}
              onClick={(event) => {
                const range = event.shiftKey;
                on_pick(id, range, !range);
              }}
            />
          </label>
          <button type="button" class="row-button" tabIndex={stop} aria-pressed={is_selected} aria-label={`Vehicle ${id}, ${health}`} data-row={id}>
            <span class={`health ${health}`} aria-hidden="true">
              {health_marks[health]}
            </span>
            {id}
          </button>
        </th>
        {columns.map((column) => {
          if (column === "id") return null;
          const { content, odd: is_odd } = cell(vehicle, column, odd);
          return (
            <td key={column} class={`${figures.has(column) ? "figure" : `cell-${column}`}${is_odd ? " odd" : ""}`}>
              {content}
            </td>
          );
        })}
        <td class="open-cell">
          <button
            type="button"
            class="quiet open-row"
            tabIndex={stop}
            aria-expanded={is_open}
            aria-label={`All of vehicle ${id}`}
            data-testid={`open-${id}`}
            onClick={(event) => {
              event.stopPropagation();
              toggle_open(id);
            }}
          >
            {is_open ? "▾" : "▸"}
          </button>
        </td>
      </tr>
      {(problems.length > 0 || is_open) && (
        <tr class={`problems${mark}`} data-extra={id} aria-rowindex={index + 2}>
          <td colSpan={columns.length + 1}>
            {problems.length > 0 && (
              <div data-testid={`problems-${id}`}>
                {problems.map((problem, i) => (
                  <span key={i} class={`problem ${problem.level}`}>
                    {problem.text}
                  </span>
                ))}
              </div>
            )}
            {is_open && (
              <dl class="row-sheet" data-testid={`sheet-${id}`}>
                {(hidden.length > 0 ? hidden : columns).map((column) => {
                  const { content, odd: is_odd } = cell(vehicle, column, odd);
                  return (
                    <div key={column}>
                      <dt>{column_titles[column]}</dt>
                      <dd class={is_odd ? "odd" : ""}>{content}</dd>
                    </div>
                  );
                })}
              </dl>
            )}
          </td>
        </tr>
      )}
    </>
  );
}

function Head({ columns, listed }: { columns: readonly Column[]; listed: readonly number[] }) {
  const { column: by, descending } = sorting.value;
  const chosen = listed.filter((id) => selection.value.has(id)).length;
  return (
    <thead>
      <tr aria-rowindex={1}>
        {columns.map((column) => (
          <th
            key={column}
            scope="col"
            class={figures.has(column) ? "figure" : ""}
            title={column_notes[column]}
            aria-sort={by === column ? (descending ? "descending" : "ascending") : "none"}
          >
            {column === "id" && (
              <label class="pick">
                <input
                  type="checkbox"
                  aria-label="Select all that are listed"
                  data-testid="pick-all"
                  checked={chosen > 0 && chosen === listed.length}
                  ref={(element) => {
                    if (element) element.indeterminate = chosen > 0 && chosen < listed.length;
                  }}
                  onChange={() => select_all(chosen === listed.length ? [] : listed)}
                />
              </label>
            )}
            <button type="button" class="sort" data-testid={`sort-${column}`} onClick={() => (sorting.value = next_sorting(sorting.value, column))}>
              {column_titles[column]}
              <span aria-hidden="true">{by === column ? (descending ? " ▼" : " ▲") : ""}</span>
            </button>
          </th>
        ))}
        <td />
      </tr>
    </thead>
  );
}

function Space({ height }: { height: number }) {
  if (height <= 0) return null;
  return (
    <tbody aria-hidden="true" class="space">
      <tr>
        <td style={{ height: `${height}px` }} />
      </tr>
    </tbody>
  );
}

export function FleetTable({ list, empty }: { list: readonly Vehicle[]; empty: string }) {
  const region = useRef<HTMLDivElement>(null);
  const [view, set_view] = useState({ top: 0, height: 600, width: 560 });
  // What rows below a vehicle's own are high: their words are as long as they are.
  const extra = useRef(new Map<number, number>());
  const [, measured] = useState(0);
  const anchor = useRef<number | null>(null);
  const wanted_focus = useRef<number | null>(null);
  const had_focus = useRef(false);

  const fingers = for_fingers.value;
  const has_groups = groups.value.length > 0;
  const columns = wanted_columns.value ?? columns_for(view.width, has_groups, fingers, more_px(fingers));
  const hidden = column_names.filter((column) => !columns.includes(column) && (column !== "groups" || has_groups));
  const ids = list.map((vehicle) => vehicle.id);
  const odd = odd_versions(vehicles.value);
  const heights = list.map((vehicle) => {
    const has_problems = problems_of(vehicle).length > 0;
    const is_open = opened.value.has(vehicle.id);
    if (!has_problems && !is_open) return row_px(fingers);
    return row_px(fingers) + (extra.current.get(vehicle.id) ?? (has_problems ? problems_px_first : 0) + (is_open ? open_px_first : 0));
  });
  const { from, to, above_px, below_px } = slice_of(heights, view.top, view.height, 8 * row_px(fingers));
  const touched = selected.value;
  const stop = touched !== null && ids.includes(touched) ? touched : (ids[from] ?? null);

  useLayoutEffect(() => {
    const element = region.current!;
    const look = () =>
      set_view((before) => {
        const next = { top: element.scrollTop, height: element.clientHeight, width: element.clientWidth };
        return before.top === next.top && before.height === next.height && before.width === next.width ? before : next;
      });
    const watch = new ResizeObserver(() => {
      extra.current.clear();
      look();
    });
    watch.observe(element);
    element.addEventListener("scroll", look, { passive: true });
    return () => {
      watch.disconnect();
      element.removeEventListener("scroll", look);
    };
  }, []);

  useLayoutEffect(() => {
    const element = region.current!;
    let changed = false;
    for (const row of element.querySelectorAll<HTMLElement>("[data-extra]")) {
      const id = Number(row.dataset["extra"]);
      const height = row.offsetHeight;
      if (extra.current.get(id) === height) continue;
      extra.current.set(id, height);
      changed = true;
    }
    if (changed) measured((count) => count + 1);
    if (wanted_focus.current !== null) {
      const button = element.querySelector<HTMLElement>(`[data-row="${wanted_focus.current}"]`);
      if (button) {
        wanted_focus.current = null;
        button.focus({ preventScroll: true });
      }
    } else if (had_focus.current && !element.contains(document.activeElement)) {
      // The row that had it was moved out of sight, and is no more.
      if (document.activeElement === document.body) element.focus({ preventScroll: true });
    }
    had_focus.current = element.contains(document.activeElement);
  });

  const pick = (id: number, range: boolean, more: boolean) => {
    if (range) {
      const some = between(ids, anchor.current ?? touched, id);
      select_all(more ? [...selection.value, ...some] : some, id);
      return;
    }
    anchor.current = id;
    if (more) return toggle_selected(id);
    const alone = selection.value.size === 1 && selection.value.has(id);
    select(alone ? null : id);
  };

  const go_to = (at: number, range: boolean) => {
    const next = Math.max(0, Math.min(ids.length - 1, at));
    const id = ids[next];
    if (id === undefined) return;
    const element = region.current!;
    const top = heights.slice(0, next).reduce((sum, one) => sum + one, 0);
    const head = element.querySelector("thead")?.clientHeight ?? 0;
    if (top < element.scrollTop) element.scrollTop = top;
    else if (top + head + heights[next]! > element.scrollTop + element.clientHeight) element.scrollTop = top + head + heights[next]! - element.clientHeight;
    wanted_focus.current = id;
    if (range) select_all(between(ids, anchor.current ?? id, id), id);
    else {
      anchor.current = id;
      select(id);
    }
    measured((count) => count + 1);
  };

  const on_key = (event: KeyboardEvent) => {
    const at = touched === null ? -1 : ids.indexOf(touched);
    const page = Math.max(1, Math.floor(view.height / row_px(fingers)) - 2);
    const to_row: Record<string, number> = { ArrowDown: at + 1, ArrowUp: at < 0 ? ids.length - 1 : at - 1, PageDown: at + page, PageUp: at - page, Home: 0, End: ids.length - 1 };
    const next = to_row[event.key];
    if (next !== undefined && !event.ctrlKey && !event.altKey) go_to(next, event.shiftKey);
    else if ((event.ctrlKey || event.metaKey) && event.key.toLowerCase() === "a") select_all(ids, touched);
    else return;
    event.preventDefault();
  };

  return (
    <div
      ref={region}
      class="scroll"
      tabIndex={0}
      role="region"
      aria-label="Vehicles. Up and down select one, with Shift several, Control+A all that are listed"
      data-testid="fleet-scroll"
      onKeyDown={on_key}
      onMouseDown={(event) => {
        // Shift marks rows, not text.
        if (event.shiftKey) event.preventDefault();
      }}
    >
      <table class="fleet-table" aria-rowcount={list.length + 1} style={{ minWidth: `${least_width(columns, fingers) + more_px(fingers)}px` }}>
        <caption class="only-spoken">Vehicles, {sorting.value.column === null ? "those that need attention first" : `by ${column_titles[sorting.value.column]}`}</caption>
        <colgroup>
          {columns.map((name) => (
            <col key={name} class={`col-${name}`} />
          ))}
          <col class="col-open" />
        </colgroup>
        <Head columns={columns} listed={ids} />
        <Space height={above_px} />
        <tbody>
          {list.slice(from, to).map((vehicle, i) => (
            <Row key={vehicle.id} vehicle={vehicle} index={from + i} columns={columns} hidden={hidden} odd={odd} is_stop={vehicle.id === stop} on_pick={pick} />
          ))}
        </tbody>
        <Space height={below_px} />
      </table>
      {list.length === 0 && <p class="empty">{empty}</p>}
    </div>
  );
}
