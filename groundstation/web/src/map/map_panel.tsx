// SPDX-License-Identifier: Apache-2.0
// The map with its tools.

import { useEffect, useRef, useState } from "preact/hooks";
import { bearing, distance, latitude_longitude, number } from "../shell/format";
import { note } from "../shell/give";
import { on_fit } from "../shell/keys";
import { follow, layer_names, layers, measure_from, measure_to, overlays_hidden, select, selected, tiles_shown, tool } from "../shell/view";
import type { LayerName, Spot } from "../shell/view";
import { hello, sites } from "../wire/store";
import { LocalFrame, distance_and_bearing } from "./geodesy";
import { MissionMap } from "./mission_map";
import { drag_edge, press } from "./tools";

const layer_words: Record<LayerName, string> = {
  grid: "Grid",
  trails: "Trails",
  paths: "Planned paths",
  links: "Radio links",
  sites: "Sites",
  hazards: "Hazards",
  labels: "Labels",
};

const tool_words = {
  select: "",
  measure: "Press two places to measure between them. Esc ends.",
  hazard: "Press the middle of the hazard. Esc ends.",
  hazard_edge: "Press its edge. Esc ends.",
  place: "Press where the formation shall be. Esc ends.",
  site: "Press where the site is. Esc ends.",
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

function Layers() {
  const [open, set_open] = useState(false);
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
    <div class="map-layers">
      <button type="button" aria-expanded={open} data-testid="layers-open" onClick={() => set_open(!open)}>
        Layers
      </button>
      {open && (
        <fieldset class="map-layer-list">
          <legend class="only-spoken">Layers of the map</legend>
          {layer_names.map((name) =>
            box(layer_words[name], layers.value[name], () => (layers.value = { ...layers.value, [name]: !layers.value[name] }), `layer-${name}`),
          )}
          {greeting?.tiles && box("Map tiles", tiles_shown.value, () => (tiles_shown.value = !tiles_shown.value), "layer-tiles")}
          {greeting?.overlays.map(({ name }) => box(name, !overlays_hidden.value.has(name), () => toggle_overlay(name), `layer-overlay-${name}`))}
        </fieldset>
      )}
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
    const fit = () => made.fit();
    on_fit.add(fit);
    made.leaflet.on("click", (event) => {
      if (tool.value === "select") select(made.vehicle_at(event.containerPoint.x, event.containerPoint.y));
      else press({ x: event.latlng.lng, y: event.latlng.lat });
    });
    made.leaflet.on("mousemove", (event) => {
      const at = { x: event.latlng.lng, y: event.latlng.lat };
      set_cursor(at);
      drag_edge(at);
    });
    made.leaflet.on("mouseout", () => set_cursor(null));
    return () => {
      on_fit.delete(fit);
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
        <button type="button" aria-label="Zoom in" data-testid="zoom-in" onClick={() => map.current?.leaflet.zoomIn()}>
          +
        </button>
        <button type="button" aria-label="Zoom out" data-testid="zoom-out" onClick={() => map.current?.leaflet.zoomOut()}>
          −
        </button>
        <button type="button" data-testid="fit" title="Show all (A)" onClick={() => map.current?.fit()}>
          All
        </button>
        <button type="button" data-testid="follow" aria-pressed={follow.value} disabled={selected.value === null} title="Keep the selected vehicle in the middle (F)" onClick={() => (follow.value = !follow.value)}>
          Follow
        </button>
        <button type="button" data-testid="measure" aria-pressed={tool.value === "measure"} title="Measure (M)" onClick={() => (tool.value = tool.value === "measure" ? "select" : "measure")}>
          Measure
        </button>
        <Layers />
      </div>
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
      {sites.value.length === 0 && <span class="only-spoken">No site is known yet.</span>}
      <Cursor at={cursor} />
    </section>
  );
}
