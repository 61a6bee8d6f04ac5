// SPDX-License-Identifier: Apache-2.0
// What needs the operator, always in sight: how much of it, the worst, what to do, and the orders that
// may help.

import { useEffect } from "preact/hooks";
import { command } from "../orders/orders";
import { clock, duration } from "../shell/format";
import { give } from "../shell/give";
import { HoldButton } from "../shell/hold_button";
import { tick } from "../shell/ticker";
import type { Alarm } from "../wire/protocol";
import { in_replay, lost_s, may_order, mission_now_s } from "../wire/store";
import { acknowledge, alarm_counts, alarm_list, can_acknowledge, go_to, list_open, mute, muted_ms, set_volume, sound, sound_allowed, unmute, volume, watch_alarms, worst } from "./alarm_state";
import { closest_text, counts_text, is_open, lasted, own_number } from "./alarm_list";
import { least_volume } from "./sound";

const signs = { alarm: "!", warning: "▲", notice: "i" } as const;

function Sign({ alarm }: { alarm: Alarm }) {
  return (
    <span class={`alarm-sign ${alarm.over_s === null ? alarm.level : "over"}`} aria-hidden="true">
      {alarm.over_s === null ? signs[alarm.level] : "–"}
    </span>
  );
}

function Lasted({ alarm }: { alarm: Alarm }) {
  void tick.value;
  return <span class="figure muted">{alarm.over_s === null ? lasted(alarm, mission_now_s()) : `over at ${clock(alarm.over_s)}`}</span>;
}

const verbs = { hold: "Hold", resume: "Resume", return_home: "Return", give_back: "Give back", land: "Land" } as const;

/** To its vehicle, or to all. To stop can always be taken back: it needs no second thought. */
function Offers({ alarm }: { alarm: Alarm }) {
  if (!may_order.value || lost_s.value > 0 || alarm.over_s !== null) return null;
  return (
    <>
      {alarm.offers.map((kind, index) => {
        const to = alarm.vehicle ?? 0;
        const words = `${verbs[kind]} ${to === 0 ? "all" : to}`;
        const testid = `alarm-offer-${alarm.number}-${index}`;
        const order = () => void give(command(kind, to));
        return kind === "hold" ? (
          <button key={kind} type="button" class="stop" data-testid={testid} onClick={order}>
            {words}
          </button>
        ) : (
          <HoldButton key={kind} testid={testid} on_held={order}>
            {words}
          </HoldButton>
        );
      })}
    </>
  );
}

function AcknowledgeButton({ alarm }: { alarm: Alarm }) {
  if (!can_acknowledge.value.some(({ number }) => number === alarm.number)) return null;
  return (
    <button type="button" class="acknowledge" data-testid={`alarm-acknowledge-${alarm.number}`} aria-label={`Acknowledge: ${alarm.what}`} onClick={() => acknowledge([alarm])}>
      Acknowledge
    </button>
  );
}

function Closest({ alarm }: { alarm: Alarm }) {
  void tick.value;
  const text = closest_text(alarm, mission_now_s());
  return text === "" ? null : <b class="alarm-closest">; {text}</b>;
}

function What({ alarm, testid }: { alarm: Alarm; testid: string }) {
  return (
    <button type="button" class="alarm-what" data-testid={testid} onClick={() => go_to(alarm)} title="Show it, and where to act">
      <span>
        {alarm.what}
        <Closest alarm={alarm} />
        {alarm.times > 1 && ` (${alarm.times} times)`}
      </span>
      {alarm.remedy && alarm.over_s === null && <span class="alarm-remedy">{alarm.remedy}</span>}
      {alarm.acknowledged && <span class="muted">acknowledged by {alarm.acknowledged.by}</span>}
    </button>
  );
}

function Sound() {
  if (in_replay.value) return null;
  return (
    <div class="alarm-sound">
      {!sound_allowed.value && (
        <button type="button" class="sound-off" data-testid="sound-on" onClick={() => void sound.allow()}>
          Sound is off: switch it on
        </button>
      )}
      {sound_allowed.value && muted_ms.value > 0 && (
        <button type="button" class="sound-off" data-testid="unmute" onClick={unmute}>
          Muted for {duration(muted_ms.value / 1000)}: unmute
        </button>
      )}
      {sound_allowed.value && muted_ms.value === 0 && (
        <>
          <label class="volume">
            <span class="only-spoken">Volume of alarms</span>
            <input type="range" min={least_volume} max={1} step={0.1} value={volume.value} data-testid="volume" onInput={(event) => set_volume(Number(event.currentTarget.value))} />
          </label>
          <button type="button" class="quiet" data-testid="mute" onClick={mute} title="For ten minutes at most">
            Mute
          </button>
        </>
      )}
    </div>
  );
}

function AlarmList() {
  const can = can_acknowledge.value;
  return (
    <div class="alarm-list scroll" id="alarm-list" role="region" aria-label="All alarms" tabIndex={0} data-testid="alarm-list">
      {can.length > 1 && (
        <button type="button" class="acknowledge" data-testid="alarm-acknowledge-all" onClick={() => acknowledge(can)}>
          Acknowledge all {can.length}
        </button>
      )}
      {alarm_list.value.length === 0 && <p class="empty">Nothing needs you now.</p>}
      <ul>
        {alarm_list.value.map((alarm) => (
          <li key={`${alarm.number} ${alarm.key}`} class={`alarm-row ${alarm.over_s === null ? alarm.level : "over"}${is_open(alarm) ? " open" : ""}`} data-testid={`alarm-${alarm.key}`} data-number={alarm.number}>
            <Sign alarm={alarm} />
            <What alarm={alarm} testid={`alarm-go-${alarm.number}`} />
            <Lasted alarm={alarm} />
            {alarm.number !== worst.value?.number && <Offers alarm={alarm} />}
            {alarm.number !== worst.value?.number && <AcknowledgeButton alarm={alarm} />}
          </li>
        ))}
      </ul>
    </div>
  );
}

export function AlarmBar() {
  useEffect(watch_alarms, []);
  const alarm = worst.value;
  const calls = alarm !== null && is_open(alarm) && alarm.over_s === null;
  return (
    <section class={`alarms ${alarm === null ? "none" : alarm.over_s === null ? alarm.level : "over"}${calls ? " open" : ""}`} aria-label="Alarms" data-testid="alarms">
      <div class="alarm-bar" data-testid="alarm-bar">
        <button type="button" class="alarm-counts" aria-expanded={list_open.value} aria-controls="alarm-list" data-testid="alarm-counts" onClick={() => (list_open.value = !list_open.value)}>
          <b>{counts_text(alarm_counts.value)}</b>
          {alarm_counts.value.open > 0 && <span>{alarm_counts.value.open} to acknowledge</span>}
        </button>
        {alarm && (
          <>
            <Sign alarm={alarm} />
            <What alarm={alarm} testid="alarm-worst" />
            <Lasted alarm={alarm} />
            {/* Another alarm has buttons of its own: no hand or focus stays on them. */}
            <Offers key={`offers ${alarm.number}`} alarm={alarm} />
            <AcknowledgeButton key={`acknowledge ${alarm.number}`} alarm={alarm} />
          </>
        )}
        <span class="grow" />
        <Sound />
      </div>
      {list_open.value && <AlarmList />}
      <div class="only-spoken" role="alert" data-testid="spoken-connection">
        {alarm_list.value.find(({ number }) => number === own_number)?.what}
      </div>
    </section>
  );
}
