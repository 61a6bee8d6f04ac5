// SPDX-License-Identifier: Apache-2.0
// What the page makes of what it is told, and of hearing nothing more: a ground station of the test's
// own speaks to it, so that every moment can be looked at.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { once } from "node:events";
import { mkdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";

import { free_port, programs, until, work } from "./bench.mjs";
import { barriers, browse } from "./browser.mjs";

const folder = join(work, "truth");
let station;
let view;
/** The page's newest socket; null: none is let in. */
let line = null;
let lets_in = true;

const vehicle = (id, other = {}) => ({
  id, expected: true, silent: false, duplicate: false, revoked: false, x: 100 * id, y: 0, z: 100, heading_deg: 90, course_deg: 90,
  groundspeed: 20, airspeed: 20, activity: "searching", state: "searching", task: null, heard_age_s: 0.1, clock_offset_ms: 30,
  range_left_m: 5000, loads: 1, plan_number: 1, version: "1", flight_controller: null, mode: null, problems: [], links: [],
  control_overruns: 0, messages_dropped: 0, ...other,
});

const hello = {
  type: "hello", program: "skein-ground 1", run: "a", role: "operator", user: "ada",
  origin: { latitude_deg: 47, longitude_deg: 8, height_m: 0 }, epoch_unix_s: 1700014400, expected: [1, 2], shapes: ["wedge"], site_templates: [],
  limits: { coordinate_m: [-1e5, 1e5], hazard_radius_m: [1, 1e4], spacing_m: [0.5, 1000], heading_deg: [-360, 360], places: [1, 100], tasks: [0, 16], interval_s: [0, 100], dwell_s: [1, 100], reward: [0, 100] },
  sealed: true, replay: null, tiles: null, overlays: [],
};

const request = {
  site: 1, leader: 1, coalition: "1-1-1", round: 2, x: 0, y: 0, latitude_deg: 47, longitude_deg: 8, asked_s: 70, decide_by_s: 500, waiting: true,
  decision: null, can_take_back: false, silent: [2], leader_marks: [],
  deliveries: [
    { vehicle: 1, index: 0, time_s: 510, bearing_deg: 7, marks: [] },
    { vehicle: 2, index: 1, time_s: 510, bearing_deg: 90, marks: [{ level: "alarm", text: "silent for 12 s: it may not hear the decision" }] },
  ],
  missing: [{ index: 2, bearing_deg: 240, why: "2 that can deliver have bid" }],
  did_not_bid: [{ vehicle: 3, why: "not enough range left" }],
  changes: ["round 1 was not decided", "delivery 1: 12.0 s later"],
};

const tell = (message) => line.send(JSON.stringify(message));
const state = (sections, time_s = 71.9) => tell({ type: "state", time_s, ...sections });

async function serve() {
  mkdirSync(folder, { recursive: true });
  const port = await free_port();
  writeFileSync(
    join(folder, "ground.yaml"),
    `version: 1
origin: {latitude_deg: 47, longitude_deg: 8}
vehicles: [1, 2]
console: {port: ${port}}
control_socket: skein-console-truth-${port}
network: {port: ${await free_port()}}
time: {epoch_unix_ns: ${BigInt(Date.now()) * 1000000n}}
recording_folder: recording
`,
  );
  station = spawn(join(programs, "skein-ground"), ["--config", "ground.yaml"], { cwd: folder, stdio: ["pipe", "pipe", "pipe"] });
  let text = "";
  station.stdout.on("data", (data) => (text += data));
  await until("the console", () => text.includes(`console: http://127.0.0.1:${port}/`));
  station.stdin.write("console\n");
  return until("what opens it", () => /http:\/\/127\.0\.0\.1:\d+\/#[0-9a-f]{32}/.exec(text)?.[0]);
}

before(async () => {
  const url = await serve();
  view = await browse("about:blank");
  await view.page.routeWebSocket(/\/socket$/, (socket) => {
    if (!lets_in) return void socket.close();
    socket.onMessage((text) => {
      if (JSON.parse(text).type !== "resume") return;
      line = socket;
      tell(hello);
      tell({ type: "history", series: [], events: { first_seq: 0, next_seq: 0 } });
      state({ vehicles: [vehicle(1), vehicle(2)] });
    });
  });
  await view.page.goto(url);
  await until("the connection", async () => (await view.part("link-state").innerText()).includes("connected"));
});
after(async () => {
  await view?.browser.close();
  if (!station || station.exitCode !== null) return;
  station.kill("SIGTERM");
  await once(station, "exit");
});

const row = (id) => view.part(`vehicle-${id}`);

test("states are told apart in words, and UTC stands beside mission time", async () => {
  state({
    vehicles: [
      vehicle(1, { activity: "holding", state: "range_reserve" }),
      vehicle(2, { activity: "executing", state: "waiting_for_authorisation", task: { site: 1, kind: "deliver", index: 0, time_s: 90, state: "planned" } }),
    ],
  });
  await view.part("tab-fleet").click();
  await until("the states", async () => /range reserve/.test(await row(1).innerText()) && /waiting for authorisation/.test(await row(2).innerText()));
  assert.match(await view.part("utc").innerText(), /^02:14:3\d UTC$/);
  assert.match(await view.part("count-heard").innerText(), /2\/2/);
});

test("vehicles on the map move on between states, unless less motion is asked for", async () => {
  // How often the busiest canvas is painted after one state: until that is often, or for so long.
  const paintings = async (reducedMotion, often, at_most_ms) => {
    await view.page.emulateMedia({ reducedMotion });
    state({ vehicles: [vehicle(1), vehicle(2)] });
    return view.page.evaluate(([enough, patience_ms]) => new Promise((done) => {
      const { prototype } = CanvasRenderingContext2D;
      const { clearRect } = prototype;
      const paintings = new Map();
      const end = () => {
        prototype.clearRect = clearRect;
        done(Math.max(0, ...paintings.values()));
      };
      const late = setTimeout(end, patience_ms);
      prototype.clearRect = function (...where) {
        clearRect.apply(this, where);
        paintings.set(this.canvas, (paintings.get(this.canvas) ?? 0) + 1);
        if (paintings.get(this.canvas) !== enough) return;
        clearTimeout(late);
        end();
      };
    }), [often, at_most_ms]);
  };
  const often = 8;
  assert.equal(await paintings("no-preference", often, 20_000), often);
  assert.ok(await paintings("reduce", often, 1_000) < often / 2);
});

test("what the operator refuses is not drawn with a vehicle any more", async () => {
  state({
    vehicles: [vehicle(1), vehicle(2)],
    sites: [{ id: 1, x: 0, y: 0, leader: null, surveyor: null, reward: 1, status: "refused", news: "", tasks: [{ kind: "deliver", index: 0, bearing_deg: 7, vehicle: null, time_s: null, state: "open" }] }],
  });
  await view.part("tab-mission").click();
  await until("the site", async () => /refused by the operator/.test(await view.part("site-1").innerText()));
  await view.part("tab-fleet").click();
  assert.doesNotMatch(await row(2).innerText(), /deliver/);
});

test("a card says what speaks against it", async () => {
  state({ authorisations: [request] });
  await until("the card", () => view.part("request-1").isVisible());
  const text = await view.part("request-1").innerText();
  for (const words of ["2 of 3 deliveries to authorise", "at the origin", "007°", "090°", "silent for 12 s", "missing: 2 that can deliver have bid", "3 (not enough range left)", "round 1 was not decided; delivery 1: 12.0 s later"]) {
    assert.ok(text.includes(words), `${words} in\n${text}`);
  }
  await view.picture("card");
});

test("without connection everything ages and is grey, and nothing can be decided", async () => {
  lets_in = false;
  await line.close();
  await until("the banner", () => view.part("banner-lost").isVisible());
  assert.match(await view.part("count-heard").innerText(), /–\/2/);
  assert.match(await view.part("count-alarms").innerText(), /–/);
  assert.match(await view.part("console").getAttribute("class"), /is-old/);
  assert.equal(await row(1).getAttribute("data-health"), "stale");
  const heard_s = async () => Number(/([\d.]+) s/.exec(await row(1).locator("td").nth(2).innerText())?.[1]);
  const before_s = await heard_s();
  assert.ok(before_s > 1, `heard ${before_s} s ago`);
  await until("its age", async () => (await heard_s()) > before_s + 1);
  assert.equal(await view.part("authorise-1").count(), 0);
  assert.match(await view.part("request-1").innerText(), /no connection/);
  assert.deepEqual(await barriers(view.page), []);
  await view.picture("lost");
});

test("it is well again with the connection", async () => {
  lets_in = true;
  await until("the connection", async () => (await view.part("link-state").innerText()).includes("connected"));
  await until("the vehicles", async () => (await row(1).getAttribute("data-health")) === "well");
  assert.match(await view.part("count-heard").innerText(), /2\/2/);
});

test("a ground station that ends leaves a summary, and no lost connection", async () => {
  tell({ type: "ended", time_s: 95, text: "1 of 1 sites done, 3 of 3 deliveries flown, 2 of 2 assessments\nin the air, and fly on without the ground station: 1, 2\n" });
  lets_in = false;
  await line.close();
  await until("the summary", () => view.part("banner-ended").isVisible());
  const text = await view.part("banner-ended").innerText();
  assert.match(text, /ended at 01:35/);
  assert.match(text, /3 of 3 deliveries flown/);
  assert.match(text, /fly on without the ground station: 1, 2/);
  await until("ages", async () => (await row(1).getAttribute("data-health")) === "stale");
  assert.equal(await view.part("banner-lost").count(), 0);
  assert.match(await view.part("link-state").innerText(), /ended/);
  await view.picture("ended");
});

test("nothing was asked of anybody else, and nothing was complained about", () => {
  assert.deepEqual(view.foreign.filter((url) => !url.startsWith("http://127.0.0.1")), []);
  assert.deepEqual(view.complaints, []);
});
