// SPDX-License-Identifier: Apache-2.0
// Which ground station has the command, in words.

import type { CommandState } from "../wire/protocol";

export type Standing = "alone" | "commanding" | "offering" | "listening" | "watching" | "offered" | "nobody" | "superseded" | "unheeded";

/** What the operator of this page is to know; `alone`: nothing. */
export function standing(command: CommandState | null): Standing {
  if (!command) return "alone";
  if (command.state === "commanding") {
    if (!command.several) return "alone";
    return command.unheeding.length > 0 ? "unheeded" : command.offered ? "offering" : "commanding";
  }
  if (!command.several) return "superseded";
  if (command.state === "listening") return "listening";
  if (command.nobody) return "nobody";
  return command.offered ? "offered" : "watching";
}

/** For the top bar. */
export function mark_of(command: CommandState): { text: string; level: "good" | "plain" | "alarm" } {
  switch (standing(command)) {
    case "nobody":
      return { text: "NOBODY in command", level: "alarm" };
    case "unheeded":
      return { text: "in command, not heeded by all", level: "alarm" };
    case "commanding":
    case "offering":
      return { text: "in command", level: "good" };
    case "listening":
      return { text: "listening", level: "plain" };
    default:
      return { text: command.who ? `WATCHING (${command.who} has the command)` : "WATCHING", level: "plain" };
  }
}
