// SPDX-License-Identifier: Apache-2.0
// Sites that the operator adds, changes and withdraws, and what detectors propose.

import { useEffect, useState } from "preact/hooks";
import { is_off, progress_of } from "../map/ground";
import { number } from "../shell/format";
import { give } from "../shell/give";
import { HoldButton } from "../shell/hold_button";
import { place_to_show, site_changed, site_spot, tool } from "../shell/view";
import type { Answer, Site } from "../wire/protocol";
import { hello, proposals, send, sites } from "../wire/store";
import { no_site, site_order, words_of_order } from "./orders";
import type { SiteFields } from "./orders";

const may_be_changed = (site: Site) => site.status !== "done" && !is_off(site);

function Known() {
  return (
    <ul class="rows" data-testid="order-sites">
      {sites.value.filter(may_be_changed).map((site) => (
        <li key={site.id}>
          <b>Site {site.id}</b>
          <span>{progress_of(site)}</span>
          <span class="muted">{site.leader !== null ? `led by ${site.leader}` : site.surveyor !== null ? `told to ${site.surveyor}` : "no leader"}</span>
          <button type="button" data-testid={`site-change-${site.id}`} aria-pressed={site_changed.value === site.id} onClick={() => (site_changed.value = site_changed.value === site.id ? null : site.id)}>
            Change
          </button>
          <HoldButton testid={`site-withdraw-${site.id}`} on_held={() => void give({ kind: "withdraw", site: site.id })}>
            Withdraw
          </HoldButton>
        </li>
      ))}
    </ul>
  );
}

function Proposals() {
  if (proposals.value.length === 0) return null;
  return (
    <section aria-labelledby="proposals-title" data-testid="proposals">
      <h3 id="proposals-title">Seen by detectors</h3>
      <ul class="rows">
        {proposals.value.map((seen) => (
          <li key={seen.number}>
            <button type="button" class="row-button" title="Show on the map" onClick={() => (place_to_show.value = { x: seen.x, y: seen.y })}>
              {seen.number}: {seen.kind}
            </button>
            <span>
              E {number(seen.x)} N {number(seen.y)} m
            </span>
            <span class="muted">
              {seen.detector || "a detector"} of {seen.seen_by || "another agency"}, {number(100 * seen.confidence)} % sure
            </span>
            <HoldButton kind="go" testid={`proposal-accept-${seen.number}`} on_held={() => void give({ kind: "proposal", number: seen.number, accept: true })}>
              Take as a site
            </HoldButton>
            <button type="button" data-testid={`proposal-dismiss-${seen.number}`} onClick={() => void give({ kind: "proposal", number: seen.number, accept: false })}>
              Dismiss
            </button>
          </li>
        ))}
      </ul>
    </section>
  );
}

export function SiteForm() {
  const [fields, set_fields] = useState<SiteFields>(no_site);
  const [tried, set_tried] = useState<{ line: string; answer: Answer } | null>(null);
  const [anyway, set_anyway] = useState(false);
  const spot = site_spot.value;
  const changed = site_changed.value;
  const change = (some: Partial<SiteFields>) => {
    set_tried(null);
    set_anyway(false);
    set_fields((before) => ({ ...before, ...some }));
  };
  useEffect(() => {
    if (spot) change({ east: spot.x.toFixed(0), north: spot.y.toFixed(0) });
  }, [spot]);
  useEffect(() => set_tried(null), [changed]);
  useEffect(
    () => () => {
      site_spot.value = null;
      site_changed.value = null;
      if (tool.value === "site") tool.value = "select";
    },
    [],
  );
  const limits = hello.value?.limits;
  const made = limits ? site_order(fields, limits, changed) : { trouble: "not connected yet" };
  const order = "order" in made ? { ...made.order, ...(anyway && { anyway }) } : null;
  const line = order && words_of_order(order);
  const templates = hello.value?.site_templates ?? [];

  const try_it = async () => {
    if (order === null || line === null) return;
    set_tried({ line, answer: await send({ ...order, preview: true }) });
  };
  const give_it = async () => {
    if (order === null) return;
    const answer = await give(order);
    if (!answer.done) return;
    set_tried(null);
    set_anyway(false);
    set_fields(no_site);
    site_spot.value = null;
    site_changed.value = null;
  };
  const field = (name: keyof SiteFields, label: string, placeholder = "") => (
    <label>
      {label}
      <input type="text" value={fields[name]} placeholder={placeholder} data-testid={`site-${name}`} onInput={(event) => change({ [name]: event.currentTarget.value })} />
    </label>
  );
  return (
    <section aria-labelledby="site-title" data-testid="site-form">
      <h2 id="site-title">Sites</h2>
      <Proposals />
      <Known />
      <h3>{changed === null ? "New site" : `In place of site ${changed}`}</h3>
      <div class="fields">
        <button type="button" data-testid="site-pick" aria-pressed={tool.value === "site"} onClick={() => (tool.value = tool.value === "site" ? "select" : "site")}>
          Pick on the map …
        </button>
        {field("east", "East, m")}
        {field("north", "North, m")}
        {templates.length > 0 && (
          <label>
            As
            <select value={fields.like} data-testid="site-like" onChange={(event) => change({ like: event.currentTarget.value })}>
              <option value="">as below</option>
              {templates.map((name) => (
                <option key={name} value={name}>
                  {name}
                </option>
              ))}
            </select>
          </label>
        )}
        {field("bearings", "Deliveries towards, compass deg", "090, 180")}
        {field("interval", "Every, s", "0: at once")}
        {field("assessments", "Assessments")}
        {field("dwell", "of, s")}
        {field("reward", "Reward")}
      </div>
      <div class="button-row">
        <button type="button" data-testid="site-preview" disabled={order === null} onClick={() => void try_it()}>
          Preview
        </button>
        <HoldButton kind="go" disabled={tried === null || !tried.answer.done || tried.line !== line} testid="site-give" on_held={() => void give_it()}>
          {changed === null ? "Tell the team" : "Change it"}
        </HoldButton>
      </div>
      {"trouble" in made && <p class="muted">{made.trouble}</p>}
      {tried && (
        <p class={tried.answer.done ? "preview-outcome" : "problem alarm"} role="status" data-testid="site-outcome">
          {tried.answer.text}
        </p>
      )}
      {(anyway || tried?.answer.text.includes("'anyway'")) && (
        <label>
          <input type="checkbox" checked={anyway} data-testid="site-anyway" onChange={(event) => set_anyway(event.currentTarget.checked)} />
          Anyway: preview it again
        </label>
      )}
    </section>
  );
}
