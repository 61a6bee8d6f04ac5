// SPDX-License-Identifier: Apache-2.0
// Hazards of any outline, and hazards that are changed. The ground station holds a polygon by circles.

import { useEffect, useState } from "preact/hooks";
import { distance, number } from "../shell/format";
import { give } from "../shell/give";
import { HoldButton } from "../shell/hold_button";
import { hazard_draft, tool } from "../shell/view";
import type { Answer, NewHazard } from "../wire/protocol";
import { areas, hazards, may_order, send } from "../wire/store";
import { cover_shown, outline, why_no_outline } from "./outline";
import { hazards_by_number } from "./search";

export function HazardPart() {
  const [changed, set_changed] = useState<number | null>(null);
  const [tried, set_tried] = useState<Answer | null>(null);
  const { alone, groups } = hazards_by_number(hazards.value, areas.value?.hazards ?? []);
  const draft = hazard_draft.value;
  const is_circle = draft !== null && outline.value.length === 0;
  useEffect(() => {
    set_tried(null);
    cover_shown.value = [];
  }, [outline.value, draft]);
  useEffect(
    () => () => {
      cover_shown.value = [];
      hazard_draft.value = null;
      if (tool.value === "hazard" || tool.value === "hazard_edge") tool.value = "select";
    },
    [],
  );
  const wrong = is_circle ? null : why_no_outline(outline.value);
  const order: NewHazard | null = is_circle
    ? { kind: "hazard", x: Math.round(draft.x), y: Math.round(draft.y), radius_m: Math.round(draft.radius_m) }
    : wrong
      ? null
      : { kind: "hazard", corners: outline.value.map(([east, north]) => [east, north]) };
  if (order && changed !== null) order.hazard = changed;
  const try_it = async () => {
    if (!order) return;
    const answer = await send({ ...order, preview: true });
    set_tried(answer);
    const data = answer.data as { kind: string; circles?: [number, number, number][] } | null;
    cover_shown.value = data?.circles ?? [];
  };
  const give_it = async () => {
    if (!order) return;
    const answer = await give(order);
    if (!answer.done) return;
    outline.value = [];
    hazard_draft.value = null;
    set_changed(null);
  };
  const row = (id: number, what: string, edit: () => void) => (
    <li key={id}>
      <b>Keep out {id}</b>
      <span class="muted">{what}</span>
      {may_order.value && (
        <>
          <button
            type="button"
            data-testid={`area-hazard-change-${id}`}
            aria-pressed={changed === id}
            onClick={() => {
              set_changed(changed === id ? null : id);
              if (changed !== id) edit();
            }}
          >
            Change
          </button>
          <HoldButton testid={`area-hazard-withdraw-${id}`} on_held={() => void give({ kind: "withdraw", hazard: id })}>
            Withdraw
          </HoldButton>
        </>
      )}
    </li>
  );
  const edit_circle = (x: number, y: number, radius_m: number) => {
    outline.value = [];
    hazard_draft.value = { x, y, radius_m };
  };
  return (
    <section aria-labelledby="area-hazards-title" data-testid="area-hazards">
      <h2 id="area-hazards-title">Hazards</h2>
      <ul class="rows">
        {groups.map((group) =>
          group.corners.length > 0
            ? row(group.hazard, `${group.corners.length} corners; ${group.circles.length} circles hold it, ${number(100 * group.more)} % more is shut out`, () => {
                hazard_draft.value = null;
                outline.value = group.corners.map(([x, y]) => [x, y]);
              })
            : row(group.hazard, `E ${number(group.x)} N ${number(group.y)} m, radius ${distance(group.radius_m)}`, () => edit_circle(group.x, group.y, group.radius_m)),
        )}
        {alone.map((one) => row(one.id, `E ${number(one.x)} N ${number(one.y)} m, radius ${distance(one.radius_m)}`, () => edit_circle(one.x, one.y, one.radius_m)))}
      </ul>
      {may_order.value && (
        <>
          <div class="button-row">
            <button
              type="button"
              data-testid="area-hazard-circle"
              aria-pressed={tool.value === "hazard"}
              onClick={() => {
                outline.value = [];
                tool.value = tool.value === "hazard" ? "select" : "hazard";
              }}
            >
              Draw a circle …
            </button>
            <button type="button" data-testid="area-hazard-preview" disabled={!order} onClick={() => void try_it()}>
              Preview
            </button>
            <HoldButton kind="go" testid="area-hazard-give" disabled={!order} on_held={() => void give_it()}>
              {changed === null ? "Keep all out of it" : `In place of ${changed}`}
            </HoldButton>
          </div>
          {wrong && <p class="muted">{wrong}</p>}
          {is_circle && (
            <p class="muted" data-testid="area-hazard-draft">
              circle at E {number(draft.x)} N {number(draft.y)} m, radius {distance(draft.radius_m)}
            </p>
          )}
          {tried && (
            <p class={tried.done ? "preview-outcome" : "problem alarm"} role="status" data-testid="area-hazard-outcome">
              {tried.text}
            </p>
          )}
        </>
      )}
    </section>
  );
}
