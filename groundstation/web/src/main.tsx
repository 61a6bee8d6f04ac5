// SPDX-License-Identifier: Apache-2.0
import { effect } from "@preact/signals";
import { render } from "preact";
import "leaflet/dist/leaflet.css";
import "uplot/dist/uPlot.min.css";
import "./theme/colours.css";
import "./theme/controls.css";
import "./shell/layout.css";
import "./shell/dialogs.css";
import "./map/map.css";
import "./fleet/fleet.css";
import "./mission/decisions.css";
import "./mission/mission.css";
import "./mission/timeline.css";
import "./orders/orders.css";
import "./log/log.css";
import "./plots/plots.css";
import "./preflight/preflight.css";
import "./replay/replay.css";
import "./links/links.css";
import "./returns/returns.css";
import "./wind/wind.css";
import { App } from "./shell/app";
import { theme } from "./shell/view";
import { start } from "./wire/store";

effect(() => void (document.documentElement.dataset["theme"] = theme.value));
render(<App />, document.getElementById("page")!);
void start();
