// SPDX-License-Identifier: Apache-2.0
// The metric grid, labelled east and north of the origin, and the scale bar.

import type { View } from "./canvas_layer";
import { font } from "./draw";

/** 1, 2 or 5 times a power of ten that is at least `least`. */
export function round_step(least: number): number {
  const power = 10 ** Math.floor(Math.log10(least));
  return power * ([1, 2, 5].find((factor) => factor * power >= least * (1 - 1e-9)) ?? 10);
}

export function metres_text(metres: number, step: number): string {
  const sign = metres < 0 ? "−" : "";
  const size = Math.abs(metres);
  if (step >= 100 && size >= 1000) return `${sign}${+(size / 1000).toFixed(1)} km`;
  return `${sign}${+size.toFixed(step < 1 ? 1 : 0)} m`;
}

const line_every_px = 90;

export function paint_grid(view: View): void {
  const { context, colours } = view;
  const step = round_step(line_every_px / view.scale);
  const west = (0 - view.px(0)) / view.scale;
  const north = (view.py(0) - 0) / view.scale;
  const first_x = Math.ceil(west / step);
  const last_x = Math.floor((west + view.width / view.scale) / step);
  const first_y = Math.ceil((north - view.height / view.scale) / step);
  const last_y = Math.floor(north / step);

  context.lineWidth = 1;
  for (const strong of [false, true]) {
    context.beginPath();
    for (let i = first_x; i <= last_x; ++i) {
      if ((i % 5 === 0) !== strong) continue;
      const x = Math.round(view.px(i * step)) + 0.5;
      context.moveTo(x, 0);
      context.lineTo(x, view.height);
    }
    for (let i = first_y; i <= last_y; ++i) {
      if ((i % 5 === 0) !== strong) continue;
      const y = Math.round(view.py(i * step)) + 0.5;
      context.moveTo(0, y);
      context.lineTo(view.width, y);
    }
    context.strokeStyle = strong ? colours["grid-strong"] : colours.grid;
    context.stroke();
  }

  context.font = font(10);
  context.fillStyle = colours.muted;
  context.textAlign = "center";
  context.textBaseline = "top";
  for (let i = first_x; i <= last_x; ++i) {
    const x = view.px(i * step);
    if (x > 40 && x < view.width - 24) context.fillText(metres_text(i * step, step), x, 3);
  }
  context.textAlign = "left";
  context.textBaseline = "middle";
  for (let i = first_y; i <= last_y; ++i) {
    const y = view.py(i * step);
    if (y > 20 && y < view.height - 34) context.fillText(metres_text(i * step, step), 4, y);
  }
}

export function paint_scale(view: View): void {
  const { context, colours } = view;
  const metres = round_step(70 / view.scale);
  const length = metres * view.scale;
  const right = view.width - 12;
  const y = view.height - 12;
  context.strokeStyle = colours.halo;
  for (const [colour, width] of [[colours.halo, 4], [colours.text, 1.5]] as const) {
    context.strokeStyle = colour;
    context.lineWidth = width;
    context.beginPath();
    context.moveTo(right - length, y - 5);
    context.lineTo(right - length, y);
    context.lineTo(right, y);
    context.lineTo(right, y - 5);
    context.stroke();
  }
  context.font = font(11);
  context.textAlign = "right";
  context.textBaseline = "bottom";
  context.lineWidth = 3;
  context.strokeStyle = colours.halo;
  context.strokeText(metres_text(metres, metres), right - 4, y - 3);
  context.fillStyle = colours.text;
  context.fillText(metres_text(metres, metres), right - 4, y - 3);
}
