// SPDX-License-Identifier: Apache-2.0
import { clock, words } from "../shell/format";
import type { Vehicle } from "../wire/protocol";

export function task_text(vehicle: Vehicle): string {
  const { task } = vehicle;
  if (!task) return "–";
  const what = `S${task.site} ${words(task.kind)}${task.kind === "survey" ? "" : ` ${task.index + 1}`}`;
  return task.time_s === null ? what : `${what} ${clock(task.time_s)}`;
}
