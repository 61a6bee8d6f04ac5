// SPDX-License-Identifier: Apache-2.0
// GeoJSON of the configuration (WGS84), in local metres.

import L from "leaflet";
import type { GeoJsonObject } from "geojson";
import type { Colours } from "../theme/colours";
import type { LocalFrame } from "./geodesy";

export async function load_overlay(url: string, frame: LocalFrame, colours: () => Colours): Promise<L.GeoJSON> {
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url}: ${response.status} ${response.statusText}`);
  const data = (await response.json()) as GeoJsonObject;
  return L.geoJSON(data, {
    coordsToLatLng: ([longitude, latitude]) => {
      const at = frame.to_local(latitude, longitude);
      return L.latLng(at.y, at.x);
    },
    style: () => ({ color: colours().muted, weight: 1.5, fillOpacity: 0.06, interactive: false }),
    pointToLayer: (_feature, at) =>
      L.circleMarker(at, { radius: 3.5, color: colours().muted, weight: 1.5, fillOpacity: 0.4, interactive: false }),
    onEachFeature: (feature, layer) => {
      const name: unknown = feature.properties?.["name"];
      if (feature.geometry?.type !== "Point" || typeof name !== "string") return;
      // As text: a name of a file is not trusted to be harmless HTML.
      const text = document.createElement("span");
      text.textContent = name;
      layer.bindTooltip(text, { permanent: true, direction: "right", className: "overlay-label" });
    },
  });
}
