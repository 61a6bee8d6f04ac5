// SPDX-License-Identifier: Apache-2.0
// Orders, from the fields of a form.

import type { Command, Formation, FormationOrder, Limits, Order } from "../wire/protocol";

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

export function command(command: Command["command"], vehicle: number): Command {
  return { kind: "command", command, vehicle };
}

/** An order in words, for people. */
export function words_of_order(order: Order): string {
  switch (order.kind) {
    case "command":
      return `${order.command.replaceAll("_", " ")} ${order.vehicle === 0 ? "all" : order.vehicle}`;
    case "decision":
      return `${order.grant ? "authorise" : "refuse"} ${order.site}`;
    case "hazard":
      return `hazard ${order.x} ${order.y} ${order.radius_m}`;
    case "formation": {
      const words = [order.order.replaceAll("_", " "), order.shape];
      if (order.spacing_m !== undefined) words.push(`spacing ${order.spacing_m}`);
      if (order.heading_deg !== undefined) words.push(`heading ${order.heading_deg}`);
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
