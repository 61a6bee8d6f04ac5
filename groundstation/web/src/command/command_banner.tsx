// SPDX-License-Identifier: Apache-2.0
// Where a mission has several ground stations: which one has the command, and how it changes hands.

import { signal } from "@preact/signals";
import { useState } from "preact/hooks";
import { give } from "../shell/give";
import { HoldButton } from "../shell/hold_button";
import { command_state, is_operator, link } from "../wire/store";
import { mark_of, standing } from "./command";
import "./command.css";

const reason_max = 80;
const take_hold_s = 2;
const is_open = signal(false);

export function CommandMark() {
  const command = command_state.value;
  if (!command || standing(command) === "alone") return null;
  const { text, level } = mark_of(command);
  if (standing(command) === "commanding" && is_operator.value) {
    return (
      <button
        type="button"
        class={`command-mark ${level}`}
        data-testid="command-mark"
        aria-expanded={is_open.value}
        title={command.text}
        onClick={() => (is_open.value = !is_open.value)}
      >
        {text}
      </button>
    );
  }
  return (
    <span class={`command-mark ${level}`} data-testid="command-mark" title={command.text}>
      {text}
    </span>
  );
}

function TakeCommand() {
  const [reason, set_reason] = useState("");
  return (
    <span class="command-take">
      <label>
        Why{" "}
        <input
          value={reason}
          maxLength={reason_max}
          placeholder="for the others"
          data-testid="take-reason"
          onInput={(event) => set_reason(event.currentTarget.value)}
        />
      </label>
      <HoldButton
        kind="stop"
        seconds={take_hold_s}
        testid="take-command"
        disabled={link.value !== "open"}
        on_held={() => void give({ kind: "take_command", reason: reason.trim() })}
      >
        Take command
      </HoldButton>
    </span>
  );
}

const sentence = {
  nobody: "Vehicles go on as they were told; no order is given and no delivery authorised until somebody takes the command.",
  watching: "You see everything; orders are given there.",
  offered: "Take it here, or let another do so.",
  listening: "It takes the command in a moment if nobody has it.",
} as const;

export function CommandBanner() {
  const command = command_state.value;
  const is = standing(command);
  if (!command || is === "alone") return null;
  if (is === "superseded") {
    return (
      <div class="banner alarm" role="status" data-testid="banner-command">
        <b>Another ground station has taken the command.</b> This one says nothing any more; it was not configured as one of several (command.station).
      </div>
    );
  }
  if (is === "unheeded") {
    return (
      <div class="banner command alarm" role="status" data-testid="banner-command">
        <span>
          <b>Not heeded by {command.unheeding.join(", ")}.</b> They are heard, and have not heard {command.name} in command for a while: they heed a ground station that was not heard here, or do not hear this one.
        </span>
        {is_operator.value && <TakeCommand />}
      </div>
    );
  }
  if (is === "commanding" || is === "offering") {
    if (!is_operator.value || (is === "commanding" && !is_open.value)) return null;
    return (
      <div class={`banner command ${is}`} role="status" data-testid="banner-command">
        <span>
          <b>{command.name} is in command.</b>
          {is === "offering" && " The others are asked to take it; until one does, orders are given here."}
        </span>
        {is === "commanding" ? (
          <button type="button" data-testid="hand-over" disabled={link.value !== "open"} onClick={() => void give({ kind: "hand_over" })}>
            Hand over
          </button>
        ) : (
          <button type="button" data-testid="keep-command" disabled={link.value !== "open"} onClick={() => void give({ kind: "take_command", reason: "" })}>
            Keep it
          </button>
        )}
      </div>
    );
  }
  const title = is === "nobody" ? "NOBODY is in command." : is === "listening" ? "Listening whether another ground station commands." : "WATCHING.";
  const who = is === "nobody" || is === "listening" ? "" : `${command.who || "Another ground station"} ${is === "offered" ? "asks the others to take the command." : "has the command."}`;
  return (
    <div class={`banner command ${is === "nobody" ? "alarm" : "watching"}`} role="status" data-testid="banner-command">
      <span>
        <b>{title}</b> {who} {is === "nobody" && command.who !== "" && `${command.who} had it, and is not heard.`} {sentence[is]}
      </span>
      {is_operator.value && is !== "listening" && <TakeCommand />}
    </div>
  );
}
