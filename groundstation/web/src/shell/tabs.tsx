// SPDX-License-Identifier: Apache-2.0
import { useLayoutEffect, useRef, useState } from "preact/hooks";
import { may_order, shown } from "../wire/store";
import { count_alarms } from "./alarms";
import { map_in_front, narrow, single } from "./layout";
import { Menu } from "./menu";
import { tabs_that_fit } from "./tab_room";
import { panel, panels } from "./view";
import type { Panel } from "./view";

type Tab = Panel | "map";

const names: Record<Tab, string> = { map: "Map", fleet: "Fleet", mission: "Mission", orders: "Orders", log: "Log", plots: "Plots", preflight: "Preflight", links: "Links", areas: "Areas" };

function show(name: Tab): void {
  if (name !== "map") panel.value = name;
  map_in_front.value = name === "map";
}

function Label({ name, waiting }: { name: Tab; waiting: number }) {
  return (
    <>
      {names[name]}
      {name === "mission" && waiting > 0 && <span class="tab-count">{waiting}</span>}
    </>
  );
}

/** Those that have room in one line, where there is none for a second; the chosen one is among them. */
function useRoom(all: readonly Tab[], chosen: Tab, waiting: number) {
  const whole = useRef<HTMLDivElement>(null);
  const measure = useRef<HTMLDivElement>(null);
  const [width, set_width] = useState(0);
  const [fitting, set_fitting] = useState<readonly Tab[]>(all);
  useLayoutEffect(() => {
    const element = whole.current!;
    const watch = new ResizeObserver(() => set_width(element.clientWidth));
    watch.observe(element);
    return () => watch.disconnect();
  }, []);
  const key = all.join(" ");
  useLayoutEffect(() => {
    if (!narrow.value || !measure.current) return set_fitting(all);
    const widths = [...measure.current.children].map((child) => (child as HTMLElement).offsetWidth);
    const more_px = widths.pop() ?? 0;
    set_fitting(tabs_that_fit(all, widths, whole.current!.clientWidth, more_px, all.indexOf(chosen)));
  }, [key, chosen, width, waiting > 0, narrow.value]);
  return { whole, measure, fitting: narrow.value ? fitting.filter((name) => all.includes(name)) : all };
}

export function Tabs() {
  const { waiting } = count_alarms(shown.value);
  const there: Tab[] = [...(single.value ? (["map"] as const) : []), ...panels.filter((name) => name !== "orders" || may_order.value)];
  const chosen: Tab = single.value && map_in_front.value ? "map" : panel.value;
  const { whole, measure, fitting } = useRoom(there, chosen, waiting);
  const hidden = there.filter((name) => !fitting.includes(name));
  const waits_behind = hidden.includes("mission") && waiting > 0;
  const move = (step: number) => {
    const next = there[(there.indexOf(chosen) + step + there.length) % there.length]!;
    show(next);
    // It may have had no place until now.
    window.setTimeout(() => document.getElementById(`tab-${next}`)?.focus());
  };
  return (
    <div class="tabs" ref={whole}>
      <div class="tab-list" role="tablist" aria-label="Panels">
        {fitting.map((name) => (
          <button
            key={name}
            type="button"
            role="tab"
            id={`tab-${name}`}
            data-testid={`tab-${name}`}
            aria-selected={chosen === name}
            aria-controls={name === "map" ? "map" : "panel"}
            tabIndex={chosen === name ? 0 : -1}
            onClick={() => show(name)}
            onKeyDown={(event) => {
              if (event.key === "ArrowRight") move(1);
              else if (event.key === "ArrowLeft") move(-1);
            }}
          >
            <Label name={name} waiting={waiting} />
          </button>
        ))}
      </div>
      {hidden.length > 0 && (
        <Menu testid="tabs-more" closes label={<>More{waits_behind && <span class="tab-count">{waiting}</span>}</>} spoken={`More panels${waits_behind ? `, ${waiting} waiting` : ""}`}>
          {hidden.map((name) => (
            <button key={name} type="button" class="quiet" data-testid={`tab-${name}`} onClick={() => show(name)}>
              <Label name={name} waiting={waiting} />
            </button>
          ))}
        </Menu>
      )}
      {narrow.value && (
        <div class="tab-list measure" ref={measure} aria-hidden="true">
          {there.map((name) => (
            <span key={name} class="tab">
              <Label name={name} waiting={waiting} />
            </span>
          ))}
          <span class="tab">
            More<span class="tab-count">9</span>
          </span>
        </div>
      )}
    </div>
  );
}
