// SPDX-License-Identifier: Apache-2.0
// Orders: sent, answered, and the answer shown until it has been read.

import { signal } from "@preact/signals";
import type { Answer, Order } from "../wire/protocol";
import { answers_text, given_of } from "../alarms/alarm_list";
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
const shown_ms = 6000;

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
  // A clock of the ground station that was heard just before.
  const since_s = (current().time_s ?? 0) - 0.5;
  put({ id, line, text: "sent", state: "sent" });
  const answer = await send(order);
  put({ id, line, text: answer.text.trim() || (answer.done ? "done" : "refused"), state: answer.done ? "done" : "refused" });
  // Its first line says that it was told, which is shown better by who obeys.
  const more = answer.text.trim().split("\n").slice(1).join("; ");
  if (answer.done && ["command", "commands", "decision"].includes(order.kind)) watch_answers(id, order, line, since_s, more);
  // A refusal stays until it is dismissed.
  else if (answer.done) window.setTimeout(() => dismiss(id), more === "" ? shown_ms : 2 * shown_ms);
  return answer;
}

const patience_ms = 10_000;

/** Shows who obeys, and how long that took, as the ground station finds it in what vehicles say. It stays until all do. */
function watch_answers(id: number, order: Order, line: string, since_s: number, more: string): void {
  const begun_ms = performance.now();
  const stop = on_picture(({ alarms }) => {
    const before = notices.value.find((notice) => notice.id === id);
    if (!before) return stop();
    const given = given_of(order, alarms?.orders ?? [], since_s);
    const waited_ms = performance.now() - begun_ms;
    if (!given) return waited_ms > shown_ms ? end() : undefined;
    const obeyed = given.waiting.length === 0;
    const state = obeyed ? "done" : waited_ms > patience_ms ? "refused" : "sent";
    const text = more === "" ? answers_text(given) : `${answers_text(given)}; ${more}`;
    if (before.text !== text || before.state !== state) put({ id, line, text, state });
    // Whom it asks is known a moment after it was given.
    if (obeyed && (given.answered.length > 0 || waited_ms > 1000)) end();
  });
  const end = () => {
    stop();
    window.setTimeout(() => dismiss(id), shown_ms);
  };
}

/** No confirmation: to stop where one is can always be taken back. */
export const hold_all = (): void => void give(command("hold", 0));
