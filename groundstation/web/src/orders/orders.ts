// SPDX-License-Identifier: Apache-2.0
// Orders, from the fields of a form.

import { words_of_corners } from "../areas/search";
import { bearing_digits, ids } from "../shell/format";
import type { Command, CommandToSeveral, Formation, FormationOrder, Limits, Order, SiteOrder } from "../wire/protocol";

export interface FormFields {
  kind: FormationOrder["order"];
  shape: string;
  /** Texts of the fields; an empty one is left to the ground station. */
  spacing: string;
  heading: string;
  east: string;
  north: string;
  height: string;
  places: string;
}

export const no_fields: FormFields = {
  kind: "form",
  shape: "",
  spacing: "",
  heading: "",
  east: "",
  north: "",
  height: "",
  places: "",
};

type Figure = Exclude<keyof FormFields, "kind" | "shape">;
const limit_of: Record<Figure, keyof Limits> = {
  spacing: "spacing_m",
  heading: "heading_deg",
  east: "coordinate_m",
  north: "coordinate_m",
  height: "coordinate_m",
  places: "places",
};

function figure(fields: FormFields, name: Figure, limits: Limits): number | null | string {
  const text = fields[name].trim();
  if (text === "") return null;
  const value = Number(text);
  const [low, high] = limits[limit_of[name]];
  return Number.isFinite(value) && value >= low && value <= high ? value : `${name} is to be from ${low} to ${high}`;
}

/** The order, or what is wrong with the fields. */
export function formation_order(fields: FormFields, limits: Limits): { order: FormationOrder } | { trouble: string } {
  const order: FormationOrder = { kind: "formation", order: fields.kind, preview: false };
  if (fields.kind !== "form") return { order };
  if (fields.shape === "") return { trouble: "choose a shape" };
  order.shape = fields.shape;
  const values = new Map<Figure, number>();
  for (const name of Object.keys(limit_of) as Figure[]) {
    const value = figure(fields, name, limits);
    if (typeof value === "string") return { trouble: value };
    if (value !== null) values.set(name, value);
  }
  const spacing = values.get("spacing");
  const heading = values.get("heading");
  const places = values.get("places");
  if (spacing !== undefined) order.spacing_m = spacing;
  if (heading !== undefined) order.heading_deg = heading;
  const [x, y, z] = [values.get("east"), values.get("north"), values.get("height")];
  if (x !== undefined && y !== undefined && z !== undefined) Object.assign(order, { x, y, z });
  else if (x !== undefined || y !== undefined || z !== undefined) return { trouble: "a place needs east, north and height" };
  if (places !== undefined) order.places = Math.trunc(places);
  return { order };
}

export function hazard_order(draft: { x: number; y: number; radius_m: number }): Order {
  const whole = (value: number) => Math.round(value) + 0;
  return { kind: "hazard", x: whole(draft.x), y: whole(draft.y), radius_m: whole(draft.radius_m) };
}

/** Texts of the fields of a site; an empty one is left to the template, or the site before. */
export interface SiteFields {
  like: string;
  east: string;
  north: string;
  bearings: string;
  interval: string;
  assessments: string;
  dwell: string;
  reward: string;
}

export const no_site: SiteFields = { like: "", east: "", north: "", bearings: "", interval: "", assessments: "", dwell: "", reward: "" };

const site_limit_of = {
  east: "coordinate_m",
  north: "coordinate_m",
  interval: "interval_s",
  assessments: "tasks",
  dwell: "dwell_s",
  reward: "reward",
} as const satisfies Partial<Record<keyof SiteFields, keyof Limits>>;

/** The order of a new site, or in place of one, or what is wrong with the fields. */
export function site_order(fields: SiteFields, limits: Limits, site: number | null): { order: SiteOrder } | { trouble: string } {
  const order: SiteOrder = { kind: "site", preview: false };
  const values: Partial<Record<keyof typeof site_limit_of, number>> = {};
  for (const name of Object.keys(site_limit_of) as (keyof typeof site_limit_of)[]) {
    const text = fields[name].trim();
    if (text === "") continue;
    const value = Number(text);
    const [low, high] = limits[site_limit_of[name]];
    if (!Number.isFinite(value) || value < low || value > high) return { trouble: `${name} is to be from ${low} to ${high}` };
    values[name] = value;
  }
  if (site !== null) order.site = site;
  if (values.east !== undefined && values.north !== undefined) Object.assign(order, { x: values.east, y: values.north });
  else if (site === null || values.east !== undefined || values.north !== undefined) return { trouble: "a site needs a place: east and north, or a press on the map" };
  if (fields.like !== "") order.like = fields.like;
  const bearings = fields.bearings.trim();
  if (bearings !== "") {
    const [low, high] = limits.heading_deg;
    const all = bearings === "none" ? [] : bearings.split(/[\s,]+/).map(Number);
    if (!all.every((value) => Number.isFinite(value) && value >= low && value <= high)) return { trouble: "bearings are compass degrees with commas between, such as 090, 180" };
    order.bearings_deg = all;
  }
  if (values.interval !== undefined) order.interval_s = values.interval;
  if (values.assessments !== undefined) order.assessments = Math.trunc(values.assessments);
  if (values.dwell !== undefined) order.dwell_s = values.dwell;
  if (values.reward !== undefined) order.reward = values.reward;
  return { order };
}

function words_of_site(order: SiteOrder): string {
  const words = [order.site === undefined ? "site" : `change site ${order.site}`];
  if (order.like !== undefined) words.push(`like ${order.like}`);
  if (order.x !== undefined) words.push(`at ${order.x} ${order.y}`);
  if (order.bearings_deg) words.push(`deliver ${order.bearings_deg.map(bearing_digits).join(",") || "none"}`);
  if (order.interval_s !== undefined) words.push(`every ${order.interval_s}`);
  if (order.assessments !== undefined) words.push(`assess ${order.assessments}`);
  if (order.dwell_s !== undefined) words.push(`dwell ${order.dwell_s}`);
  if (order.reward !== undefined) words.push(`reward ${order.reward}`);
  if (order.anyway) words.push("anyway");
  return words.join(" ");
}

export function command(command: Command["command"], vehicle: number): Command {
  return { kind: "command", command, vehicle };
}

export function command_to(command: CommandToSeveral["command"], vehicles: Iterable<number>): CommandToSeveral {
  return { kind: "commands", command, vehicles: [...vehicles].sort((a, b) => a - b) };
}

/** An order in words, for people. */
export function words_of_order(order: Order): string {
  switch (order.kind) {
    case "acknowledge":
      return `acknowledge ${order.alarms.join(" ")}`;
    case "command":
      return `${order.command.replaceAll("_", " ")} ${order.vehicle === 0 ? "all" : order.vehicle}`;
    case "commands":
      return `${order.command.replaceAll("_", " ")} ${ids(order.vehicles)}`;
    case "decision":
      return `${order.grant ? "authorise" : "refuse"} ${order.site}${order.override ? " override" : ""}`;
    case "take_command":
      return order.reason === "" ? "take command" : `take command ${order.reason}`;
    case "hand_over":
      return "hand over";
    case "hazard":
      return `${order.hazard === undefined ? "hazard" : `change hazard ${order.hazard}`} ${order.corners ? `polygon ${words_of_corners(order.corners)}` : `${order.x} ${order.y} ${order.radius_m}`}`;
    case "search":
      return [
        order.rest ? "search rest" : `search ${words_of_corners(order.corners ?? [])}`,
        ...(order.vehicles ? [`by ${order.vehicles.join(",")}`] : []),
        ...(order.spacing_m === undefined ? [] : [`spacing ${order.spacing_m}`]),
        ...(order.in_s === undefined ? [] : [`in ${order.in_s}`]),
      ].join(" ");
    case "fence":
      return `fence ${words_of_corners(order.corners)} height ${order.height_m}`;
    case "site":
      return words_of_site(order);
    case "withdraw":
      if (order.routes) return "withdraw routes";
      if (order.decision !== undefined) return `withdraw decision ${order.decision}`;
      return order.hazard === undefined ? `withdraw site ${order.site}` : `withdraw hazard ${order.hazard}`;
    case "proposal":
      return `${order.accept ? "accept" : "dismiss"} ${order.number}`;
    case "formation": {
      const words = [order.order.replaceAll("_", " "), order.shape];
      if (order.spacing_m !== undefined) words.push(`spacing ${order.spacing_m}`);
      if (order.heading_deg !== undefined) words.push(`heading ${bearing_digits(order.heading_deg)}`);
      if (order.x !== undefined) words.push(`at ${order.x} ${order.y} ${order.z}`);
      if (order.places !== undefined) words.push(`places ${order.places}`);
      return words.filter((word) => word !== undefined).join(" ");
    }
  }
}

/** Who flies the change that the formation was ordered, and who has not said so. */
export function acknowledgements(formation: Formation): { yes: number[]; no: number[]; lost: number[] } | null {
  const number = formation.change?.number;
  if (number === undefined) return null;
  const lost = formation.places.filter((place) => place.lost).map((place) => place.id);
  const there = formation.places.filter((place) => !place.lost);
  return {
    yes: there.filter((place) => place.change === number).map((place) => place.id),
    no: there.filter((place) => place.change !== number).map((place) => place.id),
    lost,
  };
}
