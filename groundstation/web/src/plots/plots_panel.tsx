// SPDX-License-Identifier: Apache-2.0
// Telemetry over time, of the vehicles that were chosen.

import { useEffect, useRef, useState } from "preact/hooks";
import uPlot from "uplot";
import { clock, ids } from "../shell/format";
import { selected, selection, theme } from "../shell/view";
import { read_colours } from "../theme/colours";
import { coalition_sign, line_colour } from "../theme/palette";
import { tracks, tracks_version, vehicles } from "../wire/store";
import { aligned } from "../wire/tracks";
import type { Track } from "../wire/tracks";

const plots: { name: string; unit: string; column: (track: Track) => (number | null)[]; scale: number }[] = [
  { name: "Speed over ground", unit: "m/s", column: (track) => track.speed, scale: 1 },
  { name: "Height", unit: "m", column: (track) => track.z, scale: 1 },
  { name: "Range left", unit: "km", column: (track) => track.range, scale: 0.001 },
  { name: "Delay, clock offset included", unit: "ms", column: (track) => track.delay, scale: 1 },
];

const lines_max = 7;
// With the colour, so that it is not the only sign.
const dashes = [[], [6, 3], [2, 3], [9, 3, 2, 3], [4, 4], [12, 4], [1, 4]];

function pen(index: number, day: boolean): { stroke: string; dash: number[] } {
  return { stroke: line_colour(coalition_sign(index), day), dash: dashes[index % dashes.length]! };
}

function data_of(plot: (typeof plots)[number], chosen: readonly number[]): uPlot.AlignedData {
  const column = (track: Track) =>
    plot.scale === 1 ? plot.column(track) : plot.column(track).map((value) => (value === null ? null : value * plot.scale));
  return aligned(chosen.map((id) => tracks.get(id)), column) as uPlot.AlignedData;
}

function Plot({ plot, chosen }: { plot: (typeof plots)[number]; chosen: readonly number[] }) {
  const element = useRef<HTMLDivElement>(null);
  const made = useRef<uPlot | null>(null);
  const day = theme.value === "day";
  const key = chosen.join();

  useEffect(() => {
    const box = element.current!;
    const colours = read_colours();
    const axis = { stroke: colours.muted, grid: { stroke: colours["grid-strong"], width: 1 }, ticks: { show: false }, font: "10px system-ui, sans-serif" };
    const chart = new uPlot(
      {
        width: Math.max(120, box.clientWidth),
        height: 120,
        legend: { show: false },
        cursor: { sync: { key: "telemetry" }, drag: { x: false, y: false } },
        scales: { x: { time: false } },
        axes: [
          { ...axis, size: 20, space: 60, incrs: [1, 2, 5, 10, 30, 60, 120, 300, 600, 1800, 3600], values: (_plot, splits) => splits.map((second) => clock(second)) },
          { ...axis, size: 44, space: 22 },
        ],
        series: [{}, ...chosen.map((id, i) => ({ label: `${id}`, width: 1.5, spanGaps: false, points: { show: false }, ...pen(i, day) }))],
      },
      data_of(plot, chosen),
      box,
    );
    made.current = chart;
    const resize = new ResizeObserver(() => chart.setSize({ width: Math.max(120, box.clientWidth), height: 120 }));
    resize.observe(box);
    return () => {
      resize.disconnect();
      chart.destroy();
      made.current = null;
    };
  }, [key, day]);
  useEffect(() => made.current?.setData(data_of(plot, chosen)), [tracks_version.value]);

  return (
    <figure class="plot" data-testid={`plot-${plot.name.split(/[ ,]/)[0]!.toLowerCase()}`}>
      <figcaption>
        {plot.name} <span class="muted">{plot.unit}</span>
      </figcaption>
      <div ref={element} role="img" aria-label={`${plot.name} of vehicles ${ids(chosen)} over time`} />
    </figure>
  );
}

function Swatch({ index }: { index: number }) {
  const { stroke, dash } = pen(index, theme.value === "day");
  return (
    <svg class="swatch" viewBox="0 0 22 8" aria-hidden="true">
      <line x1="0" y1="4" x2="22" y2="4" stroke={stroke} stroke-width="2.5" stroke-dasharray={dash.join(" ")} />
    </svg>
  );
}

const buttons_max = 64;

export function PlotsPanel() {
  const all = vehicles.value.map((vehicle) => vehicle.id);
  const [picked, set_picked] = useState<number[] | null>(null);
  const chosen = (picked ?? (selected.value === null ? all.slice(0, 3) : [selected.value])).filter((id) => all.includes(id));
  // Of more there would be nothing but buttons: the fleet's list has them all.
  const offered = all.length <= buttons_max ? all : all.filter((id) => chosen.includes(id) || selection.value.has(id)).slice(0, buttons_max);
  const toggle = (id: number) => {
    const without = chosen.filter((one) => one !== id);
    set_picked(without.length < chosen.length ? without : [...chosen, id].slice(-lines_max));
  };
  return (
    <div class="scroll plots" tabIndex={0} role="region" aria-label="Plots">
      <div class="chips" role="group" aria-label="Vehicles in the plots">
        {offered.map((id) => (
          <button key={id} type="button" class="chip" aria-pressed={chosen.includes(id)} data-testid={`plot-vehicle-${id}`} onClick={() => toggle(id)}>
            {chosen.includes(id) && <Swatch index={chosen.indexOf(id)} />}
            {id}
          </button>
        ))}
        {offered.length < all.length && <span class="muted">Others: select them in the fleet's list.</span>}
        {picked && (
          <button type="button" class="quiet" onClick={() => set_picked(null)}>
            As selected
          </button>
        )}
      </div>
      {chosen.length === 0 ? <p class="empty">Choose vehicles above.</p> : plots.map((plot) => <Plot key={plot.name} plot={plot} chosen={chosen} />)}
    </div>
  );
}
