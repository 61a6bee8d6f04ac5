// SPDX-License-Identifier: Apache-2.0
// A button that opens what there is no room for, or what is seldom used.

import type { ComponentChildren } from "preact";
import { useEffect, useLayoutEffect, useRef, useState } from "preact/hooks";

const edge_px = 8;

/** Under its button, or above it where there is more room; within the page, whatever is around it. */
function place(sheet: HTMLElement, button: HTMLElement, side: "left" | "right"): void {
  const at = button.getBoundingClientRect();
  sheet.style.maxHeight = "";
  const { width, height } = sheet.getBoundingClientRect();
  const below = window.innerHeight - at.bottom - edge_px;
  const above = at.top - edge_px;
  const is_below = below >= Math.min(height, 200) || below >= above;
  const wanted = side === "right" ? at.right - width : at.left;
  sheet.style.left = `${Math.max(edge_px, Math.min(wanted, window.innerWidth - width - edge_px))}px`;
  sheet.style.top = `${is_below ? at.bottom : Math.max(edge_px, at.top - Math.min(height, above))}px`;
  sheet.style.maxHeight = `${is_below ? below : above}px`;
}

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
  const sheet = useRef<HTMLDivElement>(null);

  useLayoutEffect(() => {
    const element = sheet.current;
    if (!open || !element) return;
    // Over everything: panels clip what is in them.
    element.showPopover?.();
    const again = () => place(element, button.current!, side);
    again();
    window.addEventListener("resize", again);
    return () => window.removeEventListener("resize", again);
  }, [open]);

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
          ref={sheet}
          popover="manual"
          class="menu-sheet"
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
