// SPDX-License-Identifier: Apache-2.0
// The fence: where it is, who keeps it, and another one in its place.

import { useEffect, useState } from "preact/hooks";
import { distance, ids } from "../shell/format";
import { give } from "../shell/give";
import { HoldButton } from "../shell/hold_button";
import { words_of_order } from "../orders/orders";
import type { Answer, FenceOrder } from "../wire/protocol";
import { fence, hello, may_order, send } from "../wire/store";
import { fence_yaml, outline, why_no_outline } from "./outline";

const keeps_words = { this: "keep it", another: "keep another one", none: "keep none", not_known: "have not said" } as const;

function Standing() {
  const known = fence.value;
  if (!known) return <p class="muted">No fence is known.</p>;
  return (
    <div data-testid="fence-standing">
      <p>
        {known.corners.length} corners, up to {distance(known.height_m)} above the origin
        {known.order === null ? ", of the configuration" : `, order ${known.order}`}
      </p>
      <p data-testid="fence-action">{known.action}</p>
      <ul class="rows">
        {(Object.keys(keeps_words) as (keyof typeof keeps_words)[]).map((keeps) => {
          const who = known.keepers.filter((one) => one.keeps === keeps).map((one) => one.id);
          if (who.length === 0) return null;
          return (
            <li key={keeps} class={keeps === "this" ? "" : "problem warning"} data-testid={`fence-keepers-${keeps}`}>
              {ids(who)} {keeps_words[keeps]}
            </li>
          );
        })}
      </ul>
    </div>
  );
}

export function FencePart() {
  const [height, set_height] = useState("120");
  const [tried, set_tried] = useState<{ line: string; answer: Answer } | null>(null);
  const known = fence.value;
  useEffect(() => set_tried(null), [outline.value, height]);
  const wrong = why_no_outline(outline.value);
  const height_m = Number(height);
  const [lowest, highest] = hello.value?.limits.fence_height_m ?? [1, 1e5];
  const is_height = Number.isFinite(height_m) && height_m >= lowest && height_m <= highest;
  const order: FenceOrder | null = !wrong && is_height ? { kind: "fence", preview: false, corners: outline.value.map(([x, y]) => [x, y]), height_m } : null;
  const line = order && words_of_order(order);
  const try_it = async () => {
    if (order && line !== null) set_tried({ line, answer: await send({ ...order, preview: true }) });
  };
  const give_it = async () => {
    if (!order) return;
    const answer = await give(order);
    if (answer.done) outline.value = [];
  };
  return (
    <section aria-labelledby="fence-title" data-testid="fence">
      <h2 id="fence-title">Fence</h2>
      <Standing />
      {may_order.value && (
        <>
          <div class="fields">
            {known && (
              <button
                type="button"
                data-testid="fence-edit"
                onClick={() => {
                  outline.value = known.corners.map(([x, y]) => [x, y]);
                  set_height(String(known.height_m));
                }}
              >
                Change its corners
              </button>
            )}
            <label>
              Up to, m above the origin
              <input type="number" min={lowest} max={highest} step="10" value={height} data-testid="fence-height" onInput={(event) => set_height(event.currentTarget.value)} />
            </label>
          </div>
          <div class="button-row">
            <button type="button" data-testid="fence-preview" disabled={!order} onClick={() => void try_it()}>
              Preview
            </button>
            <HoldButton kind="go" testid="fence-give" disabled={!order || !tried?.answer.done || tried.line !== line} on_held={() => void give_it()}>
              Fence all in
            </HoldButton>
          </div>
          <p class="muted">A fence takes the place of the one before; there is no order that takes it away.</p>
          {wrong && <p class="muted">{wrong}</p>}
          {tried && (
            <p class={tried.answer.done ? "preview-outcome outcome" : "problem alarm outcome"} role="status" data-testid="fence-outcome">
              {tried.answer.text}
            </p>
          )}
        </>
      )}
      {!wrong && (
        <details>
          <summary>For the configuration</summary>
          <pre tabIndex={0} data-testid="fence-yaml">
            {fence_yaml(outline.value, is_height ? height_m : 120)}
          </pre>
        </details>
      )}
    </section>
  );
}
