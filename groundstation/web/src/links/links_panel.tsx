// SPDX-License-Identifier: Apache-2.0
// Who hears whom: a table of all with all, or, where that is too wide, a list with the worst first.

import { signal } from "@preact/signals";
import { useEffect, useRef, useState } from "preact/hooks";
import { ids } from "../shell/format";
import { layers } from "../shell/view";
import type { Link, LinkRow } from "../wire/protocol";
import { links } from "../wire/store";
import { name_of, sentence_of, short_name, sign_of, sorted_links, summary_of, through_others, tone_of } from "./links";

/** What the table's widest is for. */
const matrix_vehicles_max = 30;
const matrix_least_px = 380;
const list_first = 200;

type Way = "matrix" | "list";
/** As somebody has chosen; null: as there is room. */
const chosen = signal<Way | null>(null);
const pointed = signal<{ who: number; whom: number } | null>(null);

function Figures({ rows }: { rows: readonly LinkRow[] }) {
  const at = pointed.value;
  const row = at && rows.find(({ id }) => id === at.who);
  const link = row?.hears.find(({ id }) => id === at!.whom) ?? null;
  return (
    <p class="link-figures" data-testid="link-figures">
      {row && at ? sentence_of(row, at.whom, link) : "Point at a field, or press it: rows hear columns."}
    </p>
  );
}

function Cell({ row, whom, link }: { row: LinkRow; whom: number; link: Link | undefined }) {
  if (whom === row.id) return <td class="self" aria-label="itself" />;
  const point = () => (pointed.value = { who: row.id, whom });
  const tone = row.told_age_s === null ? "unknown" : link ? tone_of(link) : "none";
  return (
    <td>
      <button
        type="button"
        class={`link-cell ${tone}`}
        data-testid={`link-${row.id}-${whom}`}
        data-tone={tone}
        aria-label={sentence_of(row, whom, link ?? null)}
        onPointerEnter={point}
        onFocus={point}
        onClick={point}
      >
        {row.told_age_s === null ? "?" : link ? sign_of(link) : ""}
      </button>
    </td>
  );
}

function Matrix({ rows }: { rows: readonly LinkRow[] }) {
  return (
    <div class="scroll links-scroll" tabIndex={0} role="region" aria-label="Who hears whom">
      <table class="link-matrix" data-testid="link-matrix">
        <caption class="only-spoken">Rows hear columns; percent lost</caption>
        <thead>
          <tr>
            <th scope="col" class="corner">
              <span class="only-spoken">Who hears</span>
            </th>
            {rows.map(({ id }) => (
              <th key={id} scope="col" aria-label={name_of(id)}>
                {short_name(id)}
              </th>
            ))}
          </tr>
        </thead>
        <tbody>
          {rows.map((row) => {
            const by_id = new Map(row.hears.map((link) => [link.id, link]));
            return (
              <tr key={row.id} data-testid={`links-of-${row.id}`}>
                <th scope="row" aria-label={name_of(row.id)}>
                  {short_name(row.id)}
                </th>
                {rows.map(({ id }) => (
                  <Cell key={id} row={row} whom={id} link={by_id.get(id)} />
                ))}
              </tr>
            );
          })}
        </tbody>
      </table>
    </div>
  );
}

function List({ rows }: { rows: readonly LinkRow[] }) {
  const all = sorted_links(rows);
  const silent = rows.filter((row) => row.told_age_s === null).map((row) => row.id);
  return (
    <div class="scroll links-scroll" tabIndex={0} role="region" aria-label="Links, the worst first">
      <ul class="link-list" data-testid="link-list">
        {all.slice(0, list_first).map(({ row, link }) => (
          <li key={`${row.id}-${link.id}`} data-tone={tone_of(link)}>
            <span class={`link-cell ${tone_of(link)}`} aria-hidden="true">
              {sign_of(link)}
            </span>{" "}
            {sentence_of(row, link.id, link)}
          </li>
        ))}
      </ul>
      {all.length > list_first && <p class="muted">And {all.length - list_first} more, no worse than these.</p>}
      {silent.length > 0 && <p class="muted">Not told by vehicles {ids(silent)}.</p>}
    </div>
  );
}

export function LinksPanel() {
  const element = useRef<HTMLElement>(null);
  const [width, set_width] = useState(0);
  useEffect(() => {
    const watch = new ResizeObserver(([entry]) => set_width(entry!.contentRect.width));
    watch.observe(element.current!);
    return () => watch.disconnect();
  }, []);
  const rows = links.value;
  const fits = rows.length - 1 <= matrix_vehicles_max && width >= matrix_least_px;
  const way = chosen.value ?? (fits ? "matrix" : "list");
  const far = through_others(rows);
  return (
    <section class="links" ref={element} aria-label="Links" data-testid="links">
      <div class="links-head">
        <span data-testid="links-summary">{summary_of(rows)}</span>
        <span class="grow" />
        {(["matrix", "list"] as const).map((name) => (
          <button key={name} type="button" aria-pressed={way === name} data-testid={`links-${name}`} onClick={() => (chosen.value = name)}>
            {name === "matrix" ? "Table" : "List"}
          </button>
        ))}
        <button type="button" aria-pressed={layers.value.links} data-testid="links-on-map" onClick={() => (layers.value = { ...layers.value, links: !layers.value.links })}>
          On the map
        </button>
      </div>
      {far.length > 0 && (
        <p class="problem warning" data-testid="links-through">
          Heard through others only: {ids(far)}
        </p>
      )}
      {way === "matrix" && <Figures rows={rows} />}
      {way === "matrix" ? <Matrix rows={rows} /> : <List rows={rows} />}
    </section>
  );
}
