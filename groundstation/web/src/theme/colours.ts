// SPDX-License-Identifier: Apache-2.0
// The colours of the canvases, which stand with all others in the style sheet.

const names = [
  "ground",
  "grid",
  "grid-strong",
  "text",
  "muted",
  "halo",
  "vehicle",
  "trail",
  "path",
  "link",
  "hazard",
  "alarm",
  "warning",
  "good",
  "accent",
  "preview",
] as const;

export type Colours = Record<(typeof names)[number], string> & { day: boolean };

export function read_colours(): Colours {
  const style = getComputedStyle(document.documentElement);
  const entries = names.map((name) => [name, style.getPropertyValue(`--canvas-${name}`).trim()]);
  const colours = Object.fromEntries(entries) as Record<(typeof names)[number], string>;
  return { ...colours, day: document.documentElement.dataset["theme"] === "day" };
}
