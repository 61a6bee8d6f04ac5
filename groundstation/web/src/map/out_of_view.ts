// SPDX-License-Identifier: Apache-2.0
// Which new sites the operator does not see.

import type { Site } from "../wire/protocol";

export interface NewSite {
  id: number;
  x: number;
  y: number;
}

/** Keeps which sites were there before, and gives those that are new, or stand somewhere else now. */
export class SitesSeen {
  private readonly places = new Map<number, string>();

  /** Since the call before; of the first call none is new. */
  news(sites: readonly Site[], is_first: boolean): NewSite[] {
    const fresh: NewSite[] = [];
    for (const { id, x, y, status } of sites) {
      if (x === null || y === null) continue;
      const place = `${x} ${y}`;
      const is_new = this.places.get(id) !== place;
      this.places.set(id, place);
      if (is_new && !is_first && status !== "done" && status !== "withdrawn" && status !== "refused") fresh.push({ id, x, y });
    }
    return fresh;
  }
}

export function outside_text(sites: readonly NewSite[]): string {
  if (sites.length === 1) return `Site ${sites[0]!.id} is outside the view: show`;
  return `Sites ${sites.map(({ id }) => id).join(", ")} are outside the view: show`;
}
