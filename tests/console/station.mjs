// SPDX-License-Identifier: Apache-2.0
// A ground station that serves the page, and whose socket is the test's own: so that every moment of any
// fleet can be looked at.
import { spawn } from "node:child_process";
import { once } from "node:events";
import { mkdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";

import { free_port, programs, until, work } from "./bench.mjs";
import { browse } from "./browser.mjs";

export const a_vehicle = (id, other = {}) => ({
  id, expected: true, silent: false, duplicate: false, revoked: false, x: 100 * (id % 20), y: 100 * Math.floor(id / 20), z: 100, heading_deg: 90, course_deg: 90,
  groundspeed: 20, airspeed: 20, activity: "searching", state: "searching", task: null, heard_age_s: 0.1, clock_offset_ms: 30,
  range_left_m: 5000, loads: 1, plan_number: 1, version: "1", flight_controller: null, mode: null, problems: [], links: [],
  control_overruns: 0, messages_dropped: 0, ...other,
});

export const a_hello = (vehicles, other = {}) => ({
  type: "hello", program: "skein-ground 1", run: "a", role: "operator", user: "ada",
  origin: { latitude_deg: 47, longitude_deg: 8, height_m: 0 }, epoch_unix_s: 1700014400, expected: Array.from({ length: vehicles }, (_, i) => i + 1), shapes: ["wedge"], site_templates: [],
  limits: { coordinate_m: [-1e5, 1e5], hazard_radius_m: [1, 1e4], spacing_m: [0.5, 1000], heading_deg: [-360, 360], places: [1, 100], tasks: [0, 16], interval_s: [0, 100], dwell_s: [1, 100], reward: [0, 100] },
  sealed: true, replay: null, tiles: null, overlays: [], groups: [], ...other,
});

export const a_site = (id, x, y, other = {}) => ({ id, x, y, leader: null, surveyor: null, reward: 1, status: "found", news: null, tasks: [], ...other });

export const a_request = (site, other = {}) => ({
  site, leader: 1, coalition: `1-1-${site}`, round: 2, x: 0, y: 0, latitude_deg: 47, longitude_deg: 8, asked_s: 70, decide_by_s: 500, waiting: true,
  decision: null, can_take_back: false, silent: [], leader_marks: [],
  deliveries: [
    { vehicle: 1, index: 0, time_s: 510, bearing_deg: 7, marks: [], before_gate: false },
    { vehicle: 2, index: 1, time_s: 510, bearing_deg: 90, marks: [{ level: "alarm", text: "silent for 12 s: it may not hear the decision" }], before_gate: false },
  ],
  missing: [{ index: 2, bearing_deg: 240, why: "2 that can deliver have bid" }],
  did_not_bid: [{ vehicle: 3, why: "not enough range left" }],
  changes: ["round 1 was not decided", "delivery 1: 12.0 s later"], ...other,
});

/** Opens the page; `hello` and `sections` are what it is told first. Orders that it gives are kept, and answered as done. */
export async function pretend(name, hello, sections, options = {}) {
  const folder = join(work, name);
  mkdirSync(folder, { recursive: true });
  const port = await free_port();
  writeFileSync(
    join(folder, "ground.yaml"),
    `version: 1
origin: {latitude_deg: 47, longitude_deg: 8}
vehicles: [1, 2]
console: {port: ${port}}
control_socket: skein-console-${name}-${port}
network: {port: ${await free_port()}}
time: {epoch_unix_ns: ${BigInt(Date.now()) * 1000000n}}
recording_folder: recording
`,
  );
  const program = spawn(join(programs, "skein-ground"), ["--config", "ground.yaml"], { cwd: folder, stdio: ["pipe", "pipe", "pipe"] });
  let text = "";
  program.stdout.on("data", (data) => (text += data));
  await until("the console", () => text.includes(`console: http://127.0.0.1:${port}/`));
  program.stdin.write("console\n");
  const url = await until("what opens it", () => /http:\/\/127\.0\.0\.1:\d+\/#[0-9a-f]{32}/.exec(text)?.[0]);

  const orders = [];
  let line = null;
  let time_s = 71.9;
  const tell = (message) => line.send(JSON.stringify(message));
  const view = await browse("about:blank", options);
  const here = {
    view,
    orders,
    tell,
    /** The next state. */
    state: (more) => tell({ type: "state", time_s: (time_s += 0.1), ...more }),
    stop: async () => {
      await view.browser.close();
      if (program.exitCode !== null) return;
      program.kill("SIGTERM");
      await once(program, "exit");
    },
  };
  await view.page.routeWebSocket(/\/socket$/, (socket) => {
    socket.onMessage((sent) => {
      const message = JSON.parse(sent);
      if (message.type === "resume") {
        line = socket;
        tell(hello);
        tell({ type: "history", series: [], events: { first_seq: 0, next_seq: 0 } });
        here.state(sections);
      }
      if (message.type === "ping") tell({ type: "pong", id: message.id, time_s });
      if (message.type !== "order") return;
      orders.push(message.order);
      tell({ type: "answer", id: message.id, done: true, text: "done\n", data: null });
    });
  });
  // A page of a build that no program has yet may be looked at.
  const served = process.env.SKEIN_PAGE || url;
  if (process.env.SKEIN_PAGE) await view.page.route(/\/session$/, (route) => route.fulfill({ json: { user: hello.user, role: hello.role } }));
  await view.page.goto(served);
  await until("the connection", async () => (await view.part("link-state").innerText()).includes("connected"));
  return here;
}
