// SPDX-License-Identifier: Apache-2.0
// A circle to be kept out of: drawn on the map or typed, then sent to all.

import { useEffect } from "preact/hooks";
import { hazards_by_number } from "../areas/search";
import { distance, number } from "../shell/format";
import { give } from "../shell/give";
import { HoldButton } from "../shell/hold_button";
import { hazard_draft, tool } from "../shell/view";
import { areas, hazards } from "../wire/store";
import { hazard_order } from "./orders";

const empty_draft = { x: 0, y: 0, radius_m: 100 };

export function HazardForm() {
  const draft = hazard_draft.value;
  const drawing = tool.value === "hazard" || tool.value === "hazard_edge";
  useEffect(
    () => () => {
      hazard_draft.value = null;
      if (tool.value !== "measure") tool.value = "select";
    },
    [],
  );
  const figure = (name: "x" | "y" | "radius_m", label: string, least?: number) => (
    <label>
      {label}
      <input
        type="number"
        step="1"
        min={least}
        value={draft ? Math.round(draft[name]) : ""}
        data-testid={`hazard-${name}`}
        onInput={(event) => {
          const value = event.currentTarget.valueAsNumber;
          if (Number.isFinite(value)) hazard_draft.value = { ...(hazard_draft.value ?? empty_draft), [name]: Math.max(least ?? -1e5, value) };
        }}
      />
    </label>
  );
  const give_it = async () => {
    if (!draft) return;
    const answer = await give(hazard_order(draft));
    if (answer.done) hazard_draft.value = null;
  };
  return (
    <section aria-labelledby="hazard-title" data-testid="hazards">
      <h2 id="hazard-title">Hazards</h2>
      <ul class="rows">
        {hazards_by_number(hazards.value, areas.value?.hazards ?? []).alone.map((hazard) => (
          <li key={hazard.id}>
            <b>Keep out {hazard.id}</b>
            <span>
              E {number(hazard.x)} N {number(hazard.y)} m
            </span>
            <span class="muted">radius {distance(hazard.radius_m)}</span>
            <HoldButton testid={`hazard-withdraw-${hazard.id}`} on_held={() => void give({ kind: "withdraw", hazard: hazard.id })}>
              Withdraw
            </HoldButton>
          </li>
        ))}
      </ul>
      <div class="fields">
        <button type="button" data-testid="hazard-draw" aria-pressed={drawing} onClick={() => (tool.value = drawing ? "select" : "hazard")}>
          Draw on the map …
        </button>
        {figure("x", "East, m")}
        {figure("y", "North, m")}
        {figure("radius_m", "Radius, m", 1)}
      </div>
      <div class="button-row">
        <HoldButton kind="go" disabled={!draft} testid="hazard-give" on_held={() => void give_it()}>
          Keep all out of it
        </HoldButton>
        {draft && (
          <button type="button" class="quiet" onClick={() => (hazard_draft.value = null)}>
            Clear
          </button>
        )}
      </div>
    </section>
  );
}
