// SPDX-License-Identifier: Apache-2.0
// Tiles of the web-mercator pyramid: their columns and rows, with fractions.

const rad = Math.PI / 180;
const tile_px = 256;

export function tile_column(longitude_deg: number, zoom: number): number {
  return ((longitude_deg + 180) / 360) * 2 ** zoom;
}

export function tile_row(latitude_deg: number, zoom: number): number {
  const y = Math.log(Math.tan(Math.PI / 4 + (latitude_deg * rad) / 2));
  return ((1 - y / Math.PI) / 2) * 2 ** zoom;
}

export function column_longitude(column: number, zoom: number): number {
  return (column / 2 ** zoom) * 360 - 180;
}

export function row_latitude(row: number, zoom: number): number {
  return Math.atan(Math.sinh(Math.PI * (1 - (2 * row) / 2 ** zoom))) / rad;
}

/** The zoom at which a tile is nearest to its own size at `px_per_metre` on the screen. */
export function zoom_for(px_per_metre: number, latitude_deg: number): number {
  const metres_around = 2 * Math.PI * 6378137 * Math.cos(latitude_deg * rad);
  return Math.round(Math.log2((px_per_metre * metres_around) / tile_px));
}
