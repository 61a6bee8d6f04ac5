// SPDX-License-Identifier: Apache-2.0
// The picture as the page holds it. The map reads it at every state; panels read signals that change
// four times a second at most, since nobody reads faster and tables are dear to draw.

import { batch, computed, signal } from "@preact/signals";
import { token_in } from "../replay/address";
import { tick } from "../shell/ticker";
import { aged } from "./aged";
import { empty_picture, reduce } from "./picture";
import type { Picture } from "./picture";
import type { Answer, Order, FromServer, Session } from "./protocol";
import { ConsoleSocket } from "./socket";
import type { LinkState } from "./socket";
import { Tracks } from "./tracks";

const panels_every_ms = 250;
const plots_every_ms = 1000;

let picture: Picture = empty_picture();
let state_arrived_ms = 0;
const listeners = new Set<(picture: Picture) => void>();

export const tracks = new Tracks();
export const shown = signal<Picture>(picture);
/** Grows when `tracks` does, once a second at most. */
export const tracks_version = signal(0);
let tracks_shown_ms = 0;

export const link = signal<LinkState>("connecting");
/** When the picture stopped, in ms of performance.now(); null while the link is open. */
export const lost_at_ms = signal<number | null>(null);
export const session = signal<Session | "unknown" | "needed" | "token_needed">("unknown");

/** A page that has just begun to connect, or connects again, has lost nothing yet. */
const patience_s = 1.5;

/** Since the newest state of a connection that is lost, s; else 0. Changes with the ticker. */
export const lost_s = computed(() => {
  if (link.value === "open" || lost_at_ms.value === null) return 0;
  void tick.value;
  const age_s = (performance.now() - lost_at_ms.value) / 1000;
  return age_s < patience_s ? 0 : age_s;
});
/** What is shown, as old as it is. */
export const aged_picture = computed(() => aged(shown.value, lost_s.value));

export const hello = computed(() => shown.value.hello);
export const ended = computed(() => shown.value.ended);
export const vehicles = computed(() => aged_picture.value.vehicles);
export const sites = computed(() => shown.value.sites);
export const coalitions = computed(() => shown.value.coalitions);
export const authorisations = computed(() => aged_picture.value.authorisations);
export const hazards = computed(() => shown.value.hazards);
export const areas = computed(() => shown.value.areas);
export const fence = computed(() => shown.value.fence);
export const proposals = computed(() => shown.value.proposals);
export const formation = computed(() => shown.value.formation);
export const timeline = computed(() => shown.value.timeline);
export const audit = computed(() => shown.value.audit);
export const preflight = computed(() => shown.value.preflight);
export const links = computed(() => aged_picture.value.links);
export const wind = computed(() => aged_picture.value.wind);
export const traffic = computed(() => aged_picture.value.traffic);
export const replay = computed(() => shown.value.replay);
export const events = computed(() => shown.value.events);
export const in_replay = computed(() => Boolean(hello.value?.replay));
export const command_state = computed(() => shown.value.command);
export const team = computed(() => shown.value.team);
/** Whether this page is an operator's, who may take the command. */
export const is_operator = computed(() => hello.value?.role === "operator" && !in_replay.value);
/** Whether this page may give orders: an operator's, of the ground station that has the command. */
export const may_order = computed(() => is_operator.value && (command_state.value?.state ?? "commanding") === "commanding");

/** The newest picture, without waiting for the panels' turn. */
export function current(): Picture {
  return picture;
}

export function on_picture(listener: (picture: Picture) => void): () => void {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

/** Seconds of the mission's clock since the newest state; at most a second, lest a lost link moves. */
export function since_state_s(): number {
  if (picture.time_s === null) return 0;
  const rate = picture.replay ? (picture.replay.playing ? picture.replay.speed : 0) : 1;
  return Math.min(1, (performance.now() - state_arrived_ms) / 1000) * rate;
}

/** The mission goes on while the page hears nothing of it, but for one that has ended. */
export function mission_now_s(): number | null {
  if (picture.time_s === null) return null;
  const goes_on = lost_s.value > 0 && !picture.replay && !picture.ended;
  return picture.time_s + (goes_on ? (performance.now() - state_arrived_ms) / 1000 : since_state_s());
}

let panels_timer = 0;
let panels_at = 0;

function show_panels(): void {
  panels_timer = 0;
  panels_at = performance.now();
  shown.value = picture;
}

function receive(message: FromServer): void {
  const before = picture;
  picture = reduce(picture, message);
  if (picture.generation !== before.generation) {
    tracks.load([]);
    socket.restart();
  }
  if (message.type === "history" && picture.generation === before.generation) {
    tracks.load(message.series);
    tracks_version.value++;
  }
  if (message.type === "state") {
    state_arrived_ms = performance.now();
    if (message.vehicles && tracks.add(picture.vehicles, message.time_s) && state_arrived_ms - tracks_shown_ms > plots_every_ms) {
      tracks_shown_ms = state_arrived_ms;
      tracks_version.value++;
    }
  }
  if (picture === before && message.type !== "history") return;
  for (const listener of listeners) listener(picture);
  // What waits for a person, and what answers him, is shown at once.
  const urgent = picture.authorisations !== before.authorisations || picture.formation !== before.formation ||
    picture.hello !== before.hello || picture.command !== before.command || picture.ended !== before.ended || picture.replay !== before.replay;
  const wait = urgent ? 0 : panels_at + panels_every_ms - performance.now();
  if (wait <= 0) {
    window.clearTimeout(panels_timer);
    show_panels();
  } else if (panels_timer === 0) {
    panels_timer = window.setTimeout(show_panels, wait);
  }
}

const socket = new ConsoleSocket({
  on_message: receive,
  on_link: (state) =>
    batch(() => {
      link.value = state;
      if (state === "open") lost_at_ms.value = null;
      else lost_at_ms.value ??= state_arrived_ms;
    }),
  next_seq: () => picture.next_seq,
  on_refused: () => void ask_session(),
});

/** An order, or of a recording a line. */
export function send(what: Order | string): Promise<Answer> {
  return socket.ask(what);
}

const kToken = "skein_token";

/** What the address has behind its #, kept for as long as the tab: a ground station that starts anew has it, too. */
function take_token(): void {
  const found = token_in(location.hash);
  if (!found) return;
  sessionStorage.setItem(kToken, found.token);
  history.replaceState(null, "", location.pathname + location.search + found.rest);
}

/** Whether it has let us in. */
async function try_token(): Promise<boolean> {
  const token = sessionStorage.getItem(kToken);
  if (token === null) return false;
  if ((await post_login("", token)) === 200) return true;
  sessionStorage.removeItem(kToken);
  return false;
}

async function post_login(user: string, password: string): Promise<number> {
  const response = await fetch("/session", {
    method: "POST",
    headers: { "content-type": "application/json" },
    body: JSON.stringify({ user, password }),
  });
  return response.status;
}

let asked = 0;

/** Asks who we are. */
export async function ask_session(may_try_token = true): Promise<void> {
  const mine = ++asked;
  try {
    const response = await fetch("/session", { headers: { accept: "application/json" } });
    // An answer to an earlier question may come after a login.
    if (mine !== asked) return;
    if (response.status === 401) {
      const { asks } = (await response.json()) as { asks?: string };
      if (asks === "token" && may_try_token && (await try_token()) && mine === asked) return ask_session(false);
      socket.stop();
      session.value = asks === "token" ? "token_needed" : "needed";
      return;
    }
    if (response.ok) session.value = (await response.json()) as Session;
  } catch {
    // No server: the socket says so, and tries again.
  }
}

export async function log_in(user: string, password: string): Promise<string | null> {
  try {
    const status = await post_login(user, password);
    if (status === 401) return user ? "Name or password is wrong" : "That token is wrong";
    if (status !== 200) return `Refused (${status})`;
    if (!user) sessionStorage.setItem(kToken, password);
  } catch {
    return "The ground station does not answer";
  }
  await start();
  return null;
}

export async function log_out(): Promise<void> {
  await fetch("/session", { method: "DELETE" }).catch(() => undefined);
  sessionStorage.removeItem(kToken);
  socket.stop();
  session.value = "needed";
  await ask_session();
}

export async function start(): Promise<void> {
  take_token();
  await ask_session();
  if (session.value !== "needed" && session.value !== "token_needed") socket.start();
}

