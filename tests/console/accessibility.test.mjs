// SPDX-License-Identifier: Apache-2.0
// Every panel, with what opens over it, on a screen, a tablet and a telephone, at 100 % and at 200 %, by day and
// by night: no barrier that axe-core knows, what matters in sight, and nothing too small to be pressed.
import assert from "node:assert/strict";
import { after, before, describe, test } from "node:test";

import { until } from "./bench.mjs";
import { findings } from "./browser.mjs";
import { a_hello, a_request, a_site, a_vehicle, pretend } from "./station.mjs";

const states = ["searching", "surveying", "delivering", "holding_by_order", "returning", "landing", "waiting_for_authorisation"];
const vehicles = Array.from({ length: 50 }, (_, i) =>
  a_vehicle(i + 1, {
    state: states[i % states.length],
    task: i % 5 === 0 ? { site: 1, kind: "deliver", index: i % 3, time_s: 90, state: "planned" } : null,
    mode: i % 2 ? "GUIDED" : "AUTO", flight_controller: "ArduPilot", version: i === 7 ? "0.9" : "1",
    ...(i % 17 === 3 ? { problems: [{ level: "warning", text: "1.9 km of range are left" }, { level: "alarm", text: "its range is overdrawn" }] } : {}),
    ...(i === 9 ? { silent: true, state: "silent", heard_age_s: 12 } : {}),
  }),
);
const preflight = {
  summary: "49 of 50 ready, 1 not: 2 (parameters)",
  groups: ["clock", "network", "autopilot", "parameters", "GNSS", "battery", "fence", "files"],
  vehicles: vehicles.map(({ id }) => ({
    id, readiness: id === 2 ? "not_ready" : "ready", why: id === 2 ? "parameters" : "", counts: true, told_s: 70, release: id === 8 ? "0.9" : "1", firmware: "4.6", parameters: "0a1b2c3d",
    configuration: "deadbeef", odd: id === 8 ? ["release"] : [], marks: ["ok", "ok", "warn", id === 2 ? "fail" : "ok", "ok", "not_looked_at", "not_known", "ok"],
    lines: id === 2 ? [{ group: "parameters", verdict: "fail", what: "FS_LONG_ACTN", found: "not told", remedy: "set it to 1" }] : [], lines_left_out: 0,
  })),
};
const coalition = {
  key: "1-1-1", leader: 1, number: 1, site: 1, state: "formed", why: null, members: [1, 2, 3], lease_until_s: 90,
  rounds: [{ number: 1, announced_s: 10, bids_until_s: 15, reward: 2, tasks: ["deliver 1"], bids: [{ vehicle: 2, eta_s: 30, range_left_m: 4000, loads: 1 }], declined: [{ vehicle: 4, why: "no load" }], award: [{ vehicle: 2, task: "deliver 1", time_s: 60 }], answers: [{ vehicle: 2, accepted: true, why: null }], cancelled: null }],
};
const event = (seq) => ({ seq, time_s: seq, vehicle: (seq % 50) + 1, kind: "announced", level: seq % 9 ? "info" : "warning", site: 1, task: null, coalition: null, fields: {}, news: "announced site 1", text: `event ${seq}` });
const sections = {
  vehicles, plans: [], hazards: [{ id: 1, x: 500, y: 500, radius_m: 100 }], preflight,
  sites: [a_site(1, 200, 300, { leader: 1, tasks: [{ kind: "deliver", index: 0, bearing_deg: 7, vehicle: 1, time_s: 90, state: "planned" }] }), a_site(2, 900, 200, { status: "done" })],
  coalitions: [coalition], authorisations: [a_request(1), a_request(2, { silent: [2] })],
  timeline: { states: ["searching", "surveying"], vehicles: vehicles.map(({ id }) => ({ id, states: [0, 1], from_s: [0, 40], sites: [null, 1] })) },
  audit: [{ seq: 1, time_s: 12, who: "ada", from: "console", line: "hold 1-3", done: true, text: "told to 1-3" }],
  proposals: [{ number: 1, kind: "fire", x: 10, y: 20, seen_by: 2, confidence: 0.8, detector: "thermal", time_s: 60 }],
};

/** Of every kind: good, lossy, bad, through others, old, and of an older release. */
const a_link = (id, i) => ({ id, age_s: i === 5 ? 30 : 0.2, per_s: i === 6 ? null : 9.5, lost_percent: [2, 12, 40, 100, 0, 0, null][i], bytes_per_s: id === 1 ? 1200 : null, through_others: i === 3 });
sections.links = [0, 1, 2, 3, 4, 5, 6, 7].map((who) => ({
  id: who, told_age_s: who === 7 ? null : 0.4, tells_loss: true,
  hears: who === 7 ? [] : [0, 1, 2, 3, 4, 5, 6, 7].filter((whom) => whom !== who).map((whom, i) => a_link(whom, i)),
}));
sections.wind = { from_deg: 240, speed_mps: 4.1, gust_mps: 6, age_s: 0.3, spread_mps: 0.4, vehicles: [{ id: 4, from_deg: 238, speed_mps: 4, gust_mps: 6, age_s: 0.3 }] };

const an_alarm = (number, level, other = {}) => ({
  number, key: `range ${number}`, kind: "range_reserve", level, since_s: 40, over_s: null, what: `vehicle ${number} has run into its reserve and flies home`, remedy: "Let it come home.",
  times: 1, vehicle: number, other: null, site: null, panel: "fleet", offers: ["hold"], acknowledged: null, ...other,
});
sections.alarms = {
  counts: { alarm: 2, warning: 1, notice: 0, unacknowledged: 3 }, orders: [],
  list: [an_alarm(4, "alarm"), an_alarm(21, "alarm"), an_alarm(9, "warning"), an_alarm(8, "warning", { acknowledged: { by: "ada", at_s: 50 } })],
};
sections.areas = { search: null, hazards: [] };
sections.traffic = [];

/** Of the screen at 100 %; at 200 % the page has half of it, and each of its pixels is four. */
const screens = [{ width: 1440, height: 900 }, { width: 1024, height: 768 }, { width: 390, height: 844 }];

/** What is not in sight as a whole, or lies under something else. */
const out_of_sight = (page, ids) =>
  page.evaluate((wanted) => {
    const wrong = [];
    for (const id of wanted) {
      const element = document.querySelector(`[data-testid="${id}"]`);
      if (!element) {
        wrong.push(`${id}: is not there`);
        continue;
      }
      const { left, top, right, bottom } = element.getBoundingClientRect();
      const inside = left >= -0.5 && top >= -0.5 && right <= innerWidth + 0.5 && bottom <= innerHeight + 0.5 && right > left;
      const over = document.elementFromPoint((left + right) / 2, (top + bottom) / 2);
      if (!inside) wrong.push(`${id}: ${[left, top, right, bottom].map(Math.round)} of ${innerWidth} x ${innerHeight}`);
      else if (!over || !(element === over || element.contains(over))) wrong.push(`${id}: under ${over?.outerHTML.slice(0, 80)}`);
    }
    if (document.documentElement.scrollWidth > innerWidth) wrong.push(`the page is ${document.documentElement.scrollWidth} wide`);
    return wrong;
  }, ids);

/** What can be pressed and is less than `least` pixels high or wide. */
const too_small = (page, least) =>
  page.evaluate((px) => {
    const seen = (element) => {
      const { width, height } = element.getBoundingClientRect();
      return width > 0 && height > 0 && element.checkVisibility({ visibilityProperty: true });
    };
    // A box that is ticked is pressed on its label.
    const area = (element) => (element.matches("input[type=checkbox], input[type=radio]") && element.closest("label")) || element;
    const targets = [...new Set([...document.querySelectorAll("button, select, input, summary, a[href]")].filter((one) => !one.closest(".leaflet-control-attribution")).map(area))].filter(seen);
    return targets
      .map((element) => ({ element, box: element.getBoundingClientRect() }))
      .filter(({ box }) => box.height < px - 0.5 || box.width < px - 0.5)
      .map(({ element, box }) => `${element.outerHTML.slice(0, 110)}: ${box.width.toFixed(0)} x ${box.height.toFixed(0)}`);
  }, least);

const panels = ["fleet", "mission", "orders", "log", "plots", "preflight", "links", "areas"];

async function open(view, name) {
  if ((await view.part(`tab-${name}`).count()) === 0) await view.part("tabs-more").click();
  await view.part(`tab-${name}`).click();
  await until(name, async () => (await view.part(`tab-${name}`).getAttribute("aria-selected")) === "true");
}

for (const { width, height } of screens) {
  for (const percent of [100, 200]) {
    describe(`${width} px at ${percent} %`, () => {
      const scale = percent / 100;
      const viewport = { width: Math.round(width / scale), height: Math.round(height / scale) };
      const for_fingers = viewport.width <= 820;
      let station;
      let view;
      let page;
      before(async () => {
        station = await pretend(`access-${width}-${percent}`, a_hello(50), sections, { viewport, deviceScaleFactor: scale, colorScheme: "light" });
        ({ view } = station);
        ({ page } = view);
        station.tell({ type: "events", events: Array.from({ length: 60 }, (_, i) => event(i + 1)) });
        await until("the decisions", () => view.part("request-1").isVisible());
      });
      after(() => station?.stop());

      async function both(what, wanted) {
        const wrong = [];
        for (const colours of ["night", "day"]) {
          await page.evaluate((name) => (document.documentElement.dataset.theme = name), colours);
          // What is there is the same in both; only its colours are not.
          wrong.push(...(await findings(page, colours === "night" ? ["color-contrast"] : null)).map((one) => `${what}, ${colours}: ${one}`));
        }
        wrong.push(...(await out_of_sight(page, wanted)).map((one) => `${what}: ${one}`));
        wrong.push(...(await too_small(page, for_fingers ? 44 : 24)).map((one) => `${what}: ${one}`));
        return wrong;
      }

      test("the fleet, with decisions that wait", async () => {
        const wrong = await both("decisions", ["hold-all", "authorise-1", "refuse-1", "tab-fleet"]);
        await view.picture(`access-decisions-${width}-${percent}`);
        assert.deepEqual(wrong, []);
      });

      test("every panel", async () => {
        station.state({ authorisations: [] });
        await until("no decisions", async () => (await view.part("decisions").count()) === 0);
        const wrong = [];
        for (const name of panels) {
          await open(view, name);
          wrong.push(...(await both(name, ["hold-all", `tab-${name}`])));
          await view.picture(`access-${name}-${width}-${percent}`);
        }
        await open(view, "links");
        for (const way of ["matrix", "list"]) {
          await view.part(`links-${way}`).click();
          wrong.push(...(await both(`links, ${way}`, [])));
        }
        await open(view, "preflight");
        await view.part("preflight-versions").click();
        wrong.push(...(await both("versions", ["hold-all", "preflight-versions"])));
        await view.part("preflight-checks").click();
        await view.part("preflight-2").getByRole("button").click();
        wrong.push(...(await both("a preflight row", ["hold-all"])));
        assert.deepEqual(wrong, []);
      });

      test("what opens: a selection, a vehicle, menus, help", async () => {
        const wrong = [];
        await open(view, "fleet");
        await view.part("pick-4").click();
        wrong.push(...(await both("one vehicle", ["hold-all", "vehicle-hold"])));
        await view.part("pick-21").click();
        wrong.push(...(await both("a selection", ["hold-all", "selection-hold", "selection-land"])));
        await view.picture(`access-selection-${width}-${percent}`);
        await view.part("selection-clear").click();
        if (await view.part("fleet-tools-open").count()) await view.part("fleet-tools-open").click();
        for (const name of ["groups", "columns"]) {
          await view.part(`${name}-open`).click();
          wrong.push(...(await both(name, [`${name}-open-sheet`])));
          await view.picture(`access-${name}-menu-${width}-${percent}`);
          await page.keyboard.press("Escape");
        }
        for (const name of ["menu", "tabs-more"]) {
          if ((await view.part(name).count()) === 0) continue;
          await view.part(name).click();
          wrong.push(...(await both(name, [`${name}-sheet`])));
          await page.keyboard.press("Escape");
        }
        if (await view.part("tab-map").count()) await view.part("tab-map").click();
        if (await view.part("map-tools").count()) {
          await view.part("map-tools").click();
          wrong.push(...(await both("tools", ["map-tools-sheet"])));
          await view.picture(`access-tools-${width}-${percent}`);
          await page.keyboard.press("Escape");
        } else {
          await view.part("layers-open").click();
          wrong.push(...(await both("layers", ["layer-grid"])));
          await view.part("layers-open").click();
        }
        await page.keyboard.press("?");
        await until("the help", () => view.part("help").isVisible());
        wrong.push(...(await both("help", [])));
        await view.part("help-close").scrollIntoViewIfNeeded();
        wrong.push(...(await out_of_sight(page, ["help-close"])));
        await view.part("help-close").click();
        assert.deepEqual(wrong, []);
        assert.deepEqual(view.complaints, []);
      });
    });
  }
}
