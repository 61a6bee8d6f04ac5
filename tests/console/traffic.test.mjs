// SPDX-License-Identifier: Apache-2.0
// An aircraft that is not of the team flies past a mission: a receiver of ADS-B tells of it, the page
// shows it and whom it comes too near to, and vehicles give way to it and come back.
import assert from "node:assert/strict";
import { once } from "node:events";
import { mkdir, readFile, writeFile } from "node:fs/promises";
import { createServer } from "node:net";
import { join, relative } from "node:path";
import { after, before, test } from "node:test";

import { fly, scenarios, until, work } from "./bench.mjs";
import { barriers, browse, say } from "./browser.mjs";

const kAddress = "4CA2D6";
const kOrigin = { latitude_deg: 31.522062, longitude_deg: 105.044327, height_m: 480 };
const kFoot_m = 0.3048;
const kMetresPerDegree = 111_320;

/** What a dump1090 said of one aircraft, and when: a recording, as its lines on port 30003 are. */
function recording({ from_m, speed_mps, height_m, seconds }) {
  const lines = [];
  const degrees = (metres) => metres / kMetresPerDegree;
  const altitude_ft = Math.round((kOrigin.height_m + height_m) / kFoot_m / 25) * 25;
  const knots = ((speed_mps * 3600) / 1852).toFixed(1);
  const line = (type, fields) => `MSG,${type},1,1,${kAddress},1,2026/06/01,10:20:30.123,2026/06/01,10:20:30.160,${fields}`;
  for (let t = 0; t < seconds; t += 0.5) {
    const east_m = from_m[0] + speed_mps * t;
    const latitude = kOrigin.latitude_deg + degrees(from_m[1]);
    const longitude = kOrigin.longitude_deg + degrees(east_m) / Math.cos((kOrigin.latitude_deg * Math.PI) / 180);
    if (t % 5 === 0) lines.push([t, line(1, "RYR12  ,,,,,,,,,,,0")]);
    lines.push([t, line(4, `,,${knots},90.0,,,0,,,,,0`)]);
    lines.push([t, line(3, `,${altitude_ft},,,${latitude.toFixed(5)},${longitude.toFixed(5)},,,0,,0,0`)]);
  }
  return lines;
}

/** A receiver that says a recording in its time, to whoever connects, and then nothing. */
async function receiver(lines) {
  const server = createServer();
  const timers = new Set();
  const sockets = new Set();
  let begun_ms = null;
  server.on("connection", (socket) => {
    begun_ms ??= Date.now();
    sockets.add(socket);
    socket.on("error", () => {});
    for (const [t, text] of lines) {
      const wait_ms = begun_ms + 1000 * t - Date.now();
      if (wait_ms < 0) continue;
      timers.add(setTimeout(() => socket.write(`${text}\r\n`), wait_ms));
    }
  });
  server.listen(0, "127.0.0.1");
  await once(server, "listening");
  return {
    port: server.address().port,
    stop() {
      for (const timer of timers) clearTimeout(timer);
      for (const socket of sockets) socket.destroy();
      server.close();
    },
  };
}

let adsb;
let mission;
let view;
before(async () => {
  // It is over the team after 80 s; between 100 and 150 m high, three of six are too near below 270 m.
  adsb = await receiver(recording({ from_m: [-4800, 0], speed_mps: 60, height_m: 270, seconds: 95 }));
  const folder = join(work, "traffic-scenario");
  await mkdir(folder, { recursive: true });
  const file = join(folder, "traffic.yaml");
  const yaml = await readFile(join(scenarios, "coalition-6.yaml"), "utf8");
  await writeFile(file, `${yaml.replace(/^duration_max_s: .*$/m, "duration_max_s: 240")}\nagencies: {adsb: {address: 127.0.0.1, port: ${adsb.port}}}\n`);
  mission = await fly(relative(scenarios, file), "traffic");
  view = await browse(mission.url);
});
after(async () => {
  adsb?.stop();
  await view?.browser.close();
  await mission?.stop();
});

const row = () => view.part(`traffic-${kAddress.toLowerCase()}`);
/** By the list of the fleet: the time line has the words of what was, too. */
const avoiding = async () => (await view.part("fleet").innerText()).includes("keeping clear of traffic");

test("it is on the page, with its callsign, its height over the nearest vehicle and its closest approach", async () => {
  await until("the aircraft", () => view.part("traffic").isVisible());
  await view.part("traffic-open").click();
  await until("its row", () => row().isVisible());
  await until("its callsign", async () => (await row().innerText()).includes("RYR12"));
  const text = await row().innerText();
  assert.match(text, /\+1\d\d m p/, "from pressure, above the team");
  assert.match(text, /km from \d/);
  assert.match(text, /\d+(\.\d+)? k?m in \d+ s/);
  assert.match(text, /090°\s+60 m\/s/);
});

test("vehicles that it comes too near to give way, and the page says so", async () => {
  await until("somebody who gives way", async () => (await row().getAttribute("data-standing")) === "given_way");
  assert.match(await row().innerText(), /vehicles? [\d, ]+ gives? way/);
  await until("its state", avoiding);
  assert.match(await view.part("traffic-summary").innerText(), /RYR12/);
  await view.picture("traffic");
});

/** Of the alarms that stand about the aircraft. */
const alarms = async () => (await say(view.page, { line: "alarms" })).data.list.filter(({ kind, over_s }) => kind === "traffic" && over_s === null);

test("its alarm counts down to when it is closest, and the team is not normal", async () => {
  await view.part("alarm-counts").click();
  const [{ key, closest_s }] = await until("an alarm", async () => {
    const all = await alarms();
    return all.length > 0 && all;
  });
  assert.ok(closest_s > 0);
  const text = () => view.part(`alarm-${key}`).innerText();
  const left = async () => Number(/closest in (\d+) s/.exec(await text())?.[1] ?? Number.NaN);
  const first = await left();
  assert.ok(first > 5 && first < 90, await text());
  await until("less", async () => (await left()) < first - 2);
  assert.match(await text(), /m to the side, \d+ m in height; gives way/);
  assert.match((await say(view.page, { line: "alarms" })).text, /gives way by its height; closest in \d+ s/);
  assert.match(await view.part("team-state").innerText(), /keep clear of other aircraft/);
  await view.part("alarm-counts").click();
});

test("who is held by order while it keeps clear is shown to be held, too", async () => {
  const [{ vehicle }] = await alarms();
  const answer = await say(view.page, { line: `hold ${vehicle}` });
  assert.equal(answer.done, true, answer.text);
  await view.part("tab-fleet").click();
  const fleet = () => view.part("fleet").innerText();
  await until("both words", async () => /holding by order, keeping clear of traffic/.test(await fleet()));
  assert.match((await say(view.page, { line: "status" })).text, new RegExp(`^ +${vehicle}  holding by order, keeps clear`, "m"));
  await view.picture("traffic-held");
});

test("its layer of the map can be taken away, and the list be used by keys and at any size", async () => {
  await view.part("layers-open").click();
  assert.equal(await view.part("layer-traffic").isChecked(), true);
  await view.part("layer-traffic").uncheck();
  await view.picture("traffic-without-layer");
  await view.part("layer-traffic").check();
  await view.part("layers-open").click();
  await row().locator("button").focus();
  await view.page.keyboard.press("Enter");
  assert.deepEqual(await barriers(view.page), []);
  const height = (id) => view.part(id).evaluate((element) => element.getBoundingClientRect().height);
  assert((await height("traffic-open")) >= 44);
  await view.page.setViewportSize({ width: 390, height: 844 });
  assert.deepEqual(await barriers(view.page), []);
  assert((await height("traffic-open")) >= 44);
  await view.picture("traffic-390");
  await view.page.setViewportSize({ width: 1280, height: 720 });
});

test("when it has passed they come back, and it is forgotten half a minute after its last word", async () => {
  await view.part("tab-fleet").click();
  await until("nobody who gives way", async () => !(await avoiding()), 120_000);
  assert.match(await view.part("fleet").innerText(), /holding by order/, "who was held stands");
  await view.part("tab-log").click();
  await view.part("log-text").fill("clear of aircraft");
  await until("the log", async () => /clear of aircraft 4ca2d6/.test(await view.part("log").innerText()));
  await until("no aircraft", async () => !(await view.part("traffic").isVisible()), 90_000);
});

test("nothing was asked of anybody else, and nothing was complained about", () => {
  assert.deepEqual(view.foreign, []);
  assert.deepEqual(view.complaints, []);
});
