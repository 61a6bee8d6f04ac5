// SPDX-License-Identifier: Apache-2.0
// Lines of the prompt, from the fields of a form.

import type { Formation } from "../wire/protocol";

export interface FormFields {
  kind: "take-off" | "rally" | "form" | "land";
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

const limits = {
  spacing: [0.5, 1000],
  heading: [-360, 360],
  east: [-1e5, 1e5],
  north: [-1e5, 1e5],
  height: [-1e5, 1e5],
  places: [1, 1000],
} as const;

function figure(fields: FormFields, name: keyof typeof limits): number | null | string {
  const text = fields[name].trim();
  if (text === "") return null;
  const value = Number(text);
  const [low, high] = limits[name];
  return Number.isFinite(value) && value >= low && value <= high ? value : `${name} is to be from ${low} to ${high}`;
}

/** The line, or what is wrong with the fields. */
export function formation_line(fields: FormFields): { line: string } | { trouble: string } {
  if (fields.kind !== "form") return { line: fields.kind };
  if (fields.shape === "") return { trouble: "choose a shape" };
  const values = new Map<keyof typeof limits, number>();
  for (const name of Object.keys(limits) as (keyof typeof limits)[]) {
    const value = figure(fields, name);
    if (typeof value === "string") return { trouble: value };
    if (value !== null) values.set(name, value);
  }
  let line = `form ${fields.shape}`;
  if (values.has("spacing")) line += ` spacing ${values.get("spacing")}`;
  if (values.has("heading")) line += ` heading ${values.get("heading")}`;
  const at = (["east", "north", "height"] as const).map((name) => values.get(name));
  if (at.some((value) => value !== undefined)) {
    if (at.some((value) => value === undefined)) return { trouble: "a place needs east, north and height" };
    line += ` at ${at.join(" ")}`;
  }
  if (values.has("places")) line += ` places ${Math.trunc(values.get("places")!)}`;
  return { line };
}

export function hazard_line(draft: { x: number; y: number; radius_m: number }): string {
  const whole = (value: number) => String(Math.round(value) + 0);
  return `hazard ${whole(draft.x)} ${whole(draft.y)} ${whole(draft.radius_m)}`;
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
