// SPDX-License-Identifier: Apache-2.0
// Colours for coalitions that people with any colour vision tell apart (Okabe and Ito, 2008), each
// with a letter and a shape of its own, so that colour is never the only sign.

export const shapes = ["circle", "square", "triangle", "diamond", "pentagon", "hexagon", "cross"] as const;
export type Shape = (typeof shapes)[number];

const colours = ["#e69f00", "#56b4e9", "#009e73", "#f0e442", "#cc79a7", "#d55e00", "#0072b2"] as const;

export interface CoalitionSign {
  letter: string;
  colour: string;
  shape: Shape;
}

/** Of the coalition in place `slot`. Letters go on after Z as AA, AB; colours and shapes start again,
 *  not in step, so that a pair of them comes back after 49. */
export function coalition_sign(slot: number): CoalitionSign {
  const round = Math.floor(slot / colours.length);
  const first = Math.floor(slot / 26);
  return {
    letter: (first > 0 ? String.fromCharCode(64 + first) : "") + String.fromCharCode(65 + (slot % 26)),
    colour: colours[slot % colours.length]!,
    shape: shapes[(slot + round) % shapes.length]!,
  };
}

/** The colour of its lines, which on white must be darker than its badges. */
export function line_colour(sign: CoalitionSign, day: boolean): string {
  if (!day) return sign.colour;
  const part = (at: number) => Math.round(0.7 * parseInt(sign.colour.slice(at, at + 2), 16)).toString(16).padStart(2, "0");
  return `#${part(1)}${part(3)}${part(5)}`;
}

/** Corners of a shape around (0, 0), within a circle of radius 1, y downwards; none for a circle. */
export function corners(shape: Shape): [number, number][] {
  if (shape === "circle") return [];
  if (shape === "cross") {
    const a = 0.35;
    const b = 1;
    return [[-a, -b], [a, -b], [a, -a], [b, -a], [b, a], [a, a], [a, b], [-a, b], [-a, a], [-b, a], [-b, -a], [-a, -a]];
  }
  const count = { square: 4, triangle: 3, diamond: 4, pentagon: 5, hexagon: 6 }[shape];
  const turn = shape === "square" ? Math.PI / 4 : 0;
  return Array.from({ length: count }, (_, i) => {
    const angle = turn + (2 * Math.PI * i) / count;
    return [Math.sin(angle), -Math.cos(angle)];
  });
}

// Fills of the time line; words stand in the bars too.
const states: Record<string, string> = {
  silent: "#5b646b",
  on_the_ground: "#7d8a6b",
  waiting_for_the_start: "#8a949c",
  taking_off: "#a3c46b",
  searching: "#6f8ea8",
  surveying: "#56b4e9",
  leading: "#e69f00",
  bidding: "#f0e442",
  waiting_for_authorisation: "#ff8fa3",
  delivering: "#009e73",
  assessing: "#57c7a8",
  executing: "#009e73",
  too_late_for_its_task: "#d0704a",
  monitoring: "#b38b3f",
  holding: "#cc79a7",
  holding_by_order: "#cc79a7",
  not_worked_with: "#b05c86",
  returning: "#9fb6e8",
  at_home: "#7f93c4",
  range_reserve: "#e8795a",
  back_into_its_fence: "#e8795a",
  forming: "#4a9ad4",
  en_route: "#d58a5e",
  standing_by: "#8c7fd1",
  landing: "#c9b36a",
  landed: "#7d8a6b",
  keeping_clear_of_traffic: "#e6cf00",
  piloted: "#d98cff",
};

export function state_colour(state: string | null): string {
  return (state && states[state]) || "#8a949c";
}
