// SPDX-License-Identifier: Apache-2.0
// The map with its tools.

import { useEffect, useRef, useState } from "preact/hooks";
import { follow_pointer } from "../areas/pointer";
import { bearing, distance, latitude_longitude, number } from "../shell/format";
import { note } from "../shell/give";
import { narrow } from "../shell/layout";
import { Menu } from "../shell/menu";
import { on_fit } from "../shell/keys";
import { follow, layer_names, layers, measure_from, measure_to, overlays_hidden, select, selected, tiles_shown, toggle_selected, tool } from "../shell/view";
import type { LayerName, Spot } from "../shell/view";
import { WindBadge } from "../wind/wind_badge";
import { hello, sites } from "../wire/store";
import { LocalFrame, distance_and_bearing } from "./geodesy";
import { drawn_box } from "./box_select";
import { MissionMap, sites_outside } from "./mission_map";
import { outside_text } from "./out_of_view";
import { drag_edge, press } from "./tools";

const layer_words: Record<LayerName, string> = {
  grid: "Grid",
  trails: "Trails",
  paths: "Planned paths",
  links: "Radio links",
  sites: "Sites",
  hazards: "Hazards",
  traffic: "Other aircraft",
  labels: "Labels",
};

const tool_words = {
  select: "",
  box: "Draw a box around vehicles to select them. Esc ends.",
  measure: "Press two places to measure between them. Esc ends.",
  hazard: "Press the middle of the hazard and drag to its edge, or press both. Esc ends.",
  hazard_edge: "Press its edge. Esc ends.",
  place: "Press where the formation shall be. Esc ends.",
  site: "Press where the site is. Esc ends.",
  outline: "Press each corner in its order around; drag one to move it. Esc ends.",
} as const;

function Cursor({ at }: { at: Spot | null }) {
  const greeting = hello.value;
  if (!at || !greeting) return null;
  const earth = new LocalFrame(greeting.origin).to_wgs84(at);
  return (
    <div class="map-cursor" aria-hidden="true" data-testid="map-cursor">
      E {number(at.x)} N {number(at.y)} m · {latitude_longitude(earth.latitude_deg, earth.longitude_deg)}
    </div>
  );
}

function LayerList() {
  const greeting = hello.value;
  const box = (name: string, checked: boolean, on_change: () => void, testid: string) => (
    <label key={testid}>
      <input type="checkbox" checked={checked} onChange={on_change} data-testid={testid} /> {name}
    </label>
  );
  const toggle_overlay = (name: string) => {
    const hidden = new Set(overlays_hidden.value);
    if (!hidden.delete(name)) hidden.add(name);
    overlays_hidden.value = hidden;
  };
  return (
    <fieldset>
      <legend class="only-spoken">Layers of the map</legend>
      {layer_names.map((name) =>
        box(layer_words[name], layers.value[name], () => (layers.value = { ...layers.value, [name]: !layers.value[name] }), `layer-${name}`),
      )}
      {greeting?.tiles && box("Map tiles", tiles_shown.value, () => (tiles_shown.value = !tiles_shown.value), "layer-tiles")}
      {greeting?.overlays.map(({ name }) => box(name, !overlays_hidden.value.has(name), () => toggle_overlay(name), `layer-overlay-${name}`))}
    </fieldset>
  );
}

function Layers() {
  return (
    <Menu label="Layers" testid="layers-open">
      <LayerList />
    </Menu>
  );
}

function Tools() {
  return (
    <>
      <button type="button" data-testid="follow" aria-pressed={follow.value} disabled={selected.value === null} title="Keep the selected vehicle in the middle (F)" onClick={() => (follow.value = !follow.value)}>
        Follow
      </button>
      <button type="button" data-testid="measure" aria-pressed={tool.value === "measure"} title="Measure (M)" onClick={() => (tool.value = tool.value === "measure" ? "select" : "measure")}>
        Measure
      </button>
      <button type="button" data-testid="box" aria-pressed={tool.value === "box"} title="Select vehicles by a box; also: Shift and drag" onClick={() => (tool.value = tool.value === "box" ? "select" : "box")}>
        Box
      </button>
    </>
  );
}

function DrawnBox() {
  const box = drawn_box.value;
  if (!box) return null;
  const { left, top, right, bottom } = box;
  return <div class="map-box" aria-hidden="true" style={{ left: `${left}px`, top: `${top}px`, width: `${right - left}px`, height: `${bottom - top}px` }} />;
}

/** The map was moved by hand: it is not taken away from who looks at it. */
function Outside({ show }: { show: () => void }) {
  const outside = sites_outside.value;
  if (outside.length === 0) return null;
  return (
    <div class="map-outside" role="status">
      <button type="button" data-testid="show-outside" onClick={show}>
        {outside_text(outside)}
      </button>
      <button type="button" aria-label="Leave them where they are" data-testid="leave-outside" onClick={() => (sites_outside.value = [])}>
        ✕
      </button>
    </div>
  );
}

export function MapPanel() {
  const element = useRef<HTMLDivElement>(null);
  const map = useRef<MissionMap | null>(null);
  const [cursor, set_cursor] = useState<Spot | null>(null);

  useEffect(() => {
    const made = new MissionMap(element.current!, note);
    map.current = made;
    const fit = () => made.show_all();
    on_fit.add(fit);
    const pointer = follow_pointer(element.current!, made.leaflet);
    made.leaflet.on("click", (event) => {
      if (pointer.ate_click()) return;
      if (tool.value === "select") {
        const id = made.vehicle_at(event.containerPoint.x, event.containerPoint.y);
        if (!event.originalEvent.shiftKey) select(id);
        else if (id !== null) toggle_selected(id);
      } else press({ x: event.latlng.lng, y: event.latlng.lat });
    });
    made.leaflet.on("mousemove", (event) => {
      const at = { x: event.latlng.lng, y: event.latlng.lat };
      set_cursor(at);
      drag_edge(at);
    });
    made.leaflet.on("mouseout", () => set_cursor(null));
    return () => {
      on_fit.delete(fit);
      pointer.stop();
      made.remove();
    };
  }, []);

  const from = measure_from.value;
  const to = measure_to.value;
  const measured = from && to ? distance_and_bearing(from, to) : null;
  return (
    <section class={`map-panel tool-${tool.value}`} aria-label="Map">
      <div ref={element} class="map" data-testid="map" role="application" aria-label="Map of the mission. Arrow keys move it, plus and minus zoom. The fleet table lists the same vehicles." />
      <div class="map-tools" role="toolbar" aria-label="Map tools">
        <button type="button" aria-label="Zoom in" data-testid="zoom-in" onClick={() => map.current?.zoom(1)}>
          +
        </button>
        <button type="button" aria-label="Zoom out" data-testid="zoom-out" onClick={() => map.current?.zoom(-1)}>
          −
        </button>
        <button type="button" data-testid="fit" title="Show all (A)" onClick={() => map.current?.show_all()}>
          All
        </button>
        {narrow.value ? (
          <Menu label="Tools" testid="map-tools" closes>
            <Tools />
            <LayerList />
          </Menu>
        ) : (
          <>
            <Tools />
            <Layers />
          </>
        )}
      </div>
      <DrawnBox />
      <Outside show={() => map.current?.show_outside()} />
      {(tool.value !== "select" || measured) && (
        <div class="map-hint" role="status" data-testid="map-hint">
          {tool_words[tool.value]}
          {measured && (
            <b>
              {" "}
              {distance(measured.distance_m)}, {bearing(measured.bearing_deg)}
            </b>
          )}
          {measured && (
            <button type="button" class="quiet" aria-label="Remove the measured line" onClick={() => (measure_from.value = measure_to.value = null)}>
              ✕
            </button>
          )}
        </div>
      )}
      <WindBadge />
      {sites.value.length === 0 && <span class="only-spoken">No site is known yet.</span>}
      <Cursor at={cursor} />
    </section>
  );
}
