// SPDX-License-Identifier: Apache-2.0
// The connection to skein-ground: connects, connects again, and pairs lines with their answers.

import { backoff_ms } from "./backoff";
import type { Answer, FromServer, Order } from "./protocol";

export type LinkState = "connecting" | "open" | "lost";

export interface SocketHandlers {
  on_message(message: FromServer): void;
  on_link(state: LinkState): void;
  /** Which event is wanted next; 0 for all. */
  next_seq(): number;
  /** The server takes no socket without a session. */
  on_refused(): void;
}

interface Waiting {
  settle(answer: Answer): void;
  timer: number;
}

const subprotocol = "skein.console.1";
const answer_within_ms = 8000;
// Alive, a server sends ten states a second; a link that says nothing for so long is dead even
// where TCP has not noticed.
const silence_ms = 4000;
const ping_every_ms = 1500;

export class ConsoleSocket {
  private socket: WebSocket | null = null;
  private attempt = 0;
  private next_id = 1;
  private waiting = new Map<number, Waiting>();
  private heard_at = 0;
  private watched_at = Date.now();
  private retry = 0;
  private stopped = false;

  constructor(private readonly handlers: SocketHandlers) {
    window.setInterval(() => this.watch(), ping_every_ms);
    window.addEventListener("online", () => this.connect_now());
  }

  start(): void {
    this.stopped = false;
    this.connect_now();
  }

  stop(): void {
    this.stopped = true;
    window.clearTimeout(this.retry);
    this.socket?.close();
  }

  /** Drops the connection and makes a new one, which asks for events anew. */
  restart(): void {
    this.attempt = 0;
    this.socket?.close();
  }

  /** An order, or a line of the prompt. Never rejects: what could not be sent, or was not answered,
   *  is an answer that says so. */
  ask(what: Order | string): Promise<Answer> {
    const id = this.next_id++;
    return new Promise((resolve) => {
      const not_done = (text: string) => resolve({ type: "answer", id, done: false, text, data: null });
      if (this.socket?.readyState !== WebSocket.OPEN) {
        not_done("not sent: there is no connection to the ground station");
        return;
      }
      const timer = window.setTimeout(() => {
        this.waiting.delete(id);
        not_done("no answer came: it is not known whether the order was given; see the audit log");
      }, answer_within_ms);
      this.waiting.set(id, { settle: resolve, timer });
      const said = typeof what === "string" ? { type: "line", id, line: what } : { type: "order", id, order: what };
      this.socket.send(JSON.stringify(said));
    });
  }

  private connect(): void {
    window.clearTimeout(this.retry);
    this.handlers.on_link(this.attempt === 0 ? "connecting" : "lost");
    const scheme = location.protocol === "https:" ? "wss" : "ws";
    const socket = new WebSocket(`${scheme}://${location.host}/socket`, subprotocol);
    this.socket = socket;
    let opened = false;
    socket.onopen = () => {
      opened = true;
      this.attempt = 0;
      this.heard_at = Date.now();
      socket.send(JSON.stringify({ type: "resume", next_seq: this.handlers.next_seq() }));
    };
    socket.onmessage = (event) => {
      this.heard_at = Date.now();
      this.receive(JSON.parse(event.data as string) as FromServer);
    };
    socket.onclose = () => {
      if (this.socket !== socket) return;
      this.socket = null;
      this.fail_waiting();
      this.handlers.on_link("lost");
      if (this.stopped) return;
      if (!opened) this.handlers.on_refused();
      this.retry = window.setTimeout(() => this.connect(), backoff_ms(this.attempt++, Math.random()));
    };
  }

  private connect_now(): void {
    if (this.socket || this.stopped) return;
    this.connect();
  }

  private receive(message: FromServer): void {
    if (message.type !== "answer") {
      // Not before: a hello of another run of the server makes us connect anew.
      if (message.type === "history") this.handlers.on_link("open");
      this.handlers.on_message(message);
      return;
    }
    const waiting = this.waiting.get(message.id);
    if (!waiting) return;
    this.waiting.delete(message.id);
    window.clearTimeout(waiting.timer);
    waiting.settle(message);
  }

  private fail_waiting(): void {
    for (const [id, waiting] of this.waiting) {
      window.clearTimeout(waiting.timer);
      const text = "the connection was lost: it is not known whether the order was given; see the audit log";
      waiting.settle({ type: "answer", id, done: false, text, data: null });
    }
    this.waiting.clear();
  }

  private watch(): void {
    const socket = this.socket;
    // A page that was busy or asleep itself has not listened: what came meanwhile waits behind this.
    const was_away = Date.now() - this.watched_at > 2 * ping_every_ms;
    this.watched_at = Date.now();
    if (was_away) this.heard_at = Date.now();
    if (socket?.readyState !== WebSocket.OPEN) return;
    if (Date.now() - this.heard_at > silence_ms) {
      // close() would wait for the other side's word, which may never come.
      socket.onclose?.(new CloseEvent("close"));
      socket.onclose = null;
      socket.onmessage = null;
      socket.close();
    } else {
      socket.send(JSON.stringify({ type: "ping", id: this.next_id++ }));
    }
  }
}
