// SPDX-License-Identifier: Apache-2.0
// What the page holds of alarms besides the ground station's list: the sound, who has muted it, and
// what a press on one does.

import { computed, effect, signal } from "@preact/signals";
import { request_key } from "../mission/requests";
import { note } from "../shell/give";
import { map_in_front } from "../shell/layout";
import { tick } from "../shell/ticker";
import { highlighted_request, panel, panels, place_to_show, select } from "../shell/view";
import type { Panel } from "../shell/view";
import type { Alarm } from "../wire/protocol";
import { current, ended, hello, in_replay, lost_s, mission_now_s, is_operator, may_order, send, shown } from "../wire/store";
import { connection_alarm, counts_of, in_hand, is_open, own_number, sound_of, title_of } from "./alarm_list";
import { AlarmSound, mute_ms, muted_for, volume_in_range } from "./sound";

export const list_open = signal(false);
/** The operator of this page knows that it has no connection. */
const loss_known = signal(false);

/** All, the worst first. */
export const alarm_list = computed<readonly Alarm[]>(() => {
  const theirs = shown.value.alarms?.list ?? [];
  if (ended.value && lost_s.value > 0) return [];
  const own = in_replay.value ? null : connection_alarm(lost_s.value, mission_now_s() ?? 0, loss_known.value);
  return own ? [own, ...theirs] : theirs;
});
export const alarm_counts = computed(() => counts_of(alarm_list.value));
/** The alarm that the operator has gone to last. */
const taken = signal<number | null>(null);
export const worst = computed(() => in_hand(alarm_list.value, taken.value));
/** Those that this page can acknowledge now. */
export const can_acknowledge = computed(() => alarm_list.value.filter((alarm) => is_open(alarm) && (alarm.number === own_number || (is_operator.value && lost_s.value === 0))));

/** What comes of it is seen in the list. */
async function say_acknowledged(alarms: number[]): Promise<void> {
  const answer = await send({ kind: "acknowledge", alarms });
  if (!answer.done) note(answer.text);
}

/** The one in the bar: never another that has just come. */
export function acknowledge_shown(): void {
  acknowledge(can_acknowledge.value.filter(({ number }) => number === worst.value?.number));
}

export function acknowledge(alarms: readonly Alarm[]): void {
  if (alarms.some(({ number }) => number === own_number)) loss_known.value = true;
  const numbers = alarms.map(({ number }) => number).filter((number) => number !== own_number);
  if (numbers.length > 0) void say_acknowledged(numbers.slice(0, 300));
}

/** Shows what an alarm is about, on the map and in the lists, and where one acts. */
export function go_to(alarm: Alarm): void {
  taken.value = alarm.number;
  const { vehicles, sites, authorisations } = current();
  const vehicle = vehicles.find(({ id }) => id === alarm.vehicle);
  const site = sites.find(({ id }) => id === alarm.site);
  const request = authorisations.find((one) => one.waiting && one.site === alarm.site);
  if (vehicle) select(vehicle.id);
  const at = request ?? site ?? vehicle;
  if (at && at.x !== null && at.y !== null) place_to_show.value = { x: at.x, y: at.y };
  const wanted = alarm.panel === "decisions" ? "mission" : alarm.panel;
  const there = panels.includes(wanted as Panel) && (wanted !== "orders" || may_order.value);
  panel.value = there ? (wanted as Panel) : "fleet";
  if (request && alarm.panel === "decisions") highlighted_request.value = request_key(request);
  map_in_front.value = false;
  bring_to_hand(alarm, request !== undefined && alarm.panel === "decisions");
}

const drawn_every_ms = 60;
const drawn_tries = 20;

/** After the panel is drawn, which a busy machine may take a while for. */
function bring_to_hand(alarm: Alarm, decides: boolean, tries = drawn_tries): void {
  window.setTimeout(() => {
    if (taken.value !== alarm.number) return;
    const decision = decides ? element_of(`authorise-${alarm.site}`) : null;
    if (decides && !decision && tries > 0) bring_to_hand(alarm, decides, tries - 1);
    else focus_on(alarm, decision);
  }, drawn_every_ms);
}

function element_of(id: string): HTMLElement | null {
  return document.querySelector<HTMLElement>(`[data-testid="${id}"]`);
}

function focus_on(alarm: Alarm, decision: HTMLElement | null): void {
  const row = element_of(alarm.vehicle === null ? `site-${alarm.site}` : `vehicle-${alarm.vehicle}`);
  row?.scrollIntoView({ block: "nearest" });
  const act = decision ?? element_of(`alarm-offer-${alarm.number}-0`) ?? element_of(`alarm-acknowledge-${alarm.number}`);
  act?.focus();
  act?.scrollIntoView({ block: "nearest" });
}

// --- sound ---

/** Grows with everything that is heard or is not. */
const sound_version = signal(0);
export const sound = new AlarmSound(
  () => new AudioContext(),
  () => {
    sound_version.value++;
    tell_document();
  },
);

const volume_key = "skein.volume";
export const volume = signal(volume_in_range(Number(localStorage.getItem(volume_key) ?? Number.NaN)));
sound.volume = volume.value;

export function set_volume(value: number): void {
  volume.value = sound.volume = volume_in_range(value);
  localStorage.setItem(volume_key, String(volume.value));
}

const mute_key = computed(() => `skein.muted.${hello.value?.user ?? ""}`);
const muted_until_ms = signal<number | null>(null);
effect(() => {
  const stored = localStorage.getItem(mute_key.value);
  muted_until_ms.value = stored === null ? null : Number(stored);
});

/** For so long nothing is heard, ms; 0: it is. */
export const muted_ms = computed(() => {
  void tick.value;
  return muted_for(muted_until_ms.value, Date.now());
});
const is_muted = computed(() => muted_ms.value > 0);
export const sound_allowed = computed(() => {
  void sound_version.value;
  return sound.allowed;
});

export function mute(): void {
  const until = Date.now() + mute_ms;
  localStorage.setItem(mute_key.value, String(until));
  muted_until_ms.value = until;
}
export function unmute(): void {
  localStorage.removeItem(mute_key.value);
  muted_until_ms.value = null;
}

/** Without connection only that is heard: what was told before nobody can acknowledge here. */
const wanted_sound = computed(() => {
  if (in_replay.value || is_muted.value) return null;
  return sound_of(lost_s.value > 0 ? alarm_list.value.filter(({ number }) => number === own_number) : alarm_list.value);
});
const title = computed(() => (in_replay.value ? "Skein" : title_of(alarm_counts.value)));

function tell_document(): void {
  const { dataset } = document.documentElement;
  dataset["sounding"] = sound.sounding ?? "nothing";
  dataset["bursts"] = String(sound.bursts);
}

/** Once, when the page begins. */
export function watch_alarms(): () => void {
  const allow = () => {
    if (!sound.allowed) void sound.allow();
  };
  window.addEventListener("pointerdown", allow);
  window.addEventListener("keydown", allow);
  const ends = [
    effect(() => sound.play(wanted_sound.value)),
    effect(() => {
      document.title = title.value;
    }),
    effect(() => {
      if (lost_s.value === 0) loss_known.value = false;
    }),
    () => window.removeEventListener("pointerdown", allow),
    () => window.removeEventListener("keydown", allow),
  ];
  tell_document();
  return () => ends.forEach((end) => end());
}
