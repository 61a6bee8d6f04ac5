// SPDX-License-Identifier: Apache-2.0
import { useEffect, useState } from "preact/hooks";
import { distance, duration, number, words } from "../shell/format";
import { give } from "../shell/give";
import { HoldButton } from "../shell/hold_button";
import { words_of_order } from "../orders/orders";
import type { SearchArea } from "../wire/protocol";
import { areas, hello, may_order, mission_now_s, send } from "../wire/store";
import { tick } from "../shell/ticker";
import { outline } from "./outline";
import { done_text, expected_text, left_text, searched_text } from "./progress";
import { no_search_fields, search_order, search_preview } from "./search";
import type { SearchFields } from "./search";

const state_words: Record<SearchArea["state"], string> = {
  previewed: "as it would be",
  flown: "being searched",
  over: "flown to its end",
  called_off: "called off",
};

function Shares({ search }: { search: SearchArea }) {
  void tick.value;
  const now_s = mission_now_s();
  const is_preview = search.state === "previewed";
  return (
    <table>
      <thead>
        <tr>
          <th scope="col">Vehicle</th>
          <th scope="col">{is_preview ? "Lanes" : "Lanes left"}</th>
          <th scope="col">{is_preview ? "Way" : "Done"}</th>
          <th scope="col">{is_preview ? "Time" : "State"}</th>
        </tr>
      </thead>
      <tbody>
        {search.shares.map((share) => (
          <tr key={share.id} data-testid={`share-${share.id}`}>
            <th scope="row">{share.id}</th>
            <td>{is_preview ? share.lanes : left_text(share)}</td>
            <td>{is_preview ? distance(share.length_m) : done_text(share, now_s)}</td>
            <td>{is_preview ? duration(share.time_s) : share.state === "left" ? `left: ${share.why}` : words(share.state)}</td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}

function Progress({ search }: { search: SearchArea }) {
  void tick.value;
  const seen = search.seen ?? 0;
  const expected = expected_text(search, mission_now_s(), hello.value?.epoch_unix_s ?? null);
  return (
    <section aria-labelledby="progress-title" data-testid="search-progress">
      <h2 id="progress-title">The area is {state_words[search.state]}</h2>
      {search.why && <p class="problem warning">{search.why}</p>}
      <p>
        <b data-testid="search-seen">{searched_text(search)}</b> by where vehicles were heard; {number(100 * search.planned, 1)} % when all is flown
      </p>
      {expected && <p data-testid="search-expected">{expected}</p>}
      <progress value={seen} max={1} aria-label="Share of the area that was seen" />
      <Shares search={search} />
    </section>
  );
}

export function SearchPart() {
  const [fields, set_fields] = useState<SearchFields>(no_search_fields);
  const [rest, set_rest] = useState(false);
  const search = areas.value?.search ?? null;
  const preview = search_preview.value;
  useEffect(() => {
    search_preview.value = null;
  }, [outline.value, fields, rest]);
  useEffect(
    () => () => {
      search_preview.value = null;
    },
    [],
  );
  const made = search_order(outline.value, fields, rest);
  const order = "order" in made ? made.order : null;
  const line = order && words_of_order(order);
  const try_it = async () => {
    if (!order || line === null) return;
    const answer = await send({ ...order, preview: true });
    search_preview.value = { line, data: answer.data?.kind === "search" ? (answer.data as SearchArea) : null, text: answer.text, done: answer.done };
  };
  const give_it = async () => {
    if (!order) return;
    const answer = await give(order);
    if (!answer.done) return;
    search_preview.value = null;
    set_rest(false);
    outline.value = [];
  };
  const field = (name: keyof SearchFields, label: string, placeholder: string) => (
    <label>
      {label}
      <input type="text" value={fields[name]} placeholder={placeholder} data-testid={`search-${name}`} onInput={(event) => set_fields({ ...fields, [name]: event.currentTarget.value })} />
    </label>
  );
  return (
    <>
      {may_order.value && (
        <section aria-labelledby="search-title" data-testid="search-form">
          <h2 id="search-title">Share it out</h2>
          <div class="fields">
            {field("vehicles", "Vehicles", "all that can")}
            {field("spacing", "Lanes apart, m", "by sensors")}
            {field("in_s", "Begin in, s", "soon")}
          </div>
          {search?.rest && (
            <label>
              <input type="checkbox" checked={rest} data-testid="search-rest" onChange={(event) => set_rest(event.currentTarget.checked)} /> What was not seen of the last area
            </label>
          )}
          <div class="button-row">
            <button type="button" data-testid="search-preview" disabled={!order} onClick={() => void try_it()}>
              Preview
            </button>
            <HoldButton kind="go" testid="search-give" disabled={!preview?.done || preview.line !== line} on_held={() => void give_it()}>
              Search it
            </HoldButton>
            {search?.state === "flown" && (
              <HoldButton kind="stop" testid="search-off" on_held={() => void give({ kind: "withdraw", routes: true })}>
                Call it off
              </HoldButton>
            )}
          </div>
          {"trouble" in made && <p class="muted">{made.trouble}</p>}
          {preview && (
            <p class={preview.done ? "preview-outcome outcome" : "problem alarm outcome"} role="status" data-testid="search-outcome">
              {preview.text}
            </p>
          )}
          {preview?.data && <Shares search={preview.data} />}
        </section>
      )}
      {search && <Progress search={search} />}
    </>
  );
}
