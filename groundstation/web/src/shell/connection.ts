// SPDX-License-Identifier: Apache-2.0
import { link, lost_at_ms } from "../wire/store";
import { tick } from "./ticker";

/** A page that has just begun to connect, or connects again, has lost nothing yet. */
const patience_s = 1.5;

/** Since the newest state of a connection that is lost, s; else 0. Changes with the ticker. */
export function lost_for_s(): number {
  void tick.value;
  if (link.value === "open" || lost_at_ms.value === null) return 0;
  const age_s = (performance.now() - lost_at_ms.value) / 1000;
  return age_s < patience_s ? 0 : age_s;
}
