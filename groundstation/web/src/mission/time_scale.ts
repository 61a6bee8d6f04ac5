// SPDX-License-Identifier: Apache-2.0
// Which times the time line shows, and where.

export interface TimeWindow {
  from_s: number;
  to_s: number;
}

export const spans_s = [30, 60, 120, 300, 600, 1200, 3600, 7200] as const;

// Of the width, left of the now-line when it is followed: the rest is for what is planned.
const past_part = 0.8;

/** The window of `span_s` that follows `now_s`, without the emptiness before `first_s`; or the one
 *  that begins at `pinned_s`. */
export function window_of(now_s: number, span_s: number, pinned_s: number | null, first_s = -Infinity): TimeWindow {
  const from_s = pinned_s ?? Math.max(now_s - past_part * span_s, Math.min(first_s, now_s));
  return { from_s, to_s: from_s + span_s };
}

/** The next span that is shorter (-1) or longer (1). */
export function next_span(span_s: number, step: 1 | -1): number {
  const nearest = spans_s.reduce((best, one) => (Math.abs(one - span_s) < Math.abs(best - span_s) ? one : best));
  const at = spans_s.indexOf(nearest) + step;
  return spans_s[Math.max(0, Math.min(spans_s.length - 1, at))]!;
}

/** Zoomed by one span around `at_s`, which stays where it is. */
export function zoomed(window: TimeWindow, step: 1 | -1, at_s: number): { span_s: number; pinned_s: number } {
  const before = window.to_s - window.from_s;
  const span_s = next_span(before, step);
  return { span_s, pinned_s: at_s - ((at_s - window.from_s) / before) * span_s };
}

export function x_of(window: TimeWindow, width: number, time_s: number): number {
  return ((time_s - window.from_s) / (window.to_s - window.from_s)) * width;
}

export function time_at(window: TimeWindow, width: number, x: number): number {
  return window.from_s + (x / width) * (window.to_s - window.from_s);
}

const steps_s = [1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800, 3600];

/** Seconds between labels, so that each has `least_px`. */
export function label_step(window: TimeWindow, width: number, least_px: number): number {
  const least_s = ((window.to_s - window.from_s) / Math.max(1, width)) * least_px;
  return steps_s.find((step) => step >= least_s) ?? 7200;
}
