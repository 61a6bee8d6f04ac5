// SPDX-License-Identifier: Apache-2.0
// Orders to the formation: tried first, seen on the map, then given.

import { useEffect, useState } from "preact/hooks";
import { distance, duration, ids, words } from "../shell/format";
import { give } from "../shell/give";
import { HoldButton } from "../shell/hold_button";
import { formation_spot, preview, tool } from "../shell/view";
import type { Answer, Preview } from "../wire/protocol";
import { formation, hello, send } from "../wire/store";
import { acknowledgements, formation_order, no_fields, words_of_order } from "./orders";
import type { FormFields } from "./orders";

const kinds: { kind: FormFields["kind"]; text: string }[] = [
  { kind: "take_off", text: "Take off" },
  { kind: "rally", text: "Rally" },
  { kind: "form", text: "Form" },
  { kind: "land", text: "Land" },
];

const preview_of = (answer: Answer): Preview | null => (answer.data?.kind === "preview" ? (answer.data as Preview) : null);

function Outcome() {
  const tried = preview.value;
  if (!tried) return null;
  if (!tried.done) {
    return (
      <p class="problem alarm" role="alert" data-testid="preview-refused">
        Not possible: {tried.text.replace(/^refused:? */i, "")}
      </p>
    );
  }
  const { data } = tried;
  return (
    <div class="preview-outcome" role="status" data-testid="preview-outcome">
      {data ? (
        <>
          <b>
            {words(data.way)}, {duration(data.duration_s)}
          </b>
          {data.makes_room === undefined
            ? `, ${data.movers.length} move`
            : `, only ${ids([data.makes_room])} moves, out of the way of others that it rests too near; then the order is given`}
          , least separation {distance(data.least_separation_m)}
          {data.lost.length > 0 && <span class="problem alarm"> Lost, and left out: {ids(data.lost)}</span>}
        </>
      ) : (
        tried.text
      )}
    </div>
  );
}

function Acknowledgements() {
  const now = formation.value;
  if (!now) return null;
  const acks = acknowledgements(now);
  return (
    <section aria-labelledby="places-title" class="places">
      <h3 id="places-title">
        {now.moving ? `Change ${now.change?.number ?? ""} is being flown` : now.in_place ? "In place" : "At rest, not in place"}
        {acks && (
          <span class={acks.no.length > 0 ? "problem warning" : "muted"} data-testid="acknowledgements">
            {" "}
            taken by {acks.yes.length} of {acks.yes.length + acks.no.length}
            {acks.no.length > 0 && `, not yet by ${ids(acks.no)}`}
          </span>
        )}
      </h3>
      <table class="audit" data-testid="formation-places">
        <thead>
          <tr>
            <th scope="col">Vehicle</th>
            <th scope="col">Change</th>
            <th scope="col" class="figure">
              Off its place
            </th>
            <th scope="col">State</th>
          </tr>
        </thead>
        <tbody>
          {now.places.map((place) => {
            const taken = !now.change || place.change === now.change.number;
            return (
              <tr key={place.id} data-testid={`place-${place.id}`} data-taken={taken}>
                <td>{place.id}</td>
                <td class={taken ? "" : "problem warning"}>
                  {taken ? "✓" : "…"} {place.change}
                </td>
                <td class="figure">{place.off_m === null ? "–" : `${place.off_m.toFixed(2)} m`}</td>
                <td class={place.lost ? "problem alarm" : ""}>{place.lost ? "lost" : place.at_rest ? "at rest" : "moving"}</td>
              </tr>
            );
          })}
        </tbody>
      </table>
    </section>
  );
}

export function FormationForm() {
  const shapes = hello.value?.shapes ?? [];
  const [fields, set_fields] = useState<FormFields>({ ...no_fields, shape: shapes[0] ?? "" });
  const [busy, set_busy] = useState(false);
  const spot = formation_spot.value;
  useEffect(() => {
    if (spot) change({ east: spot.x.toFixed(0), north: spot.y.toFixed(0) });
  }, [spot]);
  useEffect(
    () => () => {
      preview.value = null;
      formation_spot.value = null;
    },
    [],
  );

  const change = (some: Partial<FormFields>) => {
    preview.value = null;
    set_fields((before) => ({ ...before, ...some }));
  };
  const limits = hello.value?.limits;
  const made = limits ? formation_order(fields, limits) : { trouble: "not connected yet" };
  const order = "order" in made ? made.order : null;
  const line = order && words_of_order(order);
  const tried = preview.value;
  const may_give = tried !== null && tried.done && tried.line === line;

  const try_it = async () => {
    if (order === null || line === null) return;
    set_busy(true);
    const answer = await send({ ...order, preview: true });
    preview.value = { line, data: preview_of(answer), text: answer.text, done: answer.done };
    set_busy(false);
  };
  const give_it = async () => {
    if (order === null) return;
    const answer = await give(order);
    if (answer.done) {
      preview.value = null;
      formation_spot.value = null;
    }
  };
  const field = (name: keyof FormFields, label: string, placeholder: string) => (
    <label>
      {label}
      <input
        inputMode="decimal"
        value={fields[name]}
        placeholder={placeholder}
        data-testid={`formation-${name}`}
        onInput={(event) => change({ [name]: event.currentTarget.value })}
      />
    </label>
  );

  return (
    <section aria-labelledby="formation-title" data-testid="formation">
      <h2 id="formation-title">Formation</h2>
      <form
        class="order-form"
        onSubmit={(event) => {
          event.preventDefault();
          void try_it();
        }}
      >
        <div class="choice" role="radiogroup" aria-label="Order">
          {kinds.map(({ kind, text }) => (
            <label key={kind}>
              <input type="radio" name="kind" checked={fields.kind === kind} data-testid={`formation-kind-${kind}`} onChange={() => change({ kind })} />
              {text}
            </label>
          ))}
        </div>
        {fields.kind === "form" && (
          <div class="fields">
            <label>
              Shape
              <select value={fields.shape} data-testid="formation-shape" onChange={(event) => change({ shape: event.currentTarget.value })}>
                {shapes.map((name) => (
                  <option key={name}>{name}</option>
                ))}
              </select>
            </label>
            {field("spacing", "Spacing, m", "as now")}
            {field("heading", "Heading, compass °", "the rally's")}
            {field("places", "Places", "all")}
            {field("east", "East, m", "as now")}
            {field("north", "North, m", "as now")}
            {field("height", "Height, m", "as now")}
            <button type="button" data-testid="formation-pick" aria-pressed={tool.value === "place"} onClick={() => (tool.value = tool.value === "place" ? "select" : "place")}>
              On the map …
            </button>
          </div>
        )}
        <p class="muted">
          {"trouble" in made ? <span class="problem warning">{made.trouble}</span> : <code>{line}</code>}
        </p>
        <div class="button-row">
          <button type="submit" disabled={line === null || busy} data-testid="formation-preview">
            Preview
          </button>
          <HoldButton kind="go" disabled={!may_give} testid="formation-give" on_held={() => void give_it()}>
            Give this order
          </HoldButton>
          {tried && (
            <button type="button" class="quiet" onClick={() => (preview.value = null)}>
              Clear
            </button>
          )}
        </div>
        <Outcome />
      </form>
      <Acknowledgements />
    </section>
  );
}
