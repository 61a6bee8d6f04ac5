// SPDX-License-Identifier: Apache-2.0
// Where each vehicle's row of the time line stands.

export const row_px = 15;

export interface Row {
  /** Of the time line's `vehicles`. */
  index: number;
  id: number;
  y: number;
  height: number;
}

export interface Rows {
  rows: Row[];
  /** Of all of them, more or less than there is room for. */
  height: number;
  /** All are in sight at once, at the cost of their height. */
  condensed: boolean;
}

// Rows of those that come first may take so much of the height.
const first_part = 0.6;
const least_px = 1;
const gap_px = 3;

/** As they come, each with a row of its own; or where `condense`d and there is no room for that: first
 *  those of `first`, with a row of their own, and under them all others, as high as there is room for. */
export function rows_of(ids: readonly number[], first: ReadonlySet<number>, room_px: number, condense: boolean): Rows {
  if (!condense || ids.length * row_px <= room_px) {
    return { rows: ids.map((id, index) => ({ index, id, y: index * row_px, height: row_px })), height: ids.length * row_px, condensed: false };
  }
  const all = ids.map((id, index) => ({ id, index }));
  const most = Math.max(1, Math.floor((first_part * room_px) / row_px));
  const wanted = all.filter(({ id }) => first.has(id)).slice(0, most);
  const taken = new Set(wanted.map(({ id }) => id));
  const others = all.filter(({ id }) => !taken.has(id));
  const rows: Row[] = wanted.map(({ id, index }, i) => ({ index, id, y: i * row_px, height: row_px }));
  const begin = rows.length > 0 ? rows.length * row_px + gap_px : 0;
  const height = Math.max(least_px, Math.min(row_px, (room_px - begin) / Math.max(1, others.length)));
  others.forEach(({ id, index }, i) => rows.push({ index, id, y: begin + i * height, height }));
  return { rows, height: begin + others.length * height, condensed: true };
}

/** The row at `y`; rows are sorted by it. */
export function row_at(rows: readonly Row[], y: number): Row | null {
  let low = 0;
  let high = rows.length - 1;
  while (low <= high) {
    const middle = (low + high) >> 1;
    const row = rows[middle]!;
    if (y < row.y) high = middle - 1;
    else if (y >= row.y + row.height) low = middle + 1;
    else return row;
  }
  return null;
}

/** Of spans that begin at `begin_s`, ascending, and last until the next one, the first that can be seen from
 *  `from_s` on. */
export function first_span(begin_s: readonly number[], from_s: number): number {
  let low = 0;
  let high = begin_s.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (begin_s[middle]! <= from_s) low = middle + 1;
    else high = middle;
  }
  return Math.max(0, low - 1);
}
