// SPDX-License-Identifier: Apache-2.0
// The links between vehicles on the map: how much is lost, and who is reached through others alone.

import type { View } from "../map/canvas_layer";
import type { Picture } from "../wire/picture";
import { through_others, tone_of } from "./links";
import type { LinkTone } from "./links";

// One stroke for all of a tone is many times faster than one for each link.
const tones = ["good", "heard", "some", "bad", "through", "old"] as const satisfies readonly LinkTone[];

// The worse of two ways is the link's; those that only one side hears are dashed.
const badness: Record<LinkTone, number> = { good: 0, heard: 0, some: 1, bad: 2, through: 3, old: 4 };

export function paint_links(view: View, picture: Picture): void {
  const { context, colours } = view;
  const at = new Map(picture.vehicles.map((vehicle) => [vehicle.id, vehicle]));
  const heard = new Map(picture.links.map((row) => [row.id, new Map(row.hears.map((link) => [link.id, tone_of(link)]))]));
  const paths = new Map(tones.map((tone) => [tone, { both: new Path2D(), one: new Path2D() }]));
  for (const [who, hears] of heard) {
    const from = at.get(who);
    if (!from || from.x === null || from.y === null) continue;
    for (const [whom, tone] of hears) {
      const to = at.get(whom);
      if (!to || to.x === null || to.y === null) continue;
      const back = heard.get(whom)?.get(who);
      if (back !== undefined && whom < who) continue;
      const worse = back !== undefined && badness[back] > badness[tone] ? back : tone;
      const path = paths.get(worse)![back === undefined ? "one" : "both"];
      path.moveTo(view.px(from.x), view.py(from.y));
      path.lineTo(view.px(to.x), view.py(to.y));
    }
  }
  const stroke_of: Record<LinkTone, [colour: string, alpha: number, width: number]> = {
    good: [colours.link, 0.5, 1],
    heard: [colours.link, 0.35, 1],
    some: [colours.warning, 0.8, 1.5],
    bad: [colours.alarm, 0.9, 2],
    through: [colours.muted, 0.6, 1],
    old: [colours.muted, 0.2, 1],
  };
  for (const [tone, { both, one }] of paths) {
    const [colour, alpha, width] = stroke_of[tone];
    context.strokeStyle = colour;
    context.globalAlpha = alpha;
    context.lineWidth = width;
    context.setLineDash(tone === "through" ? [1.5, 4] : []);
    context.stroke(both);
    context.setLineDash(tone === "through" ? [1.5, 4] : [3, 4]);
    context.stroke(one);
  }
  context.setLineDash([]);
  context.globalAlpha = 1;
  context.strokeStyle = colours.warning;
  context.lineWidth = 2;
  for (const id of through_others(picture.links)) {
    const vehicle = at.get(id);
    if (!vehicle || vehicle.x === null || vehicle.y === null) continue;
    context.beginPath();
    context.arc(view.px(vehicle.x), view.py(vehicle.y), 15, 0, 2 * Math.PI);
    context.stroke();
  }
}
