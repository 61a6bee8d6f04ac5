// SPDX-License-Identifier: Apache-2.0
// Orders: sent, answered, and the answer shown until it has been read.

import { signal } from "@preact/signals";
import type { Answer, Order } from "../wire/protocol";
import { hold_progress, told_to_hold } from "../orders/hold_watch";
import { command, words_of_order } from "../orders/orders";
import { current, on_picture, send } from "../wire/store";

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
  const known = notices.value.some((one) => one.id === notice.id);
  const all = known ? notices.value.map((one) => (one.id === notice.id ? notice : one)) : [...notices.value, notice];
  notices.value = all.slice(-notices_kept);
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

export async function give(order: Order): Promise<Answer> {
  const id = next_id++;
  const line = words_of_order(order);
  put({ id, line, text: "sent", state: "sent" });
  const answer = await send(order);
  put({ id, line, text: answer.text.trim() || (answer.done ? "done" : "refused"), state: answer.done ? "done" : "refused" });
  const told = answer.done ? told_to_hold(order, current().vehicles) : null;
  if (told) watch_hold(id, line, told);
  // A refusal stays until it is dismissed.
  else if (answer.done) window.setTimeout(() => dismiss(id), 6000);
  return answer;
}

const hold_within_ms = 6000;

/** Shows who holds until all do; and if some do not in time, until it is dismissed. */
function watch_hold(id: number, line: string, told: number[]): void {
  const begun_ms = performance.now();
  const stop = on_picture(({ vehicles }) => {
    const { all, text } = hold_progress(told, vehicles);
    const late = performance.now() - begun_ms > hold_within_ms;
    const before = notices.value.find((notice) => notice.id === id);
    if (!before) return stop();
    const state = all ? "done" : late ? "refused" : "sent";
    if (before.text !== text || before.state !== state) put({ id, line, text, state });
    if (!all) return;
    stop();
    window.setTimeout(() => dismiss(id), 6000);
  });
}

/** No confirmation: to stop where one is can always be taken back. */
export const hold_all = (): void => void give(command("hold", 0));
