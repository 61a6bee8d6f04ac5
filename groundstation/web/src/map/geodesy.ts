// SPDX-License-Identifier: Apache-2.0
// WGS84 and the mission's frame: the plane that touches the ellipsoid at the origin, as the ground
// station computes it. Points off the origin's height are taken at it, which is what a map shows.

import type { Origin } from "../wire/protocol";

export interface LatLon {
  latitude_deg: number;
  longitude_deg: number;
}

export interface Point {
  x: number;
  y: number;
}

const semi_major_m = 6378137;
const flattening = 1 / 298.257223563;
const eccentricity2 = flattening * (2 - flattening);
const rad = Math.PI / 180;

function earth_centred(latitude_deg: number, longitude_deg: number, height_m: number) {
  const sin = Math.sin(latitude_deg * rad);
  const cos = Math.cos(latitude_deg * rad);
  const normal = semi_major_m / Math.sqrt(1 - eccentricity2 * sin * sin);
  return [
    (normal + height_m) * cos * Math.cos(longitude_deg * rad),
    (normal + height_m) * cos * Math.sin(longitude_deg * rad),
    (normal * (1 - eccentricity2) + height_m) * sin,
  ] as const;
}

export class LocalFrame {
  private readonly base;
  private readonly sin_lat;
  private readonly cos_lat;
  private readonly sin_lon;
  private readonly cos_lon;

  constructor(readonly origin: Origin) {
    this.base = earth_centred(origin.latitude_deg, origin.longitude_deg, origin.height_m);
    this.sin_lat = Math.sin(origin.latitude_deg * rad);
    this.cos_lat = Math.cos(origin.latitude_deg * rad);
    this.sin_lon = Math.sin(origin.longitude_deg * rad);
    this.cos_lon = Math.cos(origin.longitude_deg * rad);
  }

  to_local(latitude_deg: number, longitude_deg: number): Point {
    const at = earth_centred(latitude_deg, longitude_deg, this.origin.height_m);
    const dx = at[0] - this.base[0];
    const dy = at[1] - this.base[1];
    const dz = at[2] - this.base[2];
    return {
      x: -this.sin_lon * dx + this.cos_lon * dy,
      y: -this.sin_lat * (this.cos_lon * dx + this.sin_lon * dy) + this.cos_lat * dz,
    };
  }

  /** The inverse, by Newton's steps with the radii at the origin; to a millimetre within 20 km. */
  to_wgs84(point: Point): LatLon {
    const { latitude_deg, longitude_deg } = this.origin;
    const curvature2 = 1 - eccentricity2 * this.sin_lat * this.sin_lat;
    const normal = semi_major_m / Math.sqrt(curvature2) + this.origin.height_m;
    const meridian = (semi_major_m * (1 - eccentricity2)) / curvature2 ** 1.5 + this.origin.height_m;
    const guess = { latitude_deg, longitude_deg };
    for (let step = 0; step < 6; ++step) {
      const there = this.to_local(guess.latitude_deg, guess.longitude_deg);
      guess.latitude_deg += (point.y - there.y) / meridian / rad;
      guess.longitude_deg += (point.x - there.x) / (normal * Math.cos(guess.latitude_deg * rad)) / rad;
    }
    return guess;
  }
}

/** Metres, and compass degrees of the direction from `a` to `b`. */
export function distance_and_bearing(a: Point, b: Point): { distance_m: number; bearing_deg: number } {
  const east = b.x - a.x;
  const north = b.y - a.y;
  const bearing_deg = (Math.atan2(east, north) / rad + 360) % 360;
  return { distance_m: Math.hypot(east, north), bearing_deg };
}

/** Where it is after `seconds` on a straight course. */
export function moved(from: Point, course_deg: number, speed: number, seconds: number): Point {
  const way = speed * seconds;
  return { x: from.x + way * Math.sin(course_deg * rad), y: from.y + way * Math.cos(course_deg * rad) };
}

/** Where a path of [x, y, t] is at `t`: between its points in a straight line, at its ends outside. */
export function on_path(points: readonly (readonly [number, number, number])[], t: number): Point | null {
  const first = points[0];
  const last = points[points.length - 1];
  if (!first || !last) return null;
  if (t <= first[2]) return { x: first[0], y: first[1] };
  if (t >= last[2]) return { x: last[0], y: last[1] };
  let low = 0;
  let high = points.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (points[middle]![2] <= t) low = middle;
    else high = middle;
  }
  const a = points[low]!;
  const b = points[high]!;
  const part = b[2] > a[2] ? (t - a[2]) / (b[2] - a[2]) : 0;
  return { x: a[0] + part * (b[0] - a[0]), y: a[1] + part * (b[1] - a[1]) };
}
