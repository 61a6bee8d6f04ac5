// SPDX-License-Identifier: Apache-2.0
// Vehicles are selected by a box that is drawn: with Shift kept down, or with its tool.

import { signal } from "@preact/signals";
import type L from "leaflet";
import { tool } from "../shell/view";

export interface Box {
  left: number;
  top: number;
  right: number;
  bottom: number;
}

/** The box that is being drawn, in pixels of the map. */
export const drawn_box = signal<Box | null>(null);

const least_px = 6;

/** Calls `on_box` when one has been drawn; `more`: what is in it is selected besides. */
export function listen_for_boxes(map: L.Map, on_box: (box: Box, more: boolean) => void): () => void {
  const element = map.getContainer();
  let from: { x: number; y: number; more: boolean; pointer: number } | null = null;

  const place = (event: PointerEvent) => {
    const { left, top } = element.getBoundingClientRect();
    return { x: event.clientX - left, y: event.clientY - top };
  };
  const begin = (event: PointerEvent) => {
    const by_tool = tool.value === "box";
    if (event.button !== 0 || !(by_tool || (event.shiftKey && tool.value === "select"))) return;
    from = { ...place(event), more: event.shiftKey, pointer: event.pointerId };
    // The map would be dragged along.
    map.dragging.disable();
    element.setPointerCapture(event.pointerId);
  };
  const move = (event: PointerEvent) => {
    if (!from || event.pointerId !== from.pointer) return;
    const to = place(event);
    if (!drawn_box.value && Math.hypot(to.x - from.x, to.y - from.y) < least_px) return;
    drawn_box.value = { left: Math.min(from.x, to.x), top: Math.min(from.y, to.y), right: Math.max(from.x, to.x), bottom: Math.max(from.y, to.y) };
  };
  const end = (event: PointerEvent) => {
    if (!from || event.pointerId !== from.pointer) return;
    const box = event.type === "pointerup" ? drawn_box.value : null;
    const { more } = from;
    from = null;
    drawn_box.value = null;
    map.dragging.enable();
    if (!box) return;
    if (tool.value === "box") tool.value = "select";
    on_box(box, more);
    // What Leaflet takes for a click at the end of it would select one alone.
    swallow_click(element);
  };
  element.addEventListener("pointerdown", begin, true);
  element.addEventListener("pointermove", move);
  element.addEventListener("pointerup", end);
  element.addEventListener("pointercancel", end);
  return () => {
    element.removeEventListener("pointerdown", begin, true);
    element.removeEventListener("pointermove", move);
    element.removeEventListener("pointerup", end);
    element.removeEventListener("pointercancel", end);
  };
}

/** The click that the browser makes of the press that has just ended. */
function swallow_click(element: HTMLElement): void {
  const stop = (event: Event) => event.stopImmediatePropagation();
  element.addEventListener("click", stop, { capture: true, once: true });
  window.setTimeout(() => element.removeEventListener("click", stop, { capture: true }));
}
