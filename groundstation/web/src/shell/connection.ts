// SPDX-License-Identifier: Apache-2.0
import { lost_s } from "../wire/store";

/** Since the newest state of a connection that is lost, s; else 0. */
export function lost_for_s(): number {
  return lost_s.value;
}
