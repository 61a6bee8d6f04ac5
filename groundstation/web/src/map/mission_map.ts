// SPDX-License-Identifier: Apache-2.0
// The map: Leaflet in local metres, with our own canvases on it.

import { effect, signal } from "@preact/signals";
import L from "leaflet";
import { paint_areas, paint_outline, paint_search } from "../areas/areas_painter";
import { cover_shown, held_corner, outline, outline_use } from "../areas/outline";
import { search_preview } from "../areas/search";
import { request_key } from "../mission/requests";
import { follow, highlighted_request, layers, overlays_hidden, place_to_show, preview, select_all, selected, selection, theme, tiles_shown, vehicles_to_show } from "../shell/view";
import { formation_spot, hazard_draft, measure_from, measure_to, site_spot } from "../shell/view";
import { read_colours } from "../theme/colours";
import { line_colour } from "../theme/palette";
import type { Colours } from "../theme/colours";
import { paint_traffic } from "../traffic/traffic_painter";
import type { Picture } from "../wire/picture";
import type { Authorisation } from "../wire/protocol";
import { current, hello, on_picture, mission_now_s, since_state_s, tracks } from "../wire/store";
import { listen_for_boxes } from "./box_select";
import type { Box } from "./box_select";
import { CanvasLayer, view_of } from "./canvas_layer";
import type { View } from "./canvas_layer";
import { LocalFrame } from "./geodesy";
import type { Point } from "./geodesy";
import { paint_links } from "../links/links_painter";
import { paint_return, return_preview } from "../returns/returns";
import { paint_grid, paint_scale } from "./grid";
import { paint_authorisation, paint_hazards, paint_sites } from "./ground";
import { MercatorTiles } from "./mercator_tiles";
import { SitesSeen } from "./out_of_view";
import type { NewSite } from "./out_of_view";
import { load_overlay } from "./overlays";
import { paint_tools } from "./tools_painter";
import { paint_movers, paint_paths, paint_trails } from "./tracks_painter";
import { memberships, needs_frames, paint_vehicles, vehicle_near } from "./vehicles_painter";
import type { Membership } from "./vehicles_painter";

const tracks_every_ms = 500;
/** Who wants no motion sees vehicles where they were last told to be, not moving on from there. */
const still = window.matchMedia("(prefers-reduced-motion: reduce)");
const ahead_s = () => (still.matches ? 0 : since_state_s());

/** New sites that the operator does not see, as the map was moved by hand before they came. */
export const sites_outside = signal<readonly NewSite[]>([]);

export class MissionMap {
  readonly leaflet: L.Map;
  private colours: Colours = read_colours();
  private picture: Picture = current();
  private members: Map<number, Membership> = new Map();
  private return_of: string | null = null;
  private fitted = false;
  /** What is shown was chosen by a person: it is not to be changed by anything but that person. */
  private by_hand = false;
  private readonly sites_seen = new SitesSeen();
  /** What it is to show as soon as it has a size: of a narrow page it may be behind a panel. */
  private when_seen: (() => void) | null = null;
  private tracks_at_ms = 0;
  private frame = 0;
  private frame_local: LocalFrame | null = null;
  private tiles: MercatorTiles | null = null;
  private overlays = new Map<string, L.GeoJSON>();
  private readonly grid;
  private readonly ground;
  private readonly moving;
  private readonly undo: (() => void)[] = [];

  constructor(element: HTMLElement, private readonly on_trouble: (text: string) => void) {
    this.leaflet = L.map(element, {
      crs: L.CRS.Simple,
      preferCanvas: true,
      attributionControl: true,
      zoomControl: false,
      // Steps are painted faster than they could be animated without a graphics processor.
      zoomAnimation: false,
      fadeAnimation: false,
      markerZoomAnimation: false,
      // With Shift vehicles are selected.
      boxZoom: false,
      zoomSnap: 0.25,
      zoomDelta: 1,
      wheelPxPerZoomLevel: 100,
      minZoom: -7,
      maxZoom: 6,
      center: [0, 0],
      zoom: -1.5,
    });
    this.leaflet.attributionControl.setPrefix(false);
    for (const [name, z] of [["grid", 250], ["ground", 450], ["moving", 460]] as const) {
      const pane = this.leaflet.createPane(name);
      pane.style.zIndex = String(z);
      pane.style.pointerEvents = "none";
    }
    const colours = () => this.colours;
    this.grid = new CanvasLayer("grid", colours, (view) => this.paint_grid(view)).addTo(this.leaflet);
    this.ground = new CanvasLayer("ground", colours, (view) => this.paint_ground(view)).addTo(this.leaflet);
    this.moving = new CanvasLayer("moving", colours, (view) => this.paint_moving(view)).addTo(this.leaflet);

    const resize = new ResizeObserver(() => {
      this.leaflet.invalidateSize({ animate: false, pan: false });
      if (!this.is_seen()) return;
      this.when_seen?.();
      this.when_seen = null;
    });
    resize.observe(element);
    this.leaflet.on("dragstart", () => {
      follow.value = false;
      this.by_hand = true;
    });
    this.leaflet.on("moveend", () => this.look_outside());
    const moved = () => (this.by_hand = true);
    element.addEventListener("wheel", moved, { passive: true });
    element.addEventListener("dblclick", moved);
    element.addEventListener("keydown", (event) => {
      if (/^(Arrow|[+=_-]$)/.test(event.key)) moved();
    });
    this.undo.push(
      () => resize.disconnect(),
      on_picture((picture) => this.take(picture)),
      effect(() => this.on_theme(theme.value)),
      effect(() => this.on_choice()),
      effect(() => this.on_drawing()),
      effect(() => this.on_hello()),
      effect(() => this.on_preview()),
      effect(() => {
        if (!place_to_show.value) return;
        this.by_hand = true;
        this.go_to(place_to_show.value);
      }),
      effect(() => {
        if (vehicles_to_show.value) this.show_vehicles(new Set(vehicles_to_show.value));
      }),
      listen_for_boxes(this.leaflet, (box, more) => this.select_in(box, more)),
      effect(() => this.show_overlays()),
    );
  }

  remove(): void {
    cancelAnimationFrame(this.frame);
    for (const undo of this.undo) undo();
    this.leaflet.remove();
  }

  /** One step; what is in the middle stays there. */
  zoom(step: 1 | -1): void {
    this.by_hand = true;
    this.leaflet.setZoom(this.leaflet.getZoom() + step, { animate: false });
  }

  /** As from the begin: everything, and new sites are brought into sight by themselves again. */
  show_all(): void {
    this.by_hand = false;
    sites_outside.value = [];
    this.fit();
  }

  /** What is in sight now, and the new sites besides. */
  show_outside(): void {
    const bounds = this.leaflet.getBounds();
    for (const { x, y } of sites_outside.value) bounds.extend(L.latLng(y, x));
    sites_outside.value = [];
    this.fit_to(bounds);
  }

  private show_vehicles(ids: ReadonlySet<number>): void {
    this.by_hand = true;
    follow.value = false;
    const points = this.picture.vehicles.filter((vehicle) => ids.has(vehicle.id) && vehicle.x !== null && vehicle.y !== null);
    if (points.length > 0) this.fit_to(L.latLngBounds(points.map((one) => L.latLng(one.y!, one.x!))));
  }

  private select_in(box: Box, more: boolean): void {
    const { left, top, right, bottom } = box;
    const bounds = L.latLngBounds(this.leaflet.containerPointToLatLng([left, top]), this.leaflet.containerPointToLatLng([right, bottom]));
    const inside = this.picture.vehicles.filter(({ x, y }) => x !== null && y !== null && bounds.contains([y, x])).map(({ id }) => id);
    select_all(more ? [...selection.value, ...inside] : inside);
  }

  /** Those of them that have come into sight by now are not outside any more. */
  private look_outside(): void {
    if (sites_outside.value.length === 0) return;
    const bounds = this.leaflet.getBounds();
    const left = sites_outside.value.filter(({ x, y }) => !bounds.contains([y, x]));
    if (left.length < sites_outside.value.length) sites_outside.value = left;
  }

  private take_sites(picture: Picture): void {
    const news = this.sites_seen.news(picture.sites, !this.fitted);
    if (news.length === 0) return;
    const bounds = this.leaflet.getBounds();
    const outside = news.filter(({ x, y }) => !bounds.contains([y, x]));
    if (outside.length === 0) return;
    if (!this.by_hand && !follow.value) return this.fit();
    const ids = new Set(outside.map(({ id }) => id));
    sites_outside.value = [...sites_outside.value.filter(({ id }) => !ids.has(id)), ...outside];
  }

  /** Everything that the mission has, in sight. */
  private fit(): void {
    const known = [...this.picture.vehicles, ...this.picture.sites]
      .filter((one): one is typeof one & Point => one.x !== null && one.y !== null)
      .map((one) => L.latLng(one.y, one.x));
    const drawn = [...(this.picture.areas?.search?.corners ?? []), ...outline.value].map(([x, y]) => L.latLng(y, x));
    const points = [...known, ...drawn, ...this.previewed()];
    if (points.length === 0) return;
    this.fit_to(L.latLngBounds(points));
  }

  private fit_to(bounds: L.LatLngBounds): void {
    if (!this.is_seen()) {
      this.when_seen = () => this.fit_to(bounds);
      return;
    }
    // To the right there are the tools; of a small map they would take all.
    const { x, y } = this.leaflet.getSize();
    const side = Math.min(40, y / 8, x / 8);
    const padding = { paddingTopLeft: L.point(side, side), paddingBottomRight: L.point(Math.min(110, x / 3), side) };
    this.leaflet.fitBounds(bounds, { animate: false, maxZoom: 4, ...padding });
  }

  private previewed(): L.LatLng[] {
    const ways = [...(preview.value?.data?.movers ?? []), ...(return_preview.value?.data.ways ?? [])];
    return ways.flatMap((way) => way.points.map(([x, y]) => L.latLng(y, x)));
  }

  /** What is about to be ordered must be seen whole. */
  private on_preview(): void {
    // Ways home are planned again all the time: whoever has moved the map meanwhile has his reason.
    const ways = this.previewed();
    const of = return_preview.value?.of ?? null;
    const renewed = of !== null && of === this.return_of;
    this.return_of = of;
    if (ways.some((at) => !this.leaflet.getBounds().contains(at)) && !renewed) this.fit();
  }

  private is_seen(): boolean {
    const { x, y } = this.leaflet.getSize();
    return x > 0 && y > 0;
  }

  go_to(point: Point): void {
    if (!this.is_seen()) this.when_seen = () => this.go_to(point);
    else this.leaflet.panTo([point.y, point.x], { animate: false });
  }

  /** The vehicle at a press, if there is one within a finger's reach. */
  vehicle_at(x: number, y: number): number | null {
    const context = document.createElement("canvas").getContext("2d");
    return context ? vehicle_near(this.picture, view_of(this.leaflet, context, this.colours), x, y, 22) : null;
  }

  private take(picture: Picture): void {
    if (picture.coalitions !== this.picture.coalitions || this.members.size === 0) this.members = memberships(picture);
    // Before the first of the vehicles there is nothing to be outside of.
    if (picture.sites !== this.picture.sites || !this.fitted) {
      this.picture = picture;
      this.take_sites(picture);
    }
    this.picture = picture;
    if (!this.fitted && picture.vehicles.some((vehicle) => vehicle.x !== null)) {
      this.fitted = true;
      this.fit();
    }
    this.keep_in_middle();
    this.moving.redraw();
    if (performance.now() - this.tracks_at_ms > tracks_every_ms) this.redraw_ground();
    if (this.frame === 0) this.frame = requestAnimationFrame(() => this.between_states());
  }

  private redraw_ground(): void {
    this.tracks_at_ms = performance.now();
    this.ground.redraw();
  }

  private between_states(): void {
    this.frame = 0;
    if (ahead_s() <= 0 || !needs_frames(this.picture, 2 ** this.leaflet.getZoom())) return;
    this.moving.redraw();
    this.frame = requestAnimationFrame(() => this.between_states());
  }

  private keep_in_middle(): void {
    if (!follow.value || selected.value === null) return;
    const vehicle = this.picture.vehicles.find((one) => one.id === selected.value);
    if (vehicle && vehicle.x !== null && vehicle.y !== null) this.go_to({ x: vehicle.x, y: vehicle.y });
  }

  private on_theme(_theme: string): void {
    // The style sheet follows in an effect of its own; colours are read when it has.
    queueMicrotask(() => {
      this.colours = read_colours();
      for (const overlay of this.overlays.values()) overlay.resetStyle();
      this.redraw_all();
    });
  }

  // Signals are named in these two so that a change of any of them repaints.
  private on_choice(): void {
    void [layers.value, selected.value, selection.value, highlighted_request.value, follow.value];
    this.keep_in_middle();
    this.redraw_all();
  }

  private on_drawing(): void {
    void [preview.value, return_preview.value, measure_from.value, measure_to.value, hazard_draft.value, formation_spot.value, site_spot.value];
    void [outline.value, outline_use.value, held_corner.value, cover_shown.value, search_preview.value];
    this.moving.redraw();
  }

  private redraw_all(): void {
    this.grid.redraw();
    this.redraw_ground();
    this.moving.redraw();
  }

  private on_hello(): void {
    const greeting = hello.value;
    if (!greeting) return;
    this.frame_local = new LocalFrame(greeting.origin);
    this.tiles?.remove();
    this.tiles = greeting.tiles ? new MercatorTiles(greeting.tiles, this.frame_local) : null;
    if (this.tiles && tiles_shown.value) this.tiles.addTo(this.leaflet);
    for (const { name, url } of greeting.overlays) {
      if (this.overlays.has(name)) continue;
      load_overlay(url, this.frame_local, () => this.colours)
        .then((overlay) => {
          this.overlays.set(name, overlay);
          this.show_overlays();
        })
        .catch((error: unknown) => this.on_trouble(`Overlay ${name}: ${String(error)}`));
    }
  }

  private show_overlays(): void {
    const hidden = overlays_hidden.value;
    for (const [name, overlay] of this.overlays) {
      if (hidden.has(name)) overlay.remove();
      else overlay.addTo(this.leaflet);
    }
  }

  private shown_requests(): Authorisation[] {
    return this.picture.authorisations.filter((request) => request.waiting || request_key(request) === highlighted_request.value);
  }

  private colour_of(id: number): string {
    const sign = this.members.get(id)?.sign;
    return sign ? line_colour(sign, this.colours.day) : this.colours.trail;
  }

  private paint_grid(view: View): void {
    if (layers.value.grid) paint_grid(view);
    paint_scale(view);
  }

  private paint_ground(view: View): void {
    const on = layers.value;
    const { picture } = this;
    const now_s = mission_now_s() ?? 0;
    const colour_of = (id: number) => this.colour_of(id);
    if (on.hazards) paint_hazards(view, picture.hazards, picture.areas?.hazards ?? []);
    paint_areas(view, picture.areas, picture.fence, colour_of);
    if (on.trails) paint_trails(view, tracks, picture.vehicles, selected.value, colour_of);
    // Whom the operator is asked about.
    const asked = new Set(this.shown_requests().flatMap((request) => request.deliveries.map((delivery) => delivery.vehicle)));
    const path_colour = (id: number) => (asked.has(id) ? this.colours.preview : colour_of(id));
    const marked = selected.value === null ? asked : new Set([...asked, selected.value]);
    if (on.paths) paint_paths(view, picture.plans, now_s, marked, path_colour);
    if (on.sites) paint_sites(view, picture);
  }

  private paint_moving(view: View): void {
    const on = layers.value;
    const { picture } = this;
    if (on.links) paint_links(view, picture);
    const change = picture.formation?.change;
    if (change && picture.formation?.moving) paint_movers(view, change.movers, this.colours.path, false);
    if (return_preview.value) paint_return(view, return_preview.value.data);
    if (preview.value?.data) paint_movers(view, preview.value.data.movers, this.colours.preview, true);
    const colour_of = () => this.colours.preview;
    for (const request of this.shown_requests()) paint_authorisation(view, request);
    paint_vehicles(view, picture, {
      selected: selected.value,
      selection: selection.value,
      labels: on.labels,
      ahead_s: ahead_s(),
      members: this.members,
    });
    if (search_preview.value?.data) paint_search(view, search_preview.value.data, colour_of, true);
    paint_outline(view);
    if (on.traffic) paint_traffic(view, picture.traffic, ahead_s());
    paint_tools(view);
  }
}
