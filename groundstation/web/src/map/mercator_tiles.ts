// SPDX-License-Identifier: Apache-2.0
// Web-mercator tiles on a map in local metres. Each tile is stretched between its own corners, so it
// lies where it belongs to a fraction of a pixel; over the 20 km of a mission the turn between the
// two grids is too small to see.

import L from "leaflet";
import type { Tiles } from "../wire/protocol";
import type { LocalFrame } from "./geodesy";
import { column_longitude, row_latitude, tile_column, tile_row, zoom_for } from "./mercator";

const tiles_max = 200;

export class MercatorTiles extends L.Layer {
  private box: HTMLElement | null = null;
  private images = new Map<string, HTMLImageElement>();

  constructor(
    private readonly tiles: Tiles,
    private readonly frame: LocalFrame,
  ) {
    super();
  }

  override getAttribution(): string {
    return this.tiles.attribution;
  }

  override onAdd(map: L.Map): this {
    this.box = L.DomUtil.create("div", "map-tiles", map.getPane("tilePane"));
    this.place();
    return this;
  }

  override onRemove(): this {
    this.box?.remove();
    this.box = null;
    this.images.clear();
    return this;
  }

  override getEvents(): { [name: string]: () => void } {
    return { moveend: () => this.place(), zoom: () => this.place(), viewreset: () => this.place(), resize: () => this.place() };
  }

  private place(): void {
    const map = this._map;
    const box = this.box;
    if (!map || !box) return;
    const bounds = map.getBounds();
    const scale = 2 ** map.getZoom();
    const wanted = zoom_for(scale, this.frame.origin.latitude_deg);
    const zoom = Math.max(this.tiles.min_zoom, Math.min(this.tiles.max_zoom, wanted));
    const corners = [bounds.getSouthWest(), bounds.getNorthEast(), bounds.getNorthWest(), bounds.getSouthEast()].map((at) =>
      this.frame.to_wgs84({ x: at.lng, y: at.lat }),
    );
    const columns = corners.map((at) => tile_column(at.longitude_deg, zoom));
    const rows = corners.map((at) => tile_row(at.latitude_deg, zoom));
    const [west, east] = [Math.floor(Math.min(...columns)), Math.floor(Math.max(...columns))];
    const [north, south] = [Math.floor(Math.min(...rows)), Math.floor(Math.max(...rows))];
    const needed = new Set<string>();
    // Far out there would be thousands of tiles of the least zoom: then there is the grid alone.
    if ((east - west + 1) * (south - north + 1) <= tiles_max) {
      for (let row = north; row <= south; ++row) {
        for (let column = west; column <= east; ++column) needed.add(this.put(map, box, zoom, column, row));
      }
    }
    for (const [key, image] of this.images) {
      if (needed.has(key)) continue;
      image.remove();
      this.images.delete(key);
    }
  }

  private put(map: L.Map, box: HTMLElement, zoom: number, column: number, row: number): string {
    const key = `${zoom}/${column}/${row}`;
    let image = this.images.get(key);
    if (!image) {
      image = L.DomUtil.create("img", "map-tile", box);
      image.alt = "";
      image.draggable = false;
      image.onerror = () => image?.remove();
      image.src = this.tiles.url.replace("{z}", `${zoom}`).replace("{x}", `${column}`).replace("{y}", `${row}`);
      this.images.set(key, image);
    }
    const [left, top] = this.corner(map, zoom, column, row);
    const [right, bottom] = this.corner(map, zoom, column + 1, row + 1);
    L.DomUtil.setPosition(image, L.point(left, top));
    // A pixel more than it needs, so that no seam shows.
    image.style.width = `${Math.ceil(right - left) + 1}px`;
    image.style.height = `${Math.ceil(bottom - top) + 1}px`;
    return key;
  }

  private corner(map: L.Map, zoom: number, column: number, row: number): [number, number] {
    const at = this.frame.to_local(row_latitude(row, zoom), column_longitude(column, zoom));
    const point = map.latLngToLayerPoint([at.y, at.x]);
    return [point.x, point.y];
  }
}
