// SPDX-License-Identifier: Apache-2.0
// Which tabs stand in a line that is too short for all.

/** The first of `all` that fit, before a button of `more_px` where some do not; the one at `chosen`
 *  takes the last place where it is not among them. */
export function tabs_that_fit<T>(all: readonly T[], widths: readonly number[], room_px: number, more_px: number, chosen: number): T[] {
  const sum = (some: readonly number[]) => some.reduce((total, one) => total + one, 0);
  if (sum(widths) <= room_px) return [...all];
  const left = room_px - more_px;
  let count = 0;
  while (count < all.length && sum(widths.slice(0, count + 1)) <= left) ++count;
  if (chosen < count || chosen < 0) return all.slice(0, Math.max(count, 1));
  while (count > 0 && sum(widths.slice(0, count)) + (widths[chosen] ?? 0) > left) --count;
  return [...all.slice(0, count), all[chosen]!];
}
