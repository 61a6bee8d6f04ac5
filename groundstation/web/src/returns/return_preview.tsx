// SPDX-License-Identifier: Apache-2.0
// Everybody home: seen first, with times and separation, then given by holding.

import { useEffect, useState } from "preact/hooks";
import { EndsSearch } from "../areas/ends_search";
import { command, command_to } from "../orders/orders";
import { clock, distance, duration, ids, number } from "../shell/format";
import { give } from "../shell/give";
import { HoldButton } from "../shell/hold_button";
import { selection } from "../shell/view";
import type { Answer, ReturnPreview } from "../wire/protocol";
import { mission_now_s, send, vehicles } from "../wire/store";
import { return_preview } from "./returns";

const preview_of = (answer: Answer): ReturnPreview | null => (answer.data?.kind === "return_preview" ? (answer.data as ReturnPreview) : null);

function Ways({ data }: { data: ReturnPreview }) {
  const now_s = mission_now_s() ?? 0;
  return (
    <div role="status" data-testid="return-outcome">
      <p>
        <b>
          {data.ways.length} {data.ways.length === 1 ? "comes" : "come"} home
        </b>
        {data.ways.length > 0 && `, the last in ${duration(data.last_s - now_s)}`}
        {data.least_separation_m !== null && `, least separation ${distance(data.least_separation_m)}`}
      </p>
      <EndsSearch vehicles={data.ways.map(({ id }) => id)} />
      {data.ways.length > 0 && (
        <table class="return-ways">
          <thead>
            <tr>
              <th scope="col">Vehicle</th>
              <th scope="col" class="figure">
                Home at
              </th>
              <th scope="col" class="figure">
                Way
              </th>
              <th scope="col" class="figure">
                Height
              </th>
            </tr>
          </thead>
          <tbody>
            {data.ways.map((way) => (
              <tr key={way.id} data-testid={`return-way-${way.id}`}>
                <th scope="row">{way.id}</th>
                <td class="figure">{clock(way.end_s)}</td>
                <td class="figure">{distance(way.length_m)}</td>
                <td class="figure">{number(way.z)} m</td>
              </tr>
            ))}
          </tbody>
        </table>
      )}
      {data.ways.some((way) => way.home_assumed) && (
        <p class="muted">Home as where each was first heard: it tells where that is when it is ordered. What is flown is planned then, from where they are.</p>
      )}
      {data.cannot.length > 0 && (
        <ul class="return-cannot" data-testid="return-cannot">
          {data.cannot.map(({ id, why }) => (
            <li key={id} class="problem warning">
              Vehicle {id} has no planned way: it {why}
            </li>
          ))}
        </ul>
      )}
    </div>
  );
}

/** Vehicles fly on while their ways are looked at. */
const renewed_every_ms = 3000;

export function ReturnForm() {
  const [some, set_some] = useState("");
  const [refused, set_refused] = useState<string | null>(null);
  const shown = return_preview.value;
  // Those that are selected, where nobody is named.
  const marked = [...selection.value].sort((a, b) => a - b);
  const asked = some.trim() !== "" ? some.replaceAll(" ", "") : marked.length > 1 ? marked.join(",") : "all";
  const show = async () => {
    const answer = await send(`preview return ${asked}`);
    const data = preview_of(answer);
    set_refused(answer.done && data ? null : answer.text);
    return_preview.value = answer.done && data ? { of: asked, data } : null;
  };
  const of = shown?.of;
  useEffect(() => {
    if (of === undefined) return;
    const renew = async () => {
      const data = preview_of(await send(`preview return ${of}`));
      // Refused, as another is being looked at: the next one will tell.
      if (data && return_preview.value?.of === of) return_preview.value = { of, data };
    };
    const timer = window.setInterval(() => void renew(), renewed_every_ms);
    return () => window.clearInterval(timer);
  }, [of]);
  const put_away = () => {
    return_preview.value = null;
    set_refused(null);
  };
  const order = async () => {
    if (!shown) return;
    put_away();
    await give(shown.of === "all" ? command("return_home", 0) : command_to("return_home", shown.of.split(",").map(Number)));
  };
  return (
    <section aria-labelledby="return-title" class="return-form">
      <h2 id="return-title">Return together</h2>
      <div class="button-row">
        <label>
          Vehicles{" "}
          <input
            value={some}
            placeholder={asked === "all" ? `all: ${ids(vehicles.value.map(({ id }) => id))}` : ids(marked)}
            pattern="\s*\d+(\s*,\s*\d+)*\s*"
            data-testid="return-some"
            onInput={(event) => {
              set_some(event.currentTarget.value);
              put_away();
            }}
          />
        </label>
        <button type="button" data-testid="return-preview" onClick={() => void show()}>
          Preview
        </button>
        {shown && (
          <>
            <HoldButton testid="return-give" on_held={() => void order()}>
              Return {shown.of}
            </HoldButton>
            <button type="button" class="quiet" data-testid="return-away" onClick={put_away}>
              Put away
            </button>
          </>
        )}
      </div>
      {refused && (
        <p class="problem alarm" role="alert" data-testid="return-refused">
          {refused}
        </p>
      )}
      {shown && <Ways data={shown.data} />}
    </section>
  );
}
