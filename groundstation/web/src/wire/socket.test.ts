// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import { backoff_ms } from "./backoff";
import type { FromServer } from "./protocol";
import { ConsoleSocket } from "./socket";
import { command } from "../orders/orders";

/** A socket whose other end is the test. */
class FakeSocket {
  static readonly OPEN = 1;
  static all: FakeSocket[] = [];
  readyState = 0;
  sent: { type: string; [field: string]: unknown }[] = [];
  onopen: (() => void) | null = null;
  onmessage: ((event: { data: string }) => void) | null = null;
  onclose: (() => void) | null = null;
  constructor(readonly url: string, readonly protocol: string) {
    FakeSocket.all.push(this);
  }
  send(text: string): void {
    this.sent.push(JSON.parse(text));
  }
  open(): void {
    this.readyState = 1;
    this.onopen?.();
  }
  close(): void {
    this.readyState = 3;
    this.onclose?.();
  }
  says(message: FromServer): void {
    this.onmessage?.({ data: JSON.stringify(message) });
  }
}

let timers: (() => void)[] = [];
// What the browser gives; timers run when the test says so.
Object.assign(globalThis, {
  WebSocket: FakeSocket,
  location: { protocol: "http:", host: "ground" },
  window: {
    setTimeout: (then: () => void) => timers.push(then),
    clearTimeout: (timer: number) => delete timers[timer - 1],
    setInterval: () => 0,
    addEventListener: () => undefined,
  },
});

let next_seq = 0;
let links: string[] = [];
function a_socket() {
  const messages: FromServer[] = [];
  const socket = new ConsoleSocket({
    on_message: (message) => messages.push(message),
    on_link: (state) => links.push(state),
    next_seq: () => next_seq,
    on_refused: () => links.push("refused"),
  });
  socket.start();
  return { socket, messages };
}
const newest = () => FakeSocket.all[FakeSocket.all.length - 1]!;

beforeEach(() => {
  FakeSocket.all = [];
  timers = [];
  links = [];
  next_seq = 0;
});

const history = { type: "history" as const, series: [], events: { first_seq: 0, next_seq: 0 } };

test("a connection says first which event it wants, and again after a loss", () => {
  a_socket();
  assert.equal(newest().url, "ws://ground/socket");
  newest().open();
  assert.deepEqual(newest().sent, [{ type: "resume", next_seq: 0 }]);
  assert.deepEqual(links, ["connecting"], "not before its history has come");
  newest().says(history);
  next_seq = 17;
  newest().close();
  timers.forEach((then) => then());
  assert.equal(FakeSocket.all.length, 2);
  newest().open();
  assert.deepEqual(newest().sent, [{ type: "resume", next_seq: 17 }]);
  newest().says(history);
  assert.deepEqual(links, ["connecting", "open", "lost", "lost", "open"]);
});

const decision = { kind: "decision", site: 3, grant: true, coalition: "1-0-1", round: 2 } as const;

test("answers find their orders, in whatever order they come", async () => {
  const { socket, messages } = a_socket();
  newest().open();
  const hold = socket.ask(command("hold", 0));
  const grant = socket.ask(decision);
  const [, first, second] = newest().sent;
  assert.deepEqual(second, { type: "order", id: second!["id"], order: decision });
  newest().says({ type: "answer", id: second!["id"] as number, done: false, text: "another plan waits", data: null });
  newest().says({ type: "answer", id: first!["id"] as number, done: true, text: "sent", data: null });
  assert.equal((await hold).text, "sent");
  assert.equal((await grant).done, false);
  assert.deepEqual(messages, []);
});

test("an order that cannot be sent, or whose answer is lost, says so", async () => {
  const { socket } = a_socket();
  assert.match((await socket.ask(command("hold", 0))).text, /not sent/);
  newest().open();
  const hold = socket.ask(command("hold", 0));
  newest().close();
  const answer = await hold;
  assert.equal(answer.done, false);
  assert.match(answer.text, /not known/);
});

test("a connection that is not taken may want a login", () => {
  a_socket();
  newest().close();
  assert.deepEqual(links, ["connecting", "lost", "refused"]);
});

test("attempts come less and less often, but never rarer than an operator can wait", () => {
  assert.ok(backoff_ms(0, 0.5) <= 250);
  assert.ok(backoff_ms(3, 0.5) > backoff_ms(1, 0.5));
  assert.ok(backoff_ms(1000, 0.999) <= 6250);
});
