// SPDX-License-Identifier: Apache-2.0

/** Milliseconds to wait before connection attempt `attempt` (0 is the first after a loss): doubled
 *  up to 5 s, since an operator is waiting, and spread by `random` in [0, 1) so that several pages
 *  do not come back at one moment. */
export function backoff_ms(attempt: number, random: number): number {
  const base = Math.min(5000, 250 * 2 ** Math.min(attempt, 10));
  return Math.round(base * (0.75 + 0.5 * random));
}
