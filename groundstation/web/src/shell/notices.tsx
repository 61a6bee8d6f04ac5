// SPDX-License-Identifier: Apache-2.0
import { useEffect, useState } from "preact/hooks";
import { current, on_picture } from "../wire/store";
import { fresh_alarms } from "./alarms";
import { dismiss, notices } from "./give";

const marks = { sent: "…", done: "✓", refused: "✕", note: "i" } as const;

/** What was done is told shortly, with what else comes of it in the lines after the first; what was not, in full. */
const lines_shown = 3;
const first_lines = (text: string) => text.split("\n", lines_shown).join("\n").replace(/[:,]$/, "");

export function Notices() {
  return (
    <div class="notices" role="log" aria-label="Answers to orders" data-testid="notices">
      {notices.value.map((notice) => (
        <div key={notice.id} class={`notice ${notice.state}`} data-testid={`notice-${notice.state}`}>
          <span class="mark" aria-hidden="true">
            {marks[notice.state]}
          </span>
          <span class="notice-text" title={notice.text}>
            {notice.line && <code>{notice.line}</code>} {notice.state === "done" ? first_lines(notice.text) : notice.text}
          </span>
          <button type="button" class="quiet" aria-label="Dismiss" onClick={() => dismiss(notice.id)}>
            ✕
          </button>
        </div>
      ))}
    </div>
  );
}

const kept_spoken = 8;

/** Says new alarms to a screen reader, each once; what was said last can be read again. */
export function SpokenAlarms() {
  const [said, set_said] = useState<{ number: number; text: string }[]>([]);
  useEffect(() => {
    let before = current();
    let first = true;
    let number = 0;
    return on_picture((picture) => {
      const fresh = first ? [] : fresh_alarms(before, picture);
      if (picture.vehicles.length > 0) first = false;
      before = picture;
      if (fresh.length > 0) set_said((old) => [...old, ...fresh.map((text) => ({ number: ++number, text }))].slice(-kept_spoken));
    });
  }, []);
  return (
    <div class="only-spoken" role="log" aria-label="Alarms" aria-live="assertive" data-testid="spoken-alarms">
      {said.map((one) => (
        <p key={one.number}>{one.text}</p>
      ))}
    </div>
  );
}
