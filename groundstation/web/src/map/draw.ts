// SPDX-License-Identifier: Apache-2.0
// Strokes that several painters use. Lengths in pixels of the screen.

import { corners } from "../theme/palette";
import type { CoalitionSign } from "../theme/palette";
import type { View } from "./canvas_layer";

export const font = (size: number, bold = false) => `${bold ? "600 " : ""}${size}px system-ui, "DejaVu Sans", sans-serif`;

/** Text that can be read over anything. */
export function label(view: Pick<View, "colours"> & { context: CanvasText & CanvasPathDrawingStyles & CanvasFillStrokeStyles }, text: string, x: number, y: number, colour = view.colours.text): void {
  const { context } = view;
  context.lineJoin = "round";
  context.lineWidth = 3;
  context.strokeStyle = view.colours.halo;
  context.strokeText(text, x, y);
  context.fillStyle = colour;
  context.fillText(text, x, y);
}

const drawn = new Map<string, { image: CanvasImageSource; width: number; height: number }>();
const drawn_max = 4000;
const halo_px = 2;

/** As label(), from its left upper corner, for texts that come again and again: drawn once, and copied then, which
 *  for a thousand vehicles is many times faster. */
export function kept_label(view: View, text: string, x: number, y: number, size: number, bold: boolean): void {
  const { context, colours } = view;
  const ratio = context.canvas.width / view.width;
  const key = `${ratio} ${size} ${bold} ${colours.text} ${colours.halo} ${text}`;
  let one = drawn.get(key);
  if (!one) {
    context.font = font(size, bold);
    const width = Math.ceil(context.measureText(text).width) + 2 * halo_px;
    const height = Math.ceil(1.4 * size) + 2 * halo_px;
    const canvas = new OffscreenCanvas(Math.ceil(width * ratio), Math.ceil(height * ratio));
    const into = canvas.getContext("2d");
    if (!into) return;
    into.scale(ratio, ratio);
    into.font = font(size, bold);
    into.textAlign = "left";
    into.textBaseline = "top";
    label({ context: into, colours }, text, halo_px, halo_px);
    if (drawn.size >= drawn_max) drawn.clear();
    one = { width: canvas.width / ratio, height: canvas.height / ratio, image: canvas.transferToImageBitmap() };
    drawn.set(key, one);
  }
  // On whole pixels: between them it would be blurred.
  const snapped = (value: number) => Math.round(value * ratio) / ratio;
  context.drawImage(one.image, snapped(x - halo_px), snapped(y - halo_px), one.width, one.height);
}

/** A line through points in metres. */
export function trace(view: View, points: Iterable<readonly [number, number, ...unknown[]]>): void {
  const { context } = view;
  context.beginPath();
  let first = true;
  for (const [x, y] of points) {
    if (first) context.moveTo(view.px(x), view.py(y));
    else context.lineTo(view.px(x), view.py(y));
    first = false;
  }
}

/** An arrow that ends at (x, y), having come from `bearing_deg`'s opposite. */
export function arrow(view: View, x: number, y: number, bearing_deg: number, length: number, head: number): void {
  const { context } = view;
  const angle = (bearing_deg * Math.PI) / 180;
  const dx = Math.sin(angle);
  const dy = -Math.cos(angle);
  context.beginPath();
  context.moveTo(x - dx * length, y - dy * length);
  context.lineTo(x - dx * head * 0.7, y - dy * head * 0.7);
  context.stroke();
  context.setLineDash([]);
  context.beginPath();
  context.moveTo(x, y);
  context.lineTo(x - dx * head - dy * head * 0.5, y - dy * head + dx * head * 0.5);
  context.lineTo(x - dx * head + dy * head * 0.5, y - dy * head - dx * head * 0.5);
  context.closePath();
  context.fill();
}

/** The path of a coalition's shape. */
export function shape_path(context: CanvasRenderingContext2D, sign: CoalitionSign, x: number, y: number, radius: number): void {
  context.beginPath();
  if (sign.shape === "circle") context.arc(x, y, radius, 0, 2 * Math.PI);
  corners(sign.shape).forEach(([cx, cy], i) => {
    if (i === 0) context.moveTo(x + cx * radius, y + cy * radius);
    else context.lineTo(x + cx * radius, y + cy * radius);
  });
  context.closePath();
}

/** A coalition's shape with its letter. */
export function badge(view: View, sign: CoalitionSign, x: number, y: number): void {
  const { context } = view;
  // A triangle has the least room for its letter, and that low in it.
  const low = sign.shape === "triangle" ? 1.5 : 0;
  shape_path(context, sign, x, y, low > 0 ? 9.5 : 7.5);
  context.fillStyle = sign.colour;
  context.fill();
  context.lineWidth = 1;
  context.strokeStyle = view.colours.halo;
  context.stroke();
  context.font = font(9, true);
  context.textAlign = "center";
  context.textBaseline = "middle";
  context.fillStyle = "#10161b";
  context.fillText(sign.letter, x, y + 0.5 + low);
}
