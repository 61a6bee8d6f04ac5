// SPDX-License-Identifier: Apache-2.0
// Events, oldest first; stays at the newest unless it was scrolled away from it.

import { useEffect, useMemo, useRef, useState } from "preact/hooks";
import { clock, utc, words } from "../shell/format";
import { for_fingers } from "../shell/layout";
import { select, selected } from "../shell/view";
import { events, hello, in_replay, shown, vehicles } from "../wire/store";
import { all_events, filtered, rows_in_sight } from "./event_filter";
import type { EventFilter } from "./event_filter";

// As in log.css.
const row_px_of = (fingers: boolean) => (fingers ? 46 : 24);

function Filters({ filter, change, kinds }: { filter: EventFilter; change: (some: Partial<EventFilter>) => void; kinds: string[] }) {
  const ids = vehicles.value.map(({ id }) => id);
  const options = useMemo(
    () =>
      ids.map((id) => (
        <option key={id} value={id}>
          vehicle {id}
        </option>
      )),
    [ids.join()],
  );
  return (
    <div class="filters" role="search" aria-label="Filter the log">
      <input type="search" placeholder="Text" aria-label="Text" value={filter.text} data-testid="log-text" onInput={(event) => change({ text: event.currentTarget.value })} />
      <select aria-label="Vehicle" data-testid="log-vehicle" value={filter.vehicle ?? ""} onChange={(event) => change({ vehicle: event.currentTarget.value === "" ? null : Number(event.currentTarget.value) })}>
        <option value="">all vehicles</option>
        <option value="0">ground station</option>
        {options}
      </select>
      <select aria-label="Kind" data-testid="log-kind" value={filter.kind ?? ""} onChange={(event) => change({ kind: event.currentTarget.value || null })}>
        <option value="">all kinds</option>
        {kinds.map((kind) => (
          <option key={kind} value={kind}>
            {words(kind)}
          </option>
        ))}
      </select>
      <label>
        <input type="checkbox" checked={filter.warnings_only} data-testid="log-warnings" onChange={(event) => change({ warnings_only: event.currentTarget.checked })} /> Warnings
      </label>
    </div>
  );
}

export function LogPanel() {
  const [filter, set_filter] = useState<EventFilter>(all_events);
  const [scroll, set_scroll] = useState(0);
  const [height, set_height] = useState(400);
  const box = useRef<HTMLDivElement>(null);
  const at_end = useRef(true);
  const row_px = row_px_of(for_fingers.value);
  const until_s = in_replay.value ? shown.value.time_s : null;
  const all = events.value;
  const list = useMemo(() => filtered(all, filter, until_s), [all, filter, until_s]);
  const kinds = useMemo(() => [...new Set(all.map((event) => event.kind))].sort(), [all]);

  useEffect(() => {
    const element = box.current!;
    const resize = new ResizeObserver(() => set_height(element.clientHeight));
    resize.observe(element);
    return () => resize.disconnect();
  }, []);
  useEffect(() => {
    if (at_end.current && box.current) box.current.scrollTop = box.current.scrollHeight;
  }, [list.length, height]);

  const [first, end] = rows_in_sight(list.length, row_px, scroll, height);
  const set_size = (element: HTMLElement | null) => {
    element?.style.setProperty("height", `${list.length * row_px}px`);
    element?.style.setProperty("padding-top", `${first * row_px}px`);
  };
  return (
    <div class="log">
      <Filters filter={filter} change={(some) => set_filter({ ...filter, ...some })} kinds={kinds} />
      <div
        ref={box}
        class="scroll log-rows"
        role="log"
        aria-label="Events"
        aria-live="off"
        tabIndex={0}
        data-testid="log"
        onScroll={(event) => {
          const element = event.currentTarget;
          at_end.current = element.scrollTop + element.clientHeight > element.scrollHeight - row_px;
          set_scroll(element.scrollTop);
        }}
      >
        <div class="log-all" ref={set_size}>
          {list.slice(first, end).map((event) => (
            <div key={event.seq} class={`log-row ${event.level}${event.vehicle === selected.value ? " selected" : ""}`} data-testid={`event-${event.seq}`}>
              <span class="figure muted">{clock(event.time_s, 1)}</span>
              <span class="figure muted utc">{utc(event.time_s, hello.value?.epoch_unix_s)}</span>
              <button type="button" class="row-button" title="Select this vehicle" disabled={event.vehicle === 0} onClick={() => select(event.vehicle)}>
                {event.vehicle === 0 ? "ground" : event.vehicle}
              </button>
              <span class="kind">
                {event.level === "warning" && <span class="health warning">▲</span>}
                {words(event.kind)}
              </span>
              <span class="event-text" title={event.text}>
                {event.news}
              </span>
            </div>
          ))}
        </div>
      </div>
      <p class="log-count muted" data-testid="log-count">
        {list.length} of {all.length} events
        {shown.value.events_missed > 0 && `; ${shown.value.events_missed} older ones are only in the recording`}
      </p>
    </div>
  );
}
