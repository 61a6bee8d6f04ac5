// SPDX-License-Identifier: Apache-2.0
// The outline that a person draws: of a search area, a hazard or the fence. Corners are [east, north]
// in metres, in their order around it.

import { signal } from "@preact/signals";
import type { LocalFrame } from "../map/geodesy";

export type Corner = [east: number, north: number];
export type Outline = readonly Corner[];

export const corners_max = 32;

export const outline = signal<Outline>([]);
export type Use = "search" | "hazard" | "fence";
export const outline_use = signal<Use>("search");
/** The corner that is being dragged. */
export const held_corner = signal<number | null>(null);
/** The circles that would hold a hazard's outline, of its preview. */
export const cover_shown = signal<readonly (readonly [x: number, y: number, radius_m: number])[]>([]);

const whole = (value: number) => Math.round(value) + 0;

export function add_corner(to: Outline, east: number, north: number): Outline {
  return to.length < corners_max ? [...to, [whole(east), whole(north)]] : to;
}

export function move_corner(of: Outline, index: number, east: number, north: number): Outline {
  return of.map((corner, i) => (i === index ? [whole(east), whole(north)] : corner));
}

export function remove_corner(of: Outline, index: number): Outline {
  return of.filter((_, i) => i !== index);
}

/** The corner within that reach of a place, the nearest; null: none is. */
export function corner_at(of: Outline, east: number, north: number, reach_m: number): number | null {
  let nearest: number | null = null;
  let least = reach_m;
  of.forEach(([x, y], i) => {
    const away = Math.hypot(x - east, y - north);
    if (away > least) return;
    least = away;
    nearest = i;
  });
  return nearest;
}

function side(a: Corner, b: Corner, c: Corner): number {
  return Math.sign((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
}

function cross_each_other(a: Corner, b: Corner, c: Corner, d: Corner): boolean {
  return side(a, b, c) * side(a, b, d) <= 0 && side(c, d, a) * side(c, d, b) <= 0;
}

/** What is wrong with it, for people; null: nothing. The ground station looks again. */
export function why_no_outline(of: Outline): string | null {
  const n = of.length;
  if (n < 3) return `an outline has at least 3 corners, ${n === 0 ? "none are" : n === 1 ? "1 is" : "2 are"} drawn`;
  for (let i = 0; i < n; ++i) {
    for (let j = i + 2; j < n; ++j) {
      if (i === 0 && j === n - 1) continue;
      if (cross_each_other(of[i]!, of[i + 1]!, of[j]!, of[(j + 1) % n]!)) return "the outline crosses itself; put its corners in their order around it";
    }
  }
  return null;
}

export function area_m2(of: Outline): number {
  let twice = 0;
  of.forEach(([x, y], i) => {
    const [u, v] = of[(i + 1) % of.length]!;
    twice += x * v - y * u;
  });
  return Math.abs(twice) / 2;
}

/** Typed corners: "120,-40 300,20", with blanks, semicolons or new lines between them. */
export function typed_corners(text: string): { corners: Outline } | { trouble: string } {
  const words = text.split(/[\s;]+/).filter((word) => word !== "");
  const corners: Corner[] = [];
  for (const word of words) {
    const parts = word.split(",");
    const [east, north] = parts.map(Number);
    if (parts.length !== 2 || parts.some((part) => part === "") || !Number.isFinite(east) || !Number.isFinite(north)) {
      return { trouble: `a corner is EAST,NORTH in metres, such as 120,-40, not '${word.slice(0, 40)}'` };
    }
    corners.push([east!, north!]);
  }
  if (corners.length > corners_max) return { trouble: `an outline has at most ${corners_max} corners` };
  return { corners };
}

function is_list(value: unknown): value is unknown[] {
  return Array.isArray(value);
}

/** Outer rings as [longitude, latitude], or why there is none to be taken. */
type Rings = { rings: unknown[][] } | { trouble: string };

const holes = { trouble: "its polygon has holes, and an outline has none" };

function rings_of_polygon(coordinates: unknown): Rings {
  if (!is_list(coordinates) || !is_list(coordinates[0])) return { rings: [] };
  return coordinates.length > 1 ? holes : { rings: [coordinates[0]] };
}

function all_of(parts: readonly Rings[]): Rings {
  const rings: unknown[][] = [];
  for (const part of parts) {
    if ("trouble" in part) return part;
    rings.push(...part.rings);
  }
  return { rings };
}

/** Of every polygon, wherever the file has it. */
function rings_of(json: unknown): Rings {
  if (typeof json !== "object" || json === null) return { rings: [] };
  const file = json as Record<string, unknown>;
  const { coordinates, features } = file;
  switch (file["type"]) {
    case "Polygon":
      return rings_of_polygon(coordinates);
    case "MultiPolygon":
      return all_of((is_list(coordinates) ? coordinates : []).map(rings_of_polygon));
    case "Feature":
      return rings_of(file["geometry"]);
    case "FeatureCollection":
      return all_of((is_list(features) ? features : []).map(rings_of));
  }
  // A plan of QGroundControl: [latitude, longitude] of its fence.
  const fence = file["geoFence"] as { polygons?: { polygon?: unknown; inclusion?: unknown }[] } | undefined;
  const polygons = is_list(fence?.polygons) ? fence.polygons : [];
  if (polygons.some((one) => one.inclusion === false)) {
    return { trouble: "its polygon is to be kept out of, and an outline is of what lies within" };
  }
  return { rings: polygons.flatMap((one) => (is_list(one.polygon) ? [one.polygon.map((at) => (is_list(at) ? [at[1], at[0]] : at))] : [])) };
}

/** The outline in a GeoJSON file, or of the fence of a .plan file. */
export function outline_of_file(text: string, frame: LocalFrame): { corners: Outline } | { trouble: string } {
  let json: unknown;
  try {
    json = JSON.parse(text);
  } catch {
    return { trouble: "that is no JSON file" };
  }
  const found = rings_of(json);
  if ("trouble" in found) return found;
  if (found.rings.length > 1) return { trouble: `there are ${found.rings.length} polygons in it, and an outline is one` };
  const ring = found.rings[0];
  if (!ring) return { trouble: "there is no polygon in it: GeoJSON, or the fence of a .plan file, is read" };
  const corners: Corner[] = [];
  for (const at of ring) {
    const [longitude, latitude] = is_list(at) ? at : [];
    if (typeof longitude !== "number" || typeof latitude !== "number" || Math.abs(latitude) > 90 || Math.abs(longitude) > 180) {
      return { trouble: "a corner of its polygon is no place on earth" };
    }
    const local = frame.to_local(latitude, longitude);
    corners.push([Math.round(local.x * 10) / 10 + 0, Math.round(local.y * 10) / 10 + 0]);
  }
  const first = corners[0];
  const last = corners[corners.length - 1];
  // A ring of GeoJSON ends where it begins.
  if (first && last && corners.length > 1 && Math.hypot(first[0] - last[0], first[1] - last[1]) < 0.2) corners.pop();
  if (corners.length > corners_max) return { trouble: `its polygon has ${corners.length} corners, and ${corners_max} are the most` };
  const far = corners.some(([x, y]) => Math.hypot(x, y) > 1e5);
  if (far) return { trouble: "it lies further than 100 km from the mission's origin" };
  return { corners };
}

/** For the configuration of the ground station and of every vehicle. */
export function fence_yaml(of: Outline, height_m: number): string {
  const corners = of.map(([x, y]) => `    - [${x}, ${y}]`).join("\n");
  return `fence:\n  height_max_m: ${height_m}\n  corners:\n${corners}\n`;
}
