// SPDX-License-Identifier: Apache-2.0
// A button that acts when it has been pressed for a second: by pointer, or Enter or Space kept down.

import type { ComponentChildren } from "preact";
import { useEffect, useRef, useState } from "preact/hooks";

export const press_ms = 1000;
/** A pointer that is moved so far has left. That the page moves under a still one ends no press. */
const slide_px = 24;

interface Props {
  on_held: () => void;
  children: ComponentChildren;
  kind?: "plain" | "go" | "stop";
  disabled?: boolean;
  testid: string;
  label?: string;
  /** How long it is to be kept pressed. */
  seconds?: number;
}

export function HoldButton({ on_held, children, kind = "plain", disabled = false, testid, label, seconds = press_ms / 1000 }: Props) {
  const [pressing, set_pressing] = useState(false);
  const [hint, set_hint] = useState(false);
  const timer = useRef(0);
  const done = useRef(false);
  const pressed_at = useRef({ x: 0, y: 0 });

  const cancel = () => {
    window.clearTimeout(timer.current);
    timer.current = 0;
    set_pressing(false);
  };
  const begin = () => {
    if (disabled || timer.current !== 0) return;
    done.current = false;
    set_hint(false);
    set_pressing(true);
    timer.current = window.setTimeout(() => {
      done.current = true;
      cancel();
      on_held();
    }, seconds * 1000);
  };
  const end = () => {
    if (timer.current === 0) return;
    cancel();
    if (!done.current) set_hint(true);
  };
  useEffect(() => () => window.clearTimeout(timer.current), []);
  useEffect(() => {
    if (disabled) cancel();
  }, [disabled]);

  return (
    <button
      type="button"
      class={`hold-button ${kind}${pressing ? " pressing" : ""}`}
      disabled={disabled}
      aria-label={label}
      data-testid={testid}
      title={`Press and keep pressed for ${seconds === 1 ? "one second" : `${seconds} seconds`}`}
      onPointerDown={(event) => {
        if (event.button !== 0) return;
        event.currentTarget.setPointerCapture(event.pointerId);
        pressed_at.current = { x: event.clientX, y: event.clientY };
        begin();
      }}
      onPointerMove={(event) => {
        const { x, y } = pressed_at.current;
        if (Math.hypot(event.clientX - x, event.clientY - y) > slide_px) end();
      }}
      onPointerUp={end}
      onPointerCancel={cancel}
      onContextMenu={(event) => event.preventDefault()}
      onKeyDown={(event) => {
        if (event.key !== "Enter" && event.key !== " ") return;
        event.preventDefault();
        if (!event.repeat) begin();
      }}
      onKeyUp={(event) => {
        if (event.key === "Enter" || event.key === " ") end();
      }}
      onBlur={cancel}
    >
      <span class="hold-progress" aria-hidden="true" style={{ transitionDuration: pressing ? `${seconds}s` : undefined }} />
      <span class="hold-text">{children}</span>
      <span class="hold-hint">{pressing ? "keep pressed …" : hint ? `press for ${seconds} s` : `hold ${seconds} s`}</span>
    </button>
  );
}
