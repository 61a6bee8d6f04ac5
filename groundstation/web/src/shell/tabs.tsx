// SPDX-License-Identifier: Apache-2.0
import { may_order, shown } from "../wire/store";
import { count_alarms } from "./alarms";
import { panel, panels } from "./view";
import type { Panel } from "./view";

const names: Record<Panel, string> = { fleet: "Fleet", mission: "Mission", orders: "Orders", log: "Log", plots: "Plots", preflight: "Preflight" };

export function Tabs() {
  const { waiting } = count_alarms(shown.value);
  const there = panels.filter((name) => name !== "orders" || may_order.value);
  const move = (step: number) => {
    const next = there[(there.indexOf(panel.value) + step + there.length) % there.length]!;
    panel.value = next;
    document.getElementById(`tab-${next}`)?.focus();
  };
  return (
    <div class="tabs" role="tablist" aria-label="Panels">
      {there.map((name) => (
        <button
          key={name}
          type="button"
          role="tab"
          id={`tab-${name}`}
          data-testid={`tab-${name}`}
          aria-selected={panel.value === name}
          aria-controls="panel"
          tabIndex={panel.value === name ? 0 : -1}
          onClick={() => (panel.value = name)}
          onKeyDown={(event) => {
            if (event.key === "ArrowRight") move(1);
            else if (event.key === "ArrowLeft") move(-1);
          }}
        >
          {names[name]}
          {name === "mission" && waiting > 0 && <span class="tab-count">{waiting}</span>}
        </button>
      ))}
    </div>
  );
}
