// SPDX-License-Identifier: Apache-2.0
// A Leaflet layer that is one canvas over the whole map, painted by a function.

import L from "leaflet";
import type { Colours } from "../theme/colours";

/** What a painter needs to know of the map: where metres are on the screen. */
export interface View {
  context: CanvasRenderingContext2D;
  width: number;
  height: number;
  /** Pixels of the screen for a metre. */
  scale: number;
  px(x: number): number;
  py(y: number): number;
  /** Whether it is on the screen, or not more than `margin` pixels off. */
  sees(x: number, y: number, margin?: number): boolean;
  colours: Colours;
}

export type Painter = (view: View) => void;

export class CanvasLayer extends L.Layer {
  private canvas: HTMLCanvasElement | null = null;
  private frame = 0;

  constructor(
    private readonly pane_name: string,
    private readonly colours: () => Colours,
    private readonly painter: Painter,
  ) {
    super();
  }

  override onAdd(map: L.Map): this {
    this.canvas = L.DomUtil.create("canvas", "map-canvas leaflet-zoom-hide", map.getPane(this.pane_name));
    this.canvas.setAttribute("aria-hidden", "true");
    this.paint();
    return this;
  }

  override onRemove(): this {
    cancelAnimationFrame(this.frame);
    this.frame = 0;
    this.canvas?.remove();
    this.canvas = null;
    return this;
  }

  override getEvents(): { [name: string]: () => void } {
    // At once, not in the next frame: Leaflet has moved the pane already.
    const now = () => this.paint();
    return { move: now, zoom: now, viewreset: now, resize: now };
  }

  /** Paints in the next frame, once. */
  redraw(): void {
    if (this.frame === 0) this.frame = requestAnimationFrame(() => this.paint());
  }

  private paint(): void {
    cancelAnimationFrame(this.frame);
    this.frame = 0;
    const map = this._map;
    const canvas = this.canvas;
    const context = canvas?.getContext("2d");
    if (!map || !canvas || !context) return;
    const size = map.getSize();
    // Of a narrow page the map may be behind a panel.
    if (size.x === 0 || size.y === 0) return;
    const ratio = Math.min(2, window.devicePixelRatio || 1);
    const width = Math.round(size.x * ratio);
    const height = Math.round(size.y * ratio);
    if (canvas.width !== width || canvas.height !== height) {
      canvas.width = width;
      canvas.height = height;
      canvas.style.width = `${size.x}px`;
      canvas.style.height = `${size.y}px`;
    }
    L.DomUtil.setPosition(canvas, map.containerPointToLayerPoint([0, 0]));
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, size.x, size.y);
    this.painter(view_of(map, context, this.colours()));
  }
}

export function view_of(map: L.Map, context: CanvasRenderingContext2D, colours: Colours): View {
  const size = map.getSize();
  const origin = map.latLngToContainerPoint([0, 0]);
  const scale = 2 ** map.getZoom();
  const px = (x: number) => origin.x + x * scale;
  const py = (y: number) => origin.y - y * scale;
  return {
    context,
    width: size.x,
    height: size.y,
    scale,
    px,
    py,
    sees: (x, y, margin = 40) =>
      px(x) > -margin && px(x) < size.x + margin && py(y) > -margin && py(y) < size.y + margin,
    colours,
  };
}
