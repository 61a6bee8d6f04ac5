// SPDX-License-Identifier: Apache-2.0
// Orders: sent, answered, and the answer shown until it has been read.

import { signal } from "@preact/signals";
import type { Answer, DecidedPlan } from "../wire/protocol";
import { send } from "../wire/store";

export interface Notice {
  id: number;
  line: string;
  text: string;
  state: "sent" | "done" | "refused" | "note";
}

export const notices = signal<Notice[]>([]);
let next_id = 1;
const notices_kept = 4;

function put(notice: Notice): void {
  const others = notices.value.filter((one) => one.id !== notice.id);
  notices.value = [...others, notice].slice(-notices_kept);
}

export function dismiss(id: number): void {
  notices.value = notices.value.filter((one) => one.id !== id);
}

/** Something that the person should know and that no order has caused. */
export function note(text: string): void {
  const id = next_id++;
  put({ id, line: "", text, state: "note" });
  window.setTimeout(() => dismiss(id), 10_000);
}

export async function give(line: string, plan?: DecidedPlan): Promise<Answer> {
  const id = next_id++;
  put({ id, line, text: "sent", state: "sent" });
  const answer = await send(line, plan);
  put({ id, line, text: answer.text.trim() || (answer.done ? "done" : "refused"), state: answer.done ? "done" : "refused" });
  // A refusal stays until it is dismissed.
  if (answer.done) window.setTimeout(() => dismiss(id), 6000);
  return answer;
}

/** No confirmation: to stop where one is can always be taken back. */
export const hold_all = (): void => void give("hold all");
