// SPDX-License-Identifier: Apache-2.0
// How figures are written.

const dash = "–";

/** Mission time: 01:02:03, with the hours only where there are any. */
export function clock(time_s: number | null | undefined, decimals = 0): string {
  if (time_s === null || time_s === undefined || !Number.isFinite(time_s)) return dash;
  const sign = time_s < 0 ? "−" : "";
  const scale = 10 ** decimals;
  const units = Math.round(Math.abs(time_s) * scale);
  const whole = Math.floor(units / scale);
  const two = (n: number) => String(n).padStart(2, "0");
  const hours = Math.floor(whole / 3600);
  const part = decimals > 0 ? `.${String(units % scale).padStart(decimals, "0")}` : "";
  const minutes = two(Math.floor(whole / 60) % 60);
  return `${sign}${hours > 0 ? `${hours}:` : ""}${minutes}:${two(whole % 60)}${part}`;
}

/** A length of time: 0.4 s, 12 s, 3 min 20 s. */
export function duration(seconds: number | null | undefined): string {
  if (seconds === null || seconds === undefined || !Number.isFinite(seconds)) return dash;
  if (seconds < 9.95) return `${seconds.toFixed(1)} s`;
  const whole = Math.round(seconds);
  if (whole < 120) return `${whole} s`;
  if (whole < 7200) return `${Math.floor(whole / 60)} min ${whole % 60} s`;
  return `${Math.floor(whole / 3600)} h ${Math.floor(whole / 60) % 60} min`;
}

/** How old something is, in the largest unit only: 0.4 s, 12 s, 3 min, 2 h. */
export function age(seconds: number | null | undefined): string {
  if (seconds === null || seconds === undefined || !Number.isFinite(seconds)) return dash;
  if (seconds < 9.95) return `${Math.max(0, seconds).toFixed(1)} s`;
  if (seconds < 99.5) return `${Math.round(seconds)} s`;
  return seconds < 5970 ? `${Math.round(seconds / 60)} min` : `${Math.round(seconds / 3600)} h`;
}

export function distance(metres: number | null | undefined): string {
  if (metres === null || metres === undefined || !Number.isFinite(metres)) return dash;
  const size = Math.abs(metres);
  if (size < 9.95) return `${metres.toFixed(1)} m`;
  if (size < 999.5) return `${Math.round(metres)} m`;
  return `${(metres / 1000).toFixed(size < 99_950 ? 1 : 0)} km`;
}

export function number(value: number | null | undefined, decimals = 0): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return dash;
  const text = Math.abs(value).toFixed(decimals);
  return value < 0 && Number(text) !== 0 ? `−${text}` : text;
}

/** Compass degrees with three digits, as they are spoken: 007°. */
export function bearing(degrees: number | null | undefined): string {
  if (degrees === null || degrees === undefined || !Number.isFinite(degrees)) return dash;
  const whole = ((Math.round(degrees) % 360) + 360) % 360;
  return `${String(whole).padStart(3, "0")}°`;
}

/** The same for a line that is typed: 007, 007.5. */
export function bearing_digits(degrees: number): string {
  const [whole, rest] = String(((degrees % 360) + 360) % 360).split(".");
  return `${whole!.padStart(3, "0")}${rest === undefined ? "" : `.${rest}`}`;
}

/** Where something is from the origin; at the origin there is no direction. */
export function from_origin(distance_m: number, bearing_deg: number): string {
  return distance_m < 0.5 ? "at the origin" : `${distance(distance_m)} from the origin towards ${bearing(bearing_deg)}`;
}

/** The time of day of a mission time: 14:05:33 UTC. */
export function utc(time_s: number | null | undefined, epoch_unix_s: number | null | undefined): string {
  if (time_s === null || time_s === undefined || epoch_unix_s === null || epoch_unix_s === undefined) return dash;
  const at = new Date(1000 * (time_s + epoch_unix_s));
  return Number.isNaN(at.getTime()) ? dash : `${at.toISOString().slice(11, 19)} UTC`;
}

export function latitude_longitude(latitude_deg: number, longitude_deg: number): string {
  const half = (value: number, positive: string, negative: string) =>
    `${Math.abs(value).toFixed(6)}° ${value < 0 ? negative : positive}`;
  return `${half(latitude_deg, "N", "S")}, ${half(longitude_deg, "E", "W")}`;
}

/** A name of the program in words: en_route is "en route". */
export function words(name: string | null | undefined): string {
  return name ? name.replaceAll("_", " ") : dash;
}

/** 1, 2, 3 and 7: "1–3, 7". */
export function ids(list: readonly number[]): string {
  const sorted = [...new Set(list)].sort((a, b) => a - b);
  const runs: string[] = [];
  for (let i = 0; i < sorted.length; ) {
    let end = i;
    while (end + 1 < sorted.length && sorted[end + 1] === sorted[end]! + 1) ++end;
    const joint = end - i > 1 ? "–" : ", ";
    runs.push(end === i ? `${sorted[i]}` : `${sorted[i]}${joint}${sorted[end]}`);
    i = end + 1;
  }
  return runs.join(", ");
}
