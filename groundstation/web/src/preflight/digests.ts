// SPDX-License-Identifier: Apache-2.0
// What of the team is of one kind, and who is not.

import type { PreflightVehicle } from "../wire/protocol";

export const digest_names = ["release", "firmware", "parameters", "configuration"] as const;
export type DigestName = (typeof digest_names)[number];

/** Those that have the same value. */
export interface Kind {
  value: string;
  ids: number[];
  /** Whether they are the odd ones (the ground station says so). */
  odd: boolean;
  /** What is told of them is of now. */
  old: number[];
}

export interface Kinds {
  name: DigestName;
  kinds: Kind[];
  /** Those that have not told theirs. */
  unknown: number[];
}

/** Most first; the odd ones of a value are apart from those of whose airframe it is the usual one. */
export function kinds_of(vehicles: readonly PreflightVehicle[], name: DigestName): Kinds {
  const kinds = new Map<string, Kind>();
  const unknown: number[] = [];
  for (const vehicle of vehicles) {
    const value = vehicle[name];
    if (value === null) {
      unknown.push(vehicle.id);
      continue;
    }
    const odd = vehicle.odd.includes(name);
    const key = `${odd ? 1 : 0} ${value}`;
    const kind = kinds.get(key) ?? { value, ids: [], odd, old: [] };
    kinds.set(key, kind);
    kind.ids.push(vehicle.id);
    if (!vehicle.counts) kind.old.push(vehicle.id);
  }
  const all = [...kinds.values()].sort((a, b) => Number(a.odd) - Number(b.odd) || b.ids.length - a.ids.length || a.value.localeCompare(b.value));
  return { name, kinds: all, unknown };
}

/** Of one vehicle: in which of them it is odd, and which it has not told. */
export function tile_of(vehicle: PreflightVehicle): { odd: DigestName[]; unknown: DigestName[] } {
  const odd = digest_names.filter((name) => vehicle.odd.includes(name));
  return { odd, unknown: digest_names.filter((name) => vehicle[name] === null && name !== "firmware" && name !== "parameters") };
}

/** Of a digest the beginning tells which are alike. */
export function brief(text: string | null): string | undefined {
  return text && /^[0-9a-f]{8}$/.test(text) ? text.slice(0, 6) : (text ?? undefined);
}
