// SPDX-License-Identifier: Apache-2.0
import { clock, words } from "../shell/format";
import type { Vehicle } from "../wire/protocol";

/** What it does, and what besides: "holding by order, keeping clear of traffic". */
export function state_text(vehicle: Vehicle): string {
  return vehicle.besides ? `${words(vehicle.state)}, ${words(vehicle.besides)}` : words(vehicle.state);
}

export function task_text(vehicle: Vehicle): string {
  const { task } = vehicle;
  if (!task) return "–";
  const what = `S${task.site} ${words(task.kind)}${task.kind === "survey" ? "" : ` ${task.index + 1}`}`;
  return task.time_s === null ? what : `${what} ${clock(task.time_s)}`;
}
