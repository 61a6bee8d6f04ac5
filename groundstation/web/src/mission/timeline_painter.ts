// SPDX-License-Identifier: Apache-2.0
// The time line: a row for each vehicle, a bar for each thing that it did.

import { font } from "../map/draw";
import { clock, words } from "../shell/format";
import type { Colours } from "../theme/colours";
import { state_colour } from "../theme/palette";
import type { Picture } from "../wire/picture";
import { label_step, x_of } from "./time_scale";
import type { TimeWindow } from "./time_scale";

export const row_px = 15;
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
  selected: number | null;
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
  picture.timeline.forEach(({ id, spans }, row) => {
    const y = axis_px + row * row_px - view.scroll;
    if (y < axis_px - row_px || y > height) return;
    if (id === view.selected) {
      context.fillStyle = colours["grid-strong"];
      context.fillRect(0, y, width, row_px);
    }
    for (const [state, from_s, to_s, site] of spans) {
      const left = Math.max(names_px, at(from_s));
      const right = Math.min(width, at(to_s ?? view.known_s));
      if (right <= left) continue;
      context.fillStyle = state_colour(state);
      context.fillRect(left, y + 1.5, Math.max(1, right - left - 0.5), row_px - 3);
      paint_word(view, `${words(state)}${site === null ? "" : ` ${site}`}`, left, right, y);
    }
    context.font = font(10, id === view.selected);
    context.textAlign = "right";
    context.textBaseline = "middle";
    context.fillStyle = colours.text;
    context.fillText(`${id}`, names_px - 6, y + row_px / 2);
  });
  paint_tasks(view, picture, at);
  context.restore();

  const now = at(view.now_s);
  if (now < names_px || now > width) return;
  context.fillStyle = colours.accent;
  context.fillRect(now - 0.75, 4, 1.5, height);
}

function paint_word(view: TimelineView, text: string, left: number, right: number, y: number): void {
  const { context } = view;
  if (right - left < 26) return;
  context.font = font(9);
  if (context.measureText(text).width > right - left - 6) return;
  context.textAlign = "left";
  context.textBaseline = "middle";
  context.fillStyle = "#0c1318";
  context.fillText(text, left + 3, y + row_px / 2 + 0.5);
}

/** Tasks at their times, as diamonds on the row of who flies them. */
function paint_tasks(view: TimelineView, picture: Picture, at: (time_s: number) => number): void {
  const { context, colours } = view;
  const rows = new Map(picture.timeline.map(({ id }, row) => [id, row]));
  for (const site of picture.sites) {
    for (const task of site.tasks) {
      const row = task.vehicle === null ? undefined : rows.get(task.vehicle);
      if (row === undefined || task.time_s === null) continue;
      const x = at(task.time_s);
      const y = axis_px + (row + 0.5) * row_px - view.scroll;
      if (x < names_px || y < axis_px) continue;
      context.beginPath();
      context.moveTo(x, y - 6);
      context.lineTo(x + 5, y);
      context.lineTo(x, y + 6);
      context.lineTo(x - 5, y);
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
  const line = picture.timeline[Math.floor((y - axis_px + view.scroll) / row_px)];
  if (!line || x < names_px || y < axis_px) return null;
  const span = line.spans.find(([, from_s, to_s]) => from_s <= time_s && time_s < (to_s ?? view.known_s));
  if (!span) return `Vehicle ${line.id}`;
  const [state, from_s, to_s, site] = span;
  const where = site === null ? "" : `, site ${site}`;
  return `Vehicle ${line.id}: ${words(state)}${where}, ${clock(from_s)} – ${to_s === null ? known_until(view) : clock(to_s)}`;
}
