// SPDX-License-Identifier: Apache-2.0
// Whether vehicles that were told to hold do so: an order that was sent is not one that is obeyed.

import { ids } from "../shell/format";
import type { Order, Vehicle } from "../wire/protocol";

/** Which vehicles an order tells to hold; null for other orders. */
export function told_to_hold(order: Order, vehicles: readonly Vehicle[]): number[] | null {
  if (order.kind === "commands") return order.command === "hold" ? order.vehicles : null;
  if (order.kind !== "command" || order.command !== "hold") return null;
  if (order.vehicle !== 0) return [order.vehicle];
  return vehicles.filter((vehicle) => vehicle.heard_age_s !== null).map((vehicle) => vehicle.id);
}

export interface HoldProgress {
  all: boolean;
  text: string;
}

// A vehicle of a formation that stops on its way goes on calling itself forming.
const at_rest_mps = 0.5;

function holds(vehicle: Vehicle | undefined): boolean {
  if (!vehicle || vehicle.silent) return false;
  if (vehicle.activity === "forming") return vehicle.groundspeed !== null && vehicle.groundspeed < at_rest_mps;
  return vehicle.activity === "holding";
}

export function hold_progress(told: readonly number[], vehicles: readonly Vehicle[]): HoldProgress {
  const known = new Map(vehicles.map((vehicle) => [vehicle.id, vehicle]));
  const missing = told.filter((id) => !holds(known.get(id)));
  const silent = missing.filter((id) => known.get(id)?.silent !== false);
  const text = `${told.length - missing.length} of ${told.length} hold`;
  if (missing.length === 0) return { all: true, text };
  const not_yet = `${text}; not yet ${ids(missing)}`;
  return { all: false, text: silent.length > 0 ? `${not_yet}; not heard: ${ids(silent)}` : not_yet };
}
