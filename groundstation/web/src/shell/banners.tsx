// SPDX-License-Identifier: Apache-2.0
// What must not be overlooked: the picture is old, or a recording, or only to be looked at.

import { CommandBanner } from "../command/command_banner";
import { TeamBanner } from "../command/team_state";
import { ended, hello, in_replay, link, shown } from "../wire/store";
import { lost_for_s } from "./connection";
import { clock, duration } from "./format";

function LostBanner() {
  const age_s = lost_for_s();
  if (age_s === 0 || ended.value) return null;
  const has_picture = shown.value.time_s !== null;
  return (
    <div class="banner alarm" role="status" data-testid="banner-lost">
      <b>No connection to the ground station.</b>{" "}
      {has_picture ? `The picture is ${duration(age_s)} old; vehicles fly on. ` : ""}
      Trying again.
    </div>
  );
}

/** The ground station has been told to end: what has come of the mission, not a lost connection. */
function EndedBanner() {
  if (!ended.value || link.value === "open") return null;
  return (
    <div class="banner ended" role="status" data-testid="banner-ended">
      <b>The ground station was ended at {clock(ended.value.time_s)}.</b>
      <ul>
        {ended.value.text.split("\n").filter(Boolean).map((line) => (
          <li key={line}>{line}</li>
        ))}
      </ul>
    </div>
  );
}

export function Banners() {
  return (
    <>
      <EndedBanner />
      <LostBanner />
      <CommandBanner />
      <TeamBanner />
      {in_replay.value && (
        <div class="banner replay" role="status" data-testid="banner-replay">
          <b>Recording</b> {hello.value?.replay?.name}: nothing here is happening now, and no orders can be given.
        </div>
      )}
      {!in_replay.value && hello.value?.role === "observer" && (
        <div class="banner observer" role="status" data-testid="banner-observer">
          <b>Observer:</b> you see everything, and give no orders.
        </div>
      )}
    </>
  );
}
