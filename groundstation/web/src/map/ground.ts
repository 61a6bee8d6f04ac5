// SPDX-License-Identifier: Apache-2.0
// What stands on the ground: hazards, sites and the bearings of their deliveries.

import { clock } from "../shell/format";
import { coalition_sign, line_colour } from "../theme/palette";
import type { AreaHazard, Authorisation, Hazard, Site, SiteTask } from "../wire/protocol";
import type { Picture } from "../wire/picture";
import type { View } from "./canvas_layer";
import { arrow, badge, font, label } from "./draw";

export function paint_hazards(view: View, hazards: readonly Hazard[], groups: readonly AreaHazard[]): void {
  const in_polygon = new Set(groups.flatMap((group) => (group.corners.length > 0 ? group.circles : [])));
  const named = new Map(groups.flatMap((group) => group.circles.map((circle) => [circle, group.hazard] as const)));
  for (const hazard of hazards) {
    disc(view, hazard.x, hazard.y, hazard.radius_m, view.colours.hazard, true);
    // The outline has the name.
    if (in_polygon.has(hazard.id)) continue;
    view.context.font = font(11);
    view.context.textAlign = "center";
    view.context.textBaseline = "middle";
    label(view, `keep out ${named.get(hazard.id) ?? hazard.id}`, view.px(hazard.x), view.py(hazard.y), view.colours.hazard);
  }
}

/** A circle in metres, hatched so that it is seen without its colour. */
export function disc(view: View, x: number, y: number, radius_m: number, colour: string, hatched: boolean): void {
  const { context } = view;
  const radius = radius_m * view.scale;
  const cx = view.px(x);
  const cy = view.py(y);
  if (!view.sees(x, y, radius + 10)) return;
  context.save();
  context.beginPath();
  context.arc(cx, cy, radius, 0, 2 * Math.PI);
  context.strokeStyle = colour;
  context.lineWidth = 1.5;
  context.stroke();
  if (hatched) {
    context.clip();
    context.globalAlpha = 0.35;
    context.lineWidth = 1;
    context.beginPath();
    for (let offset = -2 * radius; offset < 2 * radius; offset += 9) {
      context.moveTo(cx + offset, cy - radius);
      context.lineTo(cx + offset + 2 * radius, cy + radius);
    }
    context.stroke();
  }
  context.restore();
}

/** The newest coalition of each site that stands or is being formed gives the site its sign. */
function sign_of_site(picture: Picture, site: number) {
  const coalition = [...picture.coalitions].reverse().find((one) => one.site === site && one.state !== "failed");
  const slot = coalition && picture.coalition_slots.get(coalition.key);
  return slot === undefined ? null : coalition_sign(slot);
}

// Further out, words would cover the vehicles around the site; the mission panel has them too.
const least_scale_of_progress = 0.12;

export function paint_sites(view: View, picture: Picture): void {
  const silent = new Set(picture.vehicles.filter((vehicle) => vehicle.silent).map((vehicle) => vehicle.id));
  for (const site of picture.sites) {
    if (site.x === null || site.y === null || !view.sees(site.x, site.y, 200)) continue;
    const sign = sign_of_site(picture, site.id);
    const colour = sign ? line_colour(sign, view.colours.day) : view.colours.text;
    const x = view.px(site.x);
    const y = view.py(site.y);
    for (const task of tasks_to_draw(site)) paint_bearing(view, x, y, task, colour, silent);
    const { context } = view;
    context.beginPath();
    context.rect(x - 7, y - 7, 14, 14);
    context.lineWidth = 2;
    context.fillStyle = site.status === "found" ? view.colours.halo : colour;
    context.fill();
    context.strokeStyle = site.status === "found" ? colour : view.colours.halo;
    context.stroke();
    if (site.status === "done") {
      context.beginPath();
      context.moveTo(x - 4, y);
      context.lineTo(x - 1, y + 3.5);
      context.lineTo(x + 4.5, y - 4);
      context.strokeStyle = "#10161b";
      context.stroke();
    }
    if (sign) badge(view, sign, x + 15, y - 9);
    context.textAlign = "left";
    context.textBaseline = "top";
    context.font = font(12, true);
    label(view, `Site ${site.id}`, x + 10, y + 3);
    if (view.scale < least_scale_of_progress) continue;
    context.font = font(10);
    label(view, progress_of(site), x + 10, y + 17, view.colours.muted);
  }
}

/** The operator wants nobody there any more. */
export const is_off = (site: Site): boolean => site.status === "withdrawn" || site.status === "refused" || site.status === "taken_back";

/** Of a site that nobody works at any more only what was flown there. */
export function tasks_to_draw(site: Site): SiteTask[] {
  return site.tasks.filter((task) => !is_off(site) || task.state === "started" || task.state === "done" || task.state === "unknown");
}

/** "surveyed · 1/3 delivered · 0/2 assessed" */
export function progress_of(site: Site): string {
  const count = (kind: string, word: string) => {
    const of_kind = site.tasks.filter((task) => task.kind === kind);
    if (of_kind.length === 0) return null;
    return `${of_kind.filter((task) => task.state === "done").length}/${of_kind.length} ${word}`;
  };
  if (site.status === "withdrawn") return "withdrawn";
  if (site.status === "refused") return "refused by the operator";
  if (site.status === "taken_back") return ["authorisation taken back", count("deliver", "delivered")].filter((part) => part !== null).join(" · ");
  const parts = [site.status];
  if (site.status !== "found") parts.push(...[count("deliver", "delivered"), count("assess", "assessed")].filter((part) => part !== null));
  return parts.join(" · ");
}

const arrow_px = 54;

/** The bearing of a delivery at the site at (site_x, site_y) on the screen. */
function paint_bearing(view: View, site_x: number, site_y: number, task: SiteTask, colour: string, silent: ReadonlySet<number>): void {
  if (task.bearing_deg === null) return;
  const { context } = view;
  const angle = (task.bearing_deg * Math.PI) / 180;
  const x = site_x - 11 * Math.sin(angle);
  const y = site_y + 11 * Math.cos(angle);
  context.save();
  context.strokeStyle = context.fillStyle = task.state === "failed" ? view.colours.alarm : colour;
  context.globalAlpha = task.state === "done" ? 0.55 : 1;
  context.lineWidth = task.state === "started" ? 3.5 : 2;
  if (task.state === "open" || task.state === "planned" || task.state === "unknown") context.setLineDash([5, 4]);
  arrow(view, x, y, task.bearing_deg, arrow_px, 9);
  context.restore();
  const marks: Record<string, string> = { done: "✓", failed: "✕", unknown: "?" };
  const is_awaited = task.state === "planned" || task.state === "started";
  const who = task.vehicle === null ? "" : `${task.vehicle}${is_awaited && silent.has(task.vehicle) ? " silent" : ""}`;
  context.font = font(10);
  context.textAlign = "center";
  context.textBaseline = "middle";
  label(view, `${who}${marks[task.state] ?? ""}`, x - Math.sin(angle) * (arrow_px + 10), y + Math.cos(angle) * (arrow_px + 10));
}

/** What the operator is asked to let fly: the approaches, who flies them and when. */
export function paint_authorisation(view: View, request: Authorisation): void {
  const { context, colours } = view;
  const x = view.px(request.x);
  const y = view.py(request.y);
  context.save();
  context.strokeStyle = context.fillStyle = colours.preview;
  context.lineWidth = 2;
  context.beginPath();
  context.arc(x, y, 17, 0, 2 * Math.PI);
  context.stroke();
  for (const delivery of request.deliveries) {
    const angle = (delivery.bearing_deg * Math.PI) / 180;
    context.lineWidth = 3;
    arrow(view, x - 18 * Math.sin(angle), y + 18 * Math.cos(angle), delivery.bearing_deg, 84, 13);
    context.font = font(11, true);
    context.textAlign = "center";
    context.textBaseline = "middle";
    const far = 18 + 84 + 18;
    const alarm = delivery.marks.some((mark) => mark.level === "alarm");
    label(view, `${delivery.vehicle} at ${clock(delivery.time_s)}${alarm ? " !" : ""}`, x - far * Math.sin(angle), y + far * Math.cos(angle), colours.preview);
    context.strokeStyle = context.fillStyle = colours.preview;
  }
  context.restore();
}
