// SPDX-License-Identifier: Apache-2.0
import { corners } from "./palette";
import type { CoalitionSign } from "./palette";

/** A coalition's shape, colour and letter, as on the map. */
export function Badge({ sign }: { sign: CoalitionSign }) {
  // A triangle has the least room for its letter, and that low in it.
  const low = sign.shape === "triangle" ? 1.5 : 0;
  const radius = low > 0 ? 9 : 7.5;
  const points = corners(sign.shape)
    .map(([x, y]) => `${8 + radius * x},${8 + low + radius * y}`)
    .join(" ");
  return (
    <svg class="badge" viewBox="0 0 16 16" role="img" aria-label={`coalition ${sign.letter}`}>
      {sign.shape === "circle" ? <circle cx="8" cy="8" r="7.5" fill={sign.colour} /> : <polygon points={points} fill={sign.colour} />}
      <text x="8" y={11.2 + low} text-anchor="middle">
        {sign.letter}
      </text>
    </svg>
  );
}
