// SPDX-License-Identifier: Apache-2.0
// The time line: a row for each vehicle, a bar for each thing that it did.

import { font } from "../map/draw";
import { clock, words } from "../shell/format";
import type { Colours } from "../theme/colours";
import { state_colour } from "../theme/palette";
import type { Picture } from "../wire/picture";
import { label_step, x_of } from "./time_scale";
import type { TimeWindow } from "./time_scale";
import { first_span, row_at } from "./timeline_rows";
import type { Row, Rows } from "./timeline_rows";

export const axis_px = 18;
export const names_px = 30;

export interface TimelineView {
  context: CanvasRenderingContext2D;
  width: number;
  height: number;
  /** Pixels that the rows are scrolled up. */
  scroll: number;
  window: TimeWindow;
  now_s: number;
  /** Until then it is known what they did. */
  known_s: number;
  rows: Rows;
  selection: ReadonlySet<number>;
  colours: Colours;
}

export function paint_timeline(view: TimelineView, picture: Picture): void {
  const { context, width, height, colours } = view;
  context.clearRect(0, 0, width, height);
  const plot = width - names_px;
  const at = (time_s: number) => names_px + x_of(view.window, plot, time_s);

  paint_axis(view, at);
  context.save();
  context.beginPath();
  context.rect(0, axis_px, width, height - axis_px);
  context.clip();
  for (const row of view.rows.rows) paint_row(view, picture, row, at);
  paint_tasks(view, picture, at);
  context.restore();
  paint_scroll(view);

  const now = at(view.now_s);
  if (now < names_px || now > width) return;
  context.fillStyle = colours.accent;
  context.fillRect(now - 0.75, 4, 1.5, height);
}

// Lower rows have no words.
const words_px = 11;
/** A number stands at every row that has room for it, since the one before. */
const number_px = 10;

function paint_row(view: TimelineView, picture: Picture, row: Row, at: (time_s: number) => number): void {
  const { context, width, height, colours } = view;
  const y = axis_px + row.y - view.scroll;
  const { states, vehicles } = picture.timeline;
  const line = vehicles[row.index];
  if (!line || y < axis_px - row.height || y > height) return;
  const is_selected = view.selection.has(row.id);
  if (is_selected) {
    context.fillStyle = colours["grid-strong"];
    context.fillRect(0, y, width, row.height);
  }
  const edge = row.height >= 6 ? 1.5 : row.height >= 3 ? 0.5 : 0;
  for (let i = first_span(line.from_s, view.window.from_s); i < line.from_s.length; ++i) {
    const left = Math.max(names_px, at(line.from_s[i]!));
    if (left > width) break;
    const right = Math.min(width, at(line.from_s[i + 1] ?? view.known_s));
    if (right <= left) continue;
    const state = states[line.states[i]!]!;
    const site = line.sites[i];
    context.fillStyle = state_colour(state);
    context.fillRect(left, y + edge, Math.max(1, right - left - 0.5), row.height - 2 * edge);
    if (row.height >= words_px) paint_word(view, `${words(state)}${site === null ? "" : ` ${site}`}`, left, right, y + row.height / 2);
  }
  const every = Math.ceil(number_px / row.height);
  if (!is_selected && every > 1 && row.index % every !== 0) return;
  context.font = font(Math.min(10, Math.max(8, row.height)), is_selected);
  context.textAlign = "right";
  context.textBaseline = "middle";
  context.fillStyle = is_selected ? colours.accent : colours.text;
  context.fillText(`${row.id}`, names_px - 6, y + row.height / 2);
}

/** How much of it is in sight, at the right edge. */
function paint_scroll(view: TimelineView): void {
  const { context, width, height, colours, scroll } = view;
  const room = height - axis_px;
  if (view.rows.height <= room + 1) return;
  context.fillStyle = colours.muted;
  context.fillRect(width - 3, axis_px + (scroll / view.rows.height) * room, 3, Math.max(8, (room / view.rows.height) * room));
}

function paint_word(view: TimelineView, text: string, left: number, right: number, middle: number): void {
  const { context } = view;
  if (right - left < 26) return;
  context.font = font(9);
  if (context.measureText(text).width > right - left - 6) return;
  context.textAlign = "left";
  context.textBaseline = "middle";
  context.fillStyle = "#0c1318";
  context.fillText(text, left + 3, middle + 0.5);
}

/** Tasks at their times, as diamonds on the row of who flies them. */
function paint_tasks(view: TimelineView, picture: Picture, at: (time_s: number) => number): void {
  const { context, colours } = view;
  const rows = new Map(view.rows.rows.map((row) => [row.id, row]));
  for (const site of picture.sites) {
    for (const task of site.tasks) {
      const row = task.vehicle === null ? undefined : rows.get(task.vehicle);
      if (row === undefined || task.time_s === null) continue;
      const x = at(task.time_s);
      const y = axis_px + row.y + row.height / 2 - view.scroll;
      if (x < names_px || x > view.width || y < axis_px || y > view.height) continue;
      const size = Math.max(3, Math.min(6, row.height));
      context.beginPath();
      context.moveTo(x, y - size);
      context.lineTo(x + 0.8 * size, y);
      context.lineTo(x, y + size);
      context.lineTo(x - 0.8 * size, y);
      context.closePath();
      context.fillStyle = task.state === "failed" ? colours.alarm : task.state === "done" ? colours.good : colours.halo;
      context.strokeStyle = colours.text;
      context.lineWidth = 1.25;
      context.fill();
      context.stroke();
    }
  }
}

function paint_axis(view: TimelineView, at: (time_s: number) => number): void {
  const { context, colours, window } = view;
  const step = label_step(window, view.width - names_px, 70);
  context.font = font(10);
  context.textAlign = "center";
  context.textBaseline = "top";
  for (let t = Math.ceil(Math.max(0, window.from_s) / step) * step; t <= window.to_s; t += step) {
    const x = at(t);
    if (x < names_px) continue;
    context.fillStyle = colours["grid-strong"];
    context.fillRect(Math.round(x), axis_px - 3, 1, view.height);
    context.fillStyle = colours.muted;
    if (x > names_px + 14 && x < view.width - 18) context.fillText(clock(t), x, 3);
  }
}

/** Without the ground station a state lasts until it was last told. */
function known_until(view: TimelineView): string {
  return view.now_s - view.known_s < 1 ? "now" : `${clock(view.known_s)}, not known since`;
}

/** What is under the pointer, in words. */
export function span_text(view: TimelineView, picture: Picture, x: number, y: number, time_s: number): string | null {
  const { states, vehicles } = picture.timeline;
  const line = vehicles[row_at(view.rows.rows, y - axis_px + view.scroll)?.index ?? -1];
  if (!line || x < names_px || y < axis_px) return null;
  const i = first_span(line.from_s, time_s);
  const [from_s, next_s] = [line.from_s[i], line.from_s[i + 1]];
  if (from_s === undefined || time_s < from_s || time_s >= (next_s ?? view.known_s)) return `Vehicle ${line.id}`;
  const site = line.sites[i];
  const where = site === null ? "" : `, site ${site}`;
  return `Vehicle ${line.id}: ${words(states[line.states[i]!]!)}${where}, ${clock(from_s)} – ${next_s === undefined ? known_until(view) : clock(next_s)}`;
}
