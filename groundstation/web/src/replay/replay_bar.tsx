// SPDX-License-Identifier: Apache-2.0
// Play, pause and seek in a recording.

import { useEffect, useRef, useState } from "preact/hooks";
import { clock } from "../shell/format";
import { note } from "../shell/give";
import { hello, link, replay, send } from "../wire/store";
import { moment_in } from "./address";

const speeds = [0.25, 0.5, 1, 2, 5, 10, 30, 100];
// The server takes 20 lines a second and no more.
const seek_every_ms = 200;

async function tell(line: string): Promise<void> {
  const answer = await send(line);
  if (!answer.done) note(answer.text);
}

/** Where the address says; a press of Play goes on from there. */
async function show_moment(): Promise<void> {
  const moment = moment_in(location.hash);
  const name = hello.value?.replay?.name;
  if (!moment || name === undefined) return;
  if (moment.of !== null && moment.of !== name) {
    note(`this is the recording ${name}; that link is of ${moment.of}`);
    return;
  }
  await tell("pause");
  await tell(`seek ${moment.seek_s.toFixed(1)}`);
}

export function ReplayBar() {
  const range = hello.value?.replay;
  const is_there = link.value === "open" && Boolean(range);
  useEffect(() => {
    if (!is_there) return;
    const show = () => void show_moment();
    show();
    window.addEventListener("hashchange", show);
    return () => window.removeEventListener("hashchange", show);
  }, [is_there]);
  const state = replay.value;
  const [dragged_s, set_dragged_s] = useState<number | null>(null);
  const pending = useRef<{ timer: number; to_s: number }>({ timer: 0, to_s: 0 });
  if (!range) return null;
  const seek = (to_s: number) => {
    pending.current.to_s = to_s;
    if (pending.current.timer !== 0) return;
    void tell(`seek ${to_s.toFixed(1)}`);
    pending.current.timer = window.setTimeout(() => {
      pending.current.timer = 0;
      if (pending.current.to_s !== to_s) seek(pending.current.to_s);
    }, seek_every_ms);
  };
  const time_s = dragged_s ?? state?.time_s ?? range.from_s;
  const playing = state?.playing ?? false;
  return (
    <section class="replay-bar" aria-label="Recording" data-testid="replay">
      <button type="button" class="primary" data-testid="replay-play" onClick={() => void tell(playing ? "pause" : "play")}>
        {playing ? "Pause" : "Play"}
      </button>
      <span class="figure" data-testid="replay-time">
        {clock(time_s)} / {clock(range.to_s)}
      </span>
      <input
        type="range"
        class="grow"
        min={range.from_s}
        max={range.to_s}
        step="0.1"
        value={time_s}
        aria-label="Time in the recording"
        aria-valuetext={clock(time_s)}
        data-testid="replay-scrubber"
        onInput={(event) => {
          const to_s = event.currentTarget.valueAsNumber;
          set_dragged_s(to_s);
          seek(to_s);
        }}
        onChange={() => set_dragged_s(null)}
      />
      <label>
        Speed{" "}
        <select value={state?.speed ?? 1} data-testid="replay-speed" onChange={(event) => void tell(`speed ${event.currentTarget.value}`)}>
          {[...new Set([...speeds, state?.speed ?? 1])]
            .sort((a, b) => a - b)
            .map((speed) => (
              <option key={speed} value={speed}>
                ×{speed}
              </option>
            ))}
        </select>
      </label>
    </section>
  );
}
