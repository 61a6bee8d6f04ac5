// SPDX-License-Identifier: Apache-2.0
// What each vehicle did in the last ten minutes, one sample a second: trails and plots.

import type { Series, Vehicle } from "./protocol";

export const samples_kept = 600;
const sample_every_s = 1;

export interface Track {
  t: number[];
  x: number[];
  y: number[];
  z: number[];
  speed: (number | null)[];
  range: (number | null)[];
  delay: (number | null)[];
}

const columns = ["t", "x", "y", "z", "speed", "range", "delay"] as const;

/** Changes in place, since hundreds of samples for each of many vehicles would be copied otherwise. */
export class Tracks {
  private tracks = new Map<number, Track>();

  get(id: number): Track | undefined {
    return this.tracks.get(id);
  }

  /** Takes the place of all that there was. */
  load(series: readonly Series[]): void {
    this.tracks.clear();
    for (const { id, ...track } of series) {
      const rows = Math.min(...columns.map((column) => track[column]?.length ?? 0));
      this.tracks.set(id, {
        t: track.t.slice(0, rows),
        x: track.x.slice(0, rows),
        y: track.y.slice(0, rows),
        z: track.z.slice(0, rows),
        speed: track.speed.slice(0, rows),
        range: track.range.slice(0, rows),
        delay: track.delay.slice(0, rows),
      });
    }
  }

  /** Where the vehicles are at `time_s`; only those that were heard since their last sample. */
  add(vehicles: readonly Vehicle[], time_s: number): boolean {
    let added = false;
    for (const vehicle of vehicles) {
      if (vehicle.x === null || vehicle.y === null) continue;
      const heard_s = time_s - (vehicle.heard_age_s ?? 0);
      const track = this.tracks.get(vehicle.id) ?? this.start(vehicle.id);
      const last = track.t[track.t.length - 1];
      // A millisecond less, so that a period of one second in rounded numbers is one.
      if (last !== undefined && heard_s - last < sample_every_s - 0.001) continue;
      append(track, "t", heard_s);
      append(track, "x", vehicle.x);
      append(track, "y", vehicle.y);
      append(track, "z", vehicle.z ?? 0);
      append(track, "speed", vehicle.groundspeed);
      append(track, "range", vehicle.range_left_m);
      append(track, "delay", vehicle.clock_offset_ms);
      added = true;
    }
    return added;
  }

  private start(id: number): Track {
    const track: Track = { t: [], x: [], y: [], z: [], speed: [], range: [], delay: [] };
    this.tracks.set(id, track);
    return track;
  }
}

/** In the place of the oldest where it is full. `shift` and `push` would have the array made anew every few
 *  minutes, half as long again as it is: as much memory for nothing as for what is kept. */
function append<Column extends keyof Track>(track: Track, column: Column, value: Track[Column][number]): void {
  const values: (number | null)[] = track[column];
  if (values.length < samples_kept) {
    values.push(value);
    // A copy has no room for more.
    if (values.length === samples_kept) track[column] = values.slice() as Track[Column];
    return;
  }
  const last = values.length - 1;
  for (let i = 0; i < last; ++i) values[i] = values[i + 1]!;
  values[last] = value;
}

/** One column of several tracks over common whole seconds, as a plot wants them: times, then a row
 *  of values for each track, null where it has none. */
export function aligned(
  tracks: readonly (Track | undefined)[],
  column: (track: Track) => readonly (number | null)[],
): [times: number[], ...rows: (number | null)[][]] {
  const seconds = new Set<number>();
  for (const track of tracks) for (const t of track?.t ?? []) seconds.add(Math.round(t));
  const times = [...seconds].sort((a, b) => a - b);
  const index = new Map(times.map((second, i) => [second, i]));
  const rows = tracks.map((track) => {
    const row = new Array<number | null>(times.length).fill(null);
    const values = track ? column(track) : [];
    track?.t.forEach((t, i) => (row[index.get(Math.round(t))!] = values[i] ?? null));
    return row;
  });
  return [times, ...rows];
}
