// SPDX-License-Identifier: Apache-2.0
// What each vehicle did and will do.

import { effect, signal } from "@preact/signals";
import { useEffect, useRef, useState } from "preact/hooks";
import { words } from "../shell/format";
import { needs_attention } from "../fleet/fleet_list";
import { select, selection, theme, timeline_open, toggle_selected } from "../shell/view";
import { read_colours } from "../theme/colours";
import { state_colour } from "../theme/palette";
import { current, mission_now_s, shown, since_state_s, timeline } from "../wire/store";
import { next_span, time_at, window_of, zoomed } from "./time_scale";
import { axis_px, names_px, paint_timeline, span_text } from "./timeline_painter";
import type { TimelineView } from "./timeline_painter";
import { row_at, row_px, rows_of } from "./timeline_rows";

/** All at once where they are too many for rows that can be read; else rows that are scrolled. */
const condensed = signal(true);
/** Higher, at the map's cost. */
const tall = signal(false);

class TimelineCanvas {
  span_s = 300;
  pinned_s: number | null = null;
  scroll = 0;
  private colours = read_colours();
  private frame = 0;
  // Kept, since asking the element would lay the page out at every paint.
  private width = 0;
  private height = 0;
  private readonly undo: (() => void)[];

  constructor(private readonly canvas: HTMLCanvasElement) {
    const resize = new ResizeObserver(() => {
      this.width = canvas.clientWidth;
      this.height = canvas.clientHeight;
      this.redraw();
    });
    resize.observe(canvas);
    this.undo = [
      () => resize.disconnect(),
      effect(() => {
        void [shown.value, selection.value, condensed.value];
        this.redraw();
      }),
      effect(() => {
        void theme.value;
        queueMicrotask(() => {
          this.colours = read_colours();
          this.redraw();
        });
      }),
    ];
  }

  remove(): void {
    cancelAnimationFrame(this.frame);
    for (const undo of this.undo) undo();
  }

  redraw(): void {
    if (this.frame === 0) this.frame = requestAnimationFrame(() => this.paint());
  }

  view(): TimelineView | null {
    const context = this.canvas.getContext("2d");
    if (!context) return null;
    const now_s = mission_now_s() ?? 0;
    const { timeline: { vehicles: lines }, vehicles } = current();
    const first_s = lines.reduce((least, { from_s }) => Math.min(least, from_s[0] ?? 0), 0);
    const first = new Set(selection.value);
    for (const vehicle of vehicles) if (needs_attention(vehicle)) first.add(vehicle.id);
    const rows = rows_of(lines.map(({ id }) => id), first, this.height - axis_px, condensed.value);
    this.scroll = Math.max(0, Math.min(this.scroll, rows.height - (this.height - axis_px)));
    return {
      context,
      width: this.width,
      height: this.height,
      scroll: this.scroll,
      window: window_of(now_s, this.span_s, this.pinned_s, first_s),
      now_s,
      known_s: (current().time_s ?? 0) + since_state_s(),
      rows,
      selection: selection.value,
      colours: this.colours,
    };
  }

  zoom(step: 1 | -1, x: number | null): void {
    const view = this.view();
    if (!view) return;
    if (x === null || this.pinned_s === null) {
      this.span_s = next_span(this.span_s, step);
    } else {
      const at_s = time_at(view.window, view.width - names_px, x - names_px);
      ({ span_s: this.span_s, pinned_s: this.pinned_s } = zoomed(view.window, step, at_s));
    }
    this.redraw();
  }

  /** By pixels: `dx` later, `dy` further down. */
  move(dx: number, dy: number): void {
    const view = this.view();
    if (!view) return;
    if (dx !== 0) this.pinned_s = view.window.from_s + (dx / (view.width - names_px)) * this.span_s;
    this.scroll += dy;
    this.redraw();
  }

  text_at(x: number, y: number): string | null {
    const view = this.view();
    return view && span_text(view, current(), x, y, time_at(view.window, view.width - names_px, x - names_px));
  }

  vehicle_at(y: number): number | null {
    const view = this.view();
    return (view && row_at(view.rows.rows, y - axis_px + this.scroll)?.id) ?? null;
  }

  private paint(): void {
    this.frame = 0;
    const view = this.view();
    if (!view || view.width === 0) return;
    const ratio = Math.min(2, window.devicePixelRatio || 1);
    const [width, height] = [Math.round(view.width * ratio), Math.round(view.height * ratio)];
    if (this.canvas.width !== width || this.canvas.height !== height) {
      this.canvas.width = width;
      this.canvas.height = height;
    }
    view.context.setTransform(ratio, 0, 0, ratio, 0, 0);
    paint_timeline(view, current());
    // For who wants to know how many are in sight: a canvas tells nobody.
    const seen = view.rows.rows.filter(({ y, height }) => y + height > view.scroll && y < view.scroll + view.height - axis_px).length;
    this.canvas.dataset["rows"] = `${seen}`;
  }
}

const key_moves: Record<string, [number, number]> = {
  ArrowLeft: [-60, 0],
  ArrowRight: [60, 0],
  ArrowUp: [0, -3 * row_px],
  ArrowDown: [0, 3 * row_px],
};

function Legend() {
  return (
    <span class="legend" aria-hidden="true">
      {[...timeline.value.states].sort().map((name) => (
        <span key={name}>
          <i ref={(element) => element?.style.setProperty("background", state_colour(name))} />
          {words(name)}
        </span>
      ))}
    </span>
  );
}

function Canvas() {
  const element = useRef<HTMLCanvasElement>(null);
  const lines = useRef<TimelineCanvas | null>(null);
  const drag = useRef<{ x: number; y: number; moved: boolean } | null>(null);
  const [text, set_text] = useState<string | null>(null);
  const [pinned, set_pinned] = useState(false);

  useEffect(() => {
    const made = new TimelineCanvas(element.current!);
    lines.current = made;
    const on_wheel = (event: WheelEvent) => {
      event.preventDefault();
      if (event.ctrlKey || event.shiftKey) made.zoom(event.deltaY + event.deltaX > 0 ? 1 : -1, event.offsetX);
      else made.move(event.deltaX, event.deltaY);
      set_pinned(made.pinned_s !== null);
    };
    element.current!.addEventListener("wheel", on_wheel, { passive: false });
    return () => made.remove();
  }, []);

  const follow_now = () => {
    if (!lines.current) return;
    lines.current.pinned_s = null;
    set_pinned(false);
    lines.current.redraw();
  };
  const on_move = (event: PointerEvent) => {
    const made = lines.current;
    if (!made) return;
    set_text(made.text_at(event.offsetX, event.offsetY));
    if (!drag.current) return;
    const dx = drag.current.x - event.offsetX;
    const dy = drag.current.y - event.offsetY;
    if (!drag.current.moved && Math.hypot(dx, dy) < 4) return;
    drag.current = { x: event.offsetX, y: event.offsetY, moved: true };
    made.move(dx, dy);
    set_pinned(made.pinned_s !== null);
  };
  return (
    <>
      <div class="timeline-tools">
        <Legend />
        <span class="timeline-text" role="status">
          {text}
        </span>
        <button type="button" class="quiet" data-testid="timeline-all" aria-pressed={condensed.value} title="All vehicles at once, or a row for each that is scrolled" onClick={() => (condensed.value = !condensed.value)}>
          All
        </button>
        <button type="button" class="quiet" data-testid="timeline-tall" aria-pressed={tall.value} title="Higher, at the map's cost" onClick={() => (tall.value = !tall.value)}>
          Tall
        </button>
        <button type="button" class="quiet" data-testid="timeline-now" aria-pressed={!pinned} onClick={follow_now}>
          Now
        </button>
        <button type="button" class="quiet" aria-label="Shorter span" data-testid="timeline-in" onClick={() => lines.current?.zoom(-1, null)}>
          +
        </button>
        <button type="button" class="quiet" aria-label="Longer span" data-testid="timeline-out" onClick={() => lines.current?.zoom(1, null)}>
          −
        </button>
      </div>
      <canvas
        ref={element}
        class={`timeline-canvas${tall.value ? " tall" : ""}`}
        data-testid="timeline"
        tabIndex={0}
        role="img"
        aria-label="Time line of the vehicles' activities. The fleet table has what each does now."
        onPointerDown={(event) => {
          drag.current = { x: event.offsetX, y: event.offsetY, moved: false };
          (event.currentTarget as HTMLCanvasElement).setPointerCapture(event.pointerId);
        }}
        onPointerMove={on_move}
        onPointerUp={(event) => {
          const id = lines.current?.vehicle_at(event.offsetY) ?? null;
          if (drag.current && !drag.current.moved) {
            if (event.shiftKey && id !== null) toggle_selected(id);
            else if (!event.shiftKey) select(id);
          }
          drag.current = null;
        }}
        onPointerCancel={() => (drag.current = null)}
        onPointerLeave={() => set_text(null)}
        onKeyDown={(event) => {
          const move = key_moves[event.key];
          if (move) lines.current?.move(...move);
          else if (event.key === "+") lines.current?.zoom(-1, null);
          else if (event.key === "-") lines.current?.zoom(1, null);
          else if (event.key === "Home") follow_now();
          else return;
          set_pinned(lines.current?.pinned_s !== null);
          event.preventDefault();
        }}
      />
    </>
  );
}

export function TimelinePanel() {
  return (
    <section class="timeline" aria-label="Time line">
      <button type="button" class="timeline-title quiet" aria-expanded={timeline_open.value} data-testid="timeline-open" onClick={() => (timeline_open.value = !timeline_open.value)}>
        {timeline_open.value ? "▾" : "▸"} Time line
      </button>
      {timeline_open.value && <Canvas />}
    </section>
  );
}
