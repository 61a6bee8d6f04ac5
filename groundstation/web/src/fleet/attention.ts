// SPDX-License-Identifier: Apache-2.0
// Which vehicle needs the operator first, and why.

import { ids } from "../shell/format";
import type { Problem, Vehicle } from "../wire/protocol";

export type Health = "alarm" | "silent" | "warning" | "unheard" | "stale" | "well";

/** What is wrong with it, worst first; the server's words, and ours where it has none. */
export function problems_of(vehicle: Vehicle): Problem[] {
  if (vehicle.problems.length > 0) return vehicle.problems;
  if (vehicle.revoked) return [{ level: "alarm", text: "revoked" }];
  if (vehicle.duplicate) return [{ level: "alarm", text: "two vehicles with this id" }];
  if (vehicle.heard_age_s === null) return vehicle.expected ? [{ level: "warning", text: "never heard" }] : [];
  if (vehicle.silent) return [{ level: "alarm", text: "silent" }];
  if (!vehicle.expected) return [{ level: "warning", text: "not in the fleet" }];
  return [];
}

export function health_of(vehicle: Vehicle): Health {
  if (vehicle.stale) return "stale";
  const never = vehicle.heard_age_s === null && !vehicle.duplicate;
  if (never) return "unheard";
  const problems = problems_of(vehicle);
  if (vehicle.silent && !vehicle.duplicate) return "silent";
  if (problems.some((problem) => problem.level === "alarm")) return "alarm";
  return problems.length > 0 ? "warning" : "well";
}

const order: Record<Health, number> = { alarm: 0, silent: 1, warning: 2, unheard: 3, stale: 4, well: 5 };

/** 0: the worst. */
export function rank_of(vehicle: Vehicle): number {
  return order[health_of(vehicle)];
}

/** Worst first, and by id among equals. Figures that change with every state take no part: rows
 *  that jump cannot be read. */
export function by_attention(vehicles: readonly Vehicle[]): Vehicle[] {
  return [...vehicles].sort((a, b) => rank_of(a) - rank_of(b) || a.id - b.id);
}

/** What is wrong with the fleet as a whole, named. */
export function fleet_notes(vehicles: readonly Vehicle[]): string[] {
  const notes: string[] = [];
  const doubled = vehicles.filter((vehicle) => vehicle.duplicate).map((vehicle) => vehicle.id);
  if (doubled.length > 0) notes.push(`More than one vehicle with id ${ids(doubled)}: orders to it reach both`);
  const strangers = vehicles.filter((vehicle) => !vehicle.expected).map((vehicle) => vehicle.id);
  if (strangers.length > 0) notes.push(`Not in the fleet, but heard: ${ids(strangers)}`);
  const versions = new Map<string, number[]>();
  for (const { version, id } of vehicles) {
    if (!version) continue;
    const of = versions.get(version);
    if (of) of.push(id);
    else versions.set(version, [id]);
  }
  if (versions.size > 1) {
    const groups = [...versions].sort((a, b) => a[1].length - b[1].length || a[0].localeCompare(b[0]));
    const parts = groups.map(([version, of]) => `${version} on ${ids(of)}`);
    notes.push(`Versions differ: ${parts.join("; ")}`);
  }
  return notes;
}

/** Whether its version is one that fewer vehicles have than another. */
export function odd_versions(vehicles: readonly Vehicle[]): ReadonlySet<string> {
  const counts = new Map<string, number>();
  for (const { version } of vehicles) if (version) counts.set(version, (counts.get(version) ?? 0) + 1);
  const most = Math.max(0, ...counts.values());
  return new Set([...counts].filter(([, count]) => count < most).map(([version]) => version));
}
