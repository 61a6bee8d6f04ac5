// SPDX-License-Identifier: Apache-2.0
import { useEffect } from "preact/hooks";
import { AreasPanel } from "../areas/areas_panel";
import { AlarmBar } from "../alarms/alarm_bar";
import { FleetPanel } from "../fleet/fleet_panel";
import { SelectionBar } from "../fleet/selection_bar";
import { LinksPanel } from "../links/links_panel";
import { LogPanel } from "../log/log_panel";
import { MapPanel } from "../map/map_panel";
import { Decisions } from "../mission/decisions";
import { MissionPanel } from "../mission/mission_panel";
import { TimelinePanel } from "../mission/timeline_panel";
import { OrdersPanel } from "../orders/orders_panel";
import { PlotsPanel } from "../plots/plots_panel";
import { PreflightPanel } from "../preflight/preflight_panel";
import { ReplayBar } from "../replay/replay_bar";
import { TrafficList } from "../traffic/traffic_list";
import { current, in_replay, lost_s, session } from "../wire/store";
import { Banners } from "./banners";
import { Guard } from "./guard";
import { Help } from "./help";
import { listen_to_keys } from "./keys";
import { follow_what_is_asked_for, map_in_front } from "./layout";
import { Login } from "./login";
import { Notices, SpokenAlarms } from "./notices";
import { Tabs } from "./tabs";
import { TopBar } from "./top_bar";
import { panel } from "./view";

const panel_of = {
  fleet: FleetPanel,
  mission: MissionPanel,
  orders: OrdersPanel,
  log: LogPanel,
  plots: PlotsPanel,
  preflight: PreflightPanel,
  links: LinksPanel,
  areas: AreasPanel,
} as const;

export function App() {
  useEffect(() => listen_to_keys(() => current().vehicles.map((vehicle) => vehicle.id)), []);
  useEffect(follow_what_is_asked_for, []);
  if (session.value === "needed" || session.value === "token_needed") return <Login by_token={session.value === "token_needed"} />;
  const Panel = panel_of[panel.value];
  return (
    <div class={`console${lost_s.value > 0 ? " is-old" : ""}`} data-testid="console">
      <TopBar />
      <Banners />
      <Guard what="The list of alarms">
        <AlarmBar />
      </Guard>
      <main class={`main ${map_in_front.value ? "map-in-front" : "panel-in-front"}`}>
        <div class="map-side" id="map">
          <Guard what="The map">
            <MapPanel />
          </Guard>
          <Guard what="The list of other aircraft">
            <TrafficList />
          </Guard>
          {in_replay.value && <ReplayBar />}
          <Guard what="The time line">
            <TimelinePanel />
          </Guard>
        </div>
        <aside class="panel-side" aria-label="Panels">
          <Guard what="The list of decisions">
            <Decisions />
          </Guard>
          <Tabs />
          <div class="panel" role="tabpanel" id="panel" aria-labelledby={`tab-${panel.value}`} tabIndex={-1}>
            <Guard what="This panel" key={panel.value}>
              <Panel />
            </Guard>
          </div>
          <Guard what="The selection">
            <SelectionBar />
          </Guard>
        </aside>
      </main>
      <Notices />
      <SpokenAlarms />
      <Help />
    </div>
  );
}
