// SPDX-License-Identifier: Apache-2.0
// Corners and the edge of a circle follow the pointer while it is pressed: mouse, pen or finger.

import type L from "leaflet";
import { hazard_draft, tool } from "../shell/view";
import { corner_at, held_corner, move_corner, outline } from "./outline";

const reach_px = 22;
const moved_px = 6;

/** Listens on the map's element before Leaflet does. Gives the way to stop, and whether the click that
 *  comes now is only the end of a drag. */
export function follow_pointer(element: HTMLElement, map: L.Map): { stop: () => void; ate_click: () => boolean } {
  let circle: { x: number; y: number; px: number; py: number; moved: boolean } | null = null;
  let dragged = false;

  const place = (event: PointerEvent) => {
    const at = map.mouseEventToLatLng(event);
    return { x: at.lng, y: at.lat };
  };
  const on_down = (event: PointerEvent) => {
    dragged = false;
    if (event.button !== 0 || !event.isPrimary) return;
    const at = place(event);
    if (outline.value.length > 0 && (tool.value === "outline" || tool.value === "select")) {
      held_corner.value = corner_at(outline.value, at.x, at.y, reach_px / 2 ** map.getZoom());
    } else if (tool.value === "hazard") {
      circle = { ...at, px: event.clientX, py: event.clientY, moved: false };
    }
    if (held_corner.value !== null || circle) map.dragging.disable();
  };
  const on_move = (event: PointerEvent) => {
    const at = place(event);
    if (held_corner.value !== null) {
      dragged = true;
      outline.value = move_corner(outline.value, held_corner.value, at.x, at.y);
    } else if (circle) {
      circle.moved ||= Math.hypot(event.clientX - circle.px, event.clientY - circle.py) > moved_px;
      if (!circle.moved) return;
      dragged = true;
      hazard_draft.value = { x: circle.x, y: circle.y, radius_m: Math.max(5, Math.round(Math.hypot(at.x - circle.x, at.y - circle.y))) };
    }
  };
  const on_up = () => {
    if (circle?.moved) tool.value = "select";
    circle = null;
    held_corner.value = null;
    map.dragging.enable();
  };
  element.addEventListener("pointerdown", on_down, true);
  window.addEventListener("pointermove", on_move);
  window.addEventListener("pointerup", on_up);
  window.addEventListener("pointercancel", on_up);
  return {
    stop: () => {
      element.removeEventListener("pointerdown", on_down, true);
      window.removeEventListener("pointermove", on_move);
      window.removeEventListener("pointerup", on_up);
      window.removeEventListener("pointercancel", on_up);
    },
    ate_click: () => {
      const was = dragged;
      dragged = false;
      return was;
    },
  };
}
