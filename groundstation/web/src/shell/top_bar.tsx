// SPDX-License-Identifier: Apache-2.0
import { aged_picture, ended, hello, in_replay, link, log_out, lost_s, may_order, mission_now_s, session, shown } from "../wire/store";
import { list_open } from "../alarms/alarm_state";
import { CommandMark } from "../command/command_banner";
import { TeamMark } from "../command/team_state";
import { count_alarms } from "./alarms";
import { clock, utc } from "./format";
import { hold_all } from "./give";
import { map_in_front, narrow } from "./layout";
import { Menu } from "./menu";
import { tick } from "./ticker";
import { help_open, panel, switch_theme, theme } from "./view";

function MissionClock() {
  void tick.value;
  return (
    <span class="clock" data-testid="mission-time" aria-label="Mission time">
      {clock(shown.value.time_s === null ? null : mission_now_s(), 1)}
    </span>
  );
}

function DayClock({ testid = "utc" }: { testid?: string }) {
  void tick.value;
  const epoch_unix_s = hello.value?.epoch_unix_s ?? null;
  if (epoch_unix_s === null || shown.value.time_s === null) return null;
  return (
    <span class="figure muted" data-testid={testid} title="Time of day">
      {utc(mission_now_s(), epoch_unix_s)}
    </span>
  );
}

function SeldomUsed() {
  const greeting = hello.value;
  return (
    <>
      {greeting && (
        <span class="who" data-testid="who">
          {greeting.user || "operator"} · {in_replay.value ? "replay" : greeting.role}
        </span>
      )}
      {typeof session.value === "object" && session.value.login && (
        <button type="button" class="quiet" data-testid="log-out" onClick={() => void log_out()}>
          Log out
        </button>
      )}
      <button type="button" class="quiet" data-testid="theme" onClick={switch_theme} title="Day and night colours (N)">
        {theme.value === "night" ? "Day" : "Night"}
      </button>
      <button type="button" class="quiet" data-testid="help-open" onClick={() => (help_open.value = true)} title="Keys and words (?)">
        Help
      </button>
    </>
  );
}

/** To what needs attention, whatever is in front. */
function show_fleet(): void {
  panel.value = "fleet";
  map_in_front.value = false;
}

const link_words = { open: "connected", connecting: "connecting", lost: "no connection" } as const;

export function TopBar() {
  const counts = count_alarms(aged_picture.value);
  const is_old = lost_s.value > 0;
  const greeting = hello.value;
  return (
    <header class="top-bar">
      <h1 class="brand" title={greeting?.program}>
        Skein
      </h1>
      <MissionClock />
      <DayClock />
      <span class={`link-state ${link.value}`} data-testid="link-state">
        <span class="dot" aria-hidden="true" />
        <span class="words">{link.value !== "open" && ended.value ? "ended" : link_words[link.value]}</span>
      </span>
      <CommandMark />
      <TeamMark />
      {greeting?.sealed === false && (
        <span class="link-state lost" data-testid="in-clear" title="Whoever reaches the mission network can read and command it">
          <span class="dot" aria-hidden="true" />
          network in clear
        </span>
      )}
      <button type="button" class="count" data-testid="count-heard" onClick={show_fleet} title="Vehicles heard, of those expected">
        <b>
          {is_old ? "–" : counts.heard}/{counts.expected}
        </b>{" "}
        heard
      </button>
      <button type="button" class={`count${counts.alarms ? " alarm" : ""}`} data-testid="count-alarms" onClick={() => (list_open.value = true)}>
        <b>{is_old ? "–" : counts.alarms}</b> {counts.alarms === 1 ? "alarm" : "alarms"}
      </button>
      <button type="button" class={`count${counts.warnings ? " warning" : ""}`} data-testid="count-warnings" onClick={() => (list_open.value = true)}>
        <b>{is_old ? "–" : counts.warnings}</b> {counts.warnings === 1 ? "warning" : "warnings"}
      </button>
      <span class="grow" />
      {narrow.value ? (
        <Menu label="Menu" testid="menu">
          <SeldomUsed />
          <DayClock testid="utc-in-menu" />
        </Menu>
      ) : (
        <SeldomUsed />
      )}
      {may_order.value && (
        <button type="button" class="hold-all" data-testid="hold-all" onClick={hold_all} title="All vehicles hold where they are, at once (Shift+H, F9)">
          HOLD ALL
        </button>
      )}
    </header>
  );
}
