// SPDX-License-Identifier: Apache-2.0
// A button that opens what there is no room for, or what is seldom used.

import type { ComponentChildren } from "preact";
import { useEffect, useRef, useState } from "preact/hooks";

interface Props {
  label: ComponentChildren;
  testid: string;
  children: ComponentChildren;
  /** To which of the button's edges it is aligned. */
  side?: "left" | "right";
  /** Of its button, where the label alone says too little. */
  spoken?: string;
  /** Whether a press on one of its buttons ends it. */
  closes?: boolean;
}

export function Menu({ label, testid, children, side = "right", spoken, closes = false }: Props) {
  const [open, set_open] = useState(false);
  const whole = useRef<HTMLDivElement>(null);
  const button = useRef<HTMLButtonElement>(null);

  useEffect(() => {
    if (!open) return;
    const outside = (event: Event) => {
      if (!whole.current?.contains(event.target as Node)) set_open(false);
    };
    document.addEventListener("pointerdown", outside);
    document.addEventListener("focusin", outside);
    return () => {
      document.removeEventListener("pointerdown", outside);
      document.removeEventListener("focusin", outside);
    };
  }, [open]);

  return (
    <div
      ref={whole}
      class="menu"
      onKeyDown={(event) => {
        if (event.key !== "Escape" || !open) return;
        // Not the page's: it would deselect.
        event.stopPropagation();
        set_open(false);
        button.current?.focus();
      }}
    >
      <button ref={button} type="button" class="quiet" aria-expanded={open} aria-label={spoken} data-testid={testid} onClick={() => set_open(!open)}>
        {label}
      </button>
      {open && (
        <div
          class={`menu-sheet ${side}`}
          data-testid={`${testid}-sheet`}
          onClick={(event) => {
            if (closes && (event.target as Element).closest("button")) set_open(false);
          }}
        >
          {children}
        </div>
      )}
    </div>
  );
}
