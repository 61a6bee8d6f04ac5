// SPDX-License-Identifier: Apache-2.0
// What a vehicle's checks are shown as. Nothing is good, and nothing has its colour, that is not heard now.

import type { CheckMark, PreflightVehicle } from "../wire/protocol";

export interface Shown {
  sign: string;
  /** A class of the style sheet. */
  tone: "ok" | "warn" | "fail" | "flight" | "old" | "none";
  /** For who does not see it. */
  label: string;
}

const now_shown: Record<CheckMark, Shown> = {
  ok: { sign: "●", tone: "ok", label: "ok" },
  warn: { sign: "▲", tone: "warn", label: "warned" },
  fail: { sign: "!", tone: "fail", label: "fails" },
  not_looked_at: { sign: "–", tone: "none", label: "not looked at" },
  not_known: { sign: "·", tone: "none", label: "not known" },
};

const once_shown: Record<CheckMark, Shown> = {
  ok: { sign: "○", tone: "old", label: "was ok" },
  warn: { sign: "△", tone: "old", label: "had warned" },
  fail: { sign: "(!)", tone: "old", label: "had failed" },
  not_looked_at: now_shown.not_looked_at,
  not_known: now_shown.not_known,
};

/** `heard`: the ground station hears the vehicle, and we hear the ground station. */
export function shown_mark(mark: CheckMark, heard: boolean): Shown {
  return (heard ? now_shown : once_shown)[mark];
}

/** The vehicle as a whole. */
export function shown_vehicle(vehicle: PreflightVehicle, connected: boolean): Shown {
  if (!connected) return { sign: "○", tone: "old", label: "no connection" };
  switch (vehicle.readiness) {
    case "ready":
      return { sign: "●", tone: "ok", label: "ready" };
    case "in_flight":
      return { sign: "▶", tone: "flight", label: "armed or in the air" };
    case "not_known":
      return { sign: "○", tone: "old", label: `not known: ${vehicle.why}` };
    default:
      return { sign: "!", tone: vehicle.counts ? "fail" : "old", label: `not ready: ${vehicle.why}` };
  }
}

/** Since it was told: grows while nothing comes, whoever is silent. */
export function told_age_s(vehicle: PreflightVehicle, state_s: number | null, since_state_s: number): number | null {
  return vehicle.told_s === null || state_s === null ? null : Math.max(0, state_s + since_state_s - vehicle.told_s);
}
