// SPDX-License-Identifier: Apache-2.0
// Above the list: how many do what, which of them are listed, and groups.

import { useState } from "preact/hooks";
import { words } from "../shell/format";
import { narrow } from "../shell/layout";
import { Menu } from "../shell/menu";
import { select_all, selection } from "../shell/view";
import { state_colour } from "../theme/palette";
import type { Vehicle } from "../wire/protocol";
import { filter, forget_group, groups, keep_group, listed, recall_group, sorting, wanted_columns, want_columns } from "./chosen";
import { column_names, counts_by_state, needs_attention, no_filter } from "./fleet_list";
import type { Column } from "./fleet_list";
import { column_titles } from "./fleet_table";
import { group_text, name_max } from "./groups";

function toggle_state(state: string): void {
  const states = new Set(filter.value.states);
  if (!states.delete(state)) states.add(state);
  filter.value = { ...filter.value, states };
}

function Counts({ all }: { all: readonly Vehicle[] }) {
  const { states, attention } = filter.value;
  const counts = counts_by_state(all);
  const known = new Set(counts.map(([state]) => state));
  // A state that nobody has any more can be left.
  const shown = [...counts, ...[...states].filter((state) => !known.has(state)).map((state) => [state, 0] as [string, number])];
  const worried = all.filter(needs_attention).length;
  return (
    <div class="state-chips" role="group" aria-label="How many do what; a press lists only those">
      <button
        type="button"
        class={`state-chip${worried > 0 ? " worried" : ""}`}
        aria-pressed={attention}
        data-testid="chip-attention"
        onClick={() => (filter.value = { ...filter.value, attention: !attention })}
      >
        <b>{worried}</b> need attention
      </button>
      {shown.map(([state, count]) => (
        <button key={state} type="button" class="state-chip" aria-pressed={states.has(state)} data-testid={`chip-${state}`} onClick={() => toggle_state(state)}>
          <i ref={(element) => element?.style.setProperty("background", state_colour(state))} aria-hidden="true" />
          <b>{count}</b> {words(state)}
        </button>
      ))}
    </div>
  );
}

function Groups() {
  const [name, set_name] = useState("");
  const [trouble, set_trouble] = useState<string | null>(null);
  const keep = (event: Event) => {
    event.preventDefault();
    const wrong = keep_group(name, selection.value);
    set_trouble(wrong);
    if (!wrong) set_name("");
  };
  return (
    <Menu label={<>Groups{groups.value.length > 0 && ` (${groups.value.length})`}</>} testid="groups-open">
      {groups.value.length === 0 && <p class="muted">None yet: select vehicles, and keep them under a name.</p>}
      <ul class="group-list">
        {groups.value.map((group, i) => (
          <li key={group.name} data-testid={`group-${group.name}`}>
            <button type="button" data-testid={`recall-${group.name}`} title={group_text(group)} onClick={() => recall_group(i + 1)}>
              Select {group.name}
              {i < 9 && <kbd> ⇧{i + 1}</kbd>}
            </button>
            <span class="muted">{group.vehicles.length}</span>
            {group.own ? (
              <button type="button" class="quiet" aria-label={`Forget group ${group.name}`} data-testid={`forget-${group.name}`} onClick={() => forget_group(group.name)}>
                ✕
              </button>
            ) : (
              <span class="muted">configured</span>
            )}
          </li>
        ))}
      </ul>
      <form onSubmit={keep}>
        <input
          aria-label="Name of a group"
          placeholder="Name"
          maxLength={name_max}
          value={name}
          data-testid="group-name"
          onInput={(event) => set_name(event.currentTarget.value)}
        />
        <button type="submit" disabled={selection.value.size === 0} data-testid="group-keep">
          Keep the {selection.value.size} selected
        </button>
      </form>
      {trouble && (
        <p class="problem alarm" role="alert">
          {trouble}
        </p>
      )}
    </Menu>
  );
}

function Columns() {
  const wanted = wanted_columns.value;
  const box = (column: Column) => {
    const on = wanted ? wanted.includes(column) : false;
    const change = () => {
      const now = wanted ?? ["id"];
      const next = on ? now.filter((one) => one !== column) : [...now, column];
      want_columns(column_names.filter((one) => one === "id" || next.includes(one)));
    };
    return (
      <label key={column}>
        <input type="checkbox" checked={on} onChange={change} data-testid={`column-${column}`} /> {column_titles[column]}
      </label>
    );
  };
  return (
    <Menu label="Columns" testid="columns-open">
      <fieldset>
        <legend class="only-spoken">Columns of the list</legend>
        <label>
          <input type="checkbox" checked={wanted === null} onChange={() => want_columns(wanted ? null : ["id", "state", "task", "heard", "range"])} data-testid="columns-auto" /> As many as fit
        </label>
        {wanted && column_names.filter((column) => column !== "id").map(box)}
      </fieldset>
      <p class="muted">What has no column is in the row, behind its ▸.</p>
    </Menu>
  );
}

export function FleetTools({ all, shown }: { all: readonly Vehicle[]; shown: number }) {
  const { text, group } = filter.value;
  const is_filtered = filter.value !== no_filter;
  const ids = listed.value.map((vehicle) => vehicle.id);
  const [open, set_open] = useState(false);
  const has_line = !narrow.value || open;
  return (
    <div class="fleet-tools">
      <div class="fleet-counts">
        {narrow.value && (
          <button type="button" aria-expanded={open} data-testid="fleet-tools-open" onClick={() => set_open(!open)}>
            {is_filtered ? `${shown} of ${all.length}` : "Filter"}
          </button>
        )}
        <Counts all={all} />
      </div>
      {has_line && <div class="fleet-filters">
        <input
          type="search"
          class="fleet-search"
          aria-label="List only: numbers as 3, 5-9, or words"
          placeholder="3, 5-9 or words"
          value={text}
          data-testid="fleet-search"
          onInput={(event) => (filter.value = { ...filter.value, text: event.currentTarget.value })}
          onKeyDown={(event) => {
            if (event.key === "Enter") select_all(ids);
          }}
        />
        {groups.value.length > 0 && (
          <select aria-label="List only the group" data-testid="fleet-group" value={group ?? ""} onChange={(event) => (filter.value = { ...filter.value, group: event.currentTarget.value || null })}>
            <option value="">all groups</option>
            {groups.value.map(({ name }) => (
              <option key={name} value={name}>
                {name}
              </option>
            ))}
          </select>
        )}
        <span class="muted" role="status" data-testid="fleet-shown">
          {shown === all.length ? `${all.length}` : `${shown} of ${all.length}`}
        </span>
        {is_filtered && (
          <button type="button" class="quiet" data-testid="fleet-clear" onClick={() => (filter.value = no_filter)}>
            Clear
          </button>
        )}
        {sorting.value.column !== null && (
          <button type="button" class="quiet" data-testid="sort-attention" title="What needs attention first" onClick={() => (sorting.value = { column: null, descending: false })}>
            Unsort
          </button>
        )}
        <span class="grow" />
        <Groups />
        <Columns />
      </div>}
    </div>
  );
}
