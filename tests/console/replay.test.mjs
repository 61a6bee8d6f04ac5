// SPDX-License-Identifier: Apache-2.0
// A flown mission seen again: the page jumps, plays and shows what there was.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { once } from "node:events";
import { join } from "node:path";
import { after, before, test } from "node:test";

import rosmsg from "@foxglove/rosmsg";
import serialization from "@foxglove/rosmsg2-serialization";
import protocol_package from "@foxglove/ws-protocol";
import WebSocket from "ws";

import { fly, free_port, programs, until } from "./bench.mjs";
import { browse } from "./browser.mjs";

const { FoxgloveClient } = protocol_package;
const { parse } = rosmsg;
const { MessageReader } = serialization;

let mission;
let player;
let view;
after(async () => {
  await view?.browser.close();
  player?.kill("SIGTERM");
  await mission?.stop();
});

/** What a client that speaks as Foxglove does hears of a topic. */
async function hear(url, topic, wanted) {
  const socket = new WebSocket(url, [FoxgloveClient.SUPPORTED_SUBPROTOCOL]);
  const client = new FoxgloveClient({ ws: socket });
  const heard = [];
  const readers = new Map();
  client.on("advertise", (channels) => {
    for (const channel of channels) {
      if (channel.topic !== topic) continue;
      assert.equal(channel.encoding, "cdr");
      readers.set(client.subscribe(channel.id), new MessageReader(parse(channel.schema, { ros2: true })));
    }
  });
  client.on("message", ({ subscriptionId, data }) => heard.push(readers.get(subscriptionId).readMessage(data)));
  await until(`${wanted} messages of ${topic}`, () => heard.length >= wanted);
  client.close();
  return heard;
}

before(async () => {
  mission = await fly("coalition-6.yaml", "replay", ["--rate", "2"]);
});

test("Foxglove's own client hears telemetry live", async () => {
  const heard = await hear(mission.socket, "/vehicle_03/telemetry", 5);
  for (const telemetry of heard) assert.equal(telemetry.vehicle, 3);
  assert.ok(heard.at(-1).state.time_ns > heard[0].state.time_ns);
});

// The client above knows the older name only; what is said is the same.
test("the newer subprotocol is spoken too", async () => {
  const socket = new WebSocket(mission.socket, ["foxglove.sdk.v1"]);
  let records = 0;
  const said = [];
  socket.on("message", (data, binary) => {
    if (binary) return void (records += 1);
    const text = JSON.parse(data);
    said.push(text.op);
    for (const { id } of text.channels ?? []) socket.send(JSON.stringify({ op: "subscribe", subscriptions: [{ id: 100 + id, channelId: id }] }));
  });
  await until("records", () => records > 10);
  assert.equal(socket.protocol, "foxglove.sdk.v1");
  assert.equal(said[0], "serverInfo");
  socket.close();
});

test("a recording is opened, shown and played", async () => {
  await until("half a minute", async () => mission.text().includes("coalition_formed") || mission.text().includes("coalition formed"));
  await mission.stop();
  const port = await free_port();
  player = spawn(join(programs, "skein-ground"), ["replay", mission.folder, "--port", String(port)], { stdio: ["pipe", "pipe", "pipe"] });
  let text = "";
  player.stdout.on("data", (data) => (text += data));
  player.stderr.on("data", (data) => (text += data));
  await until("the console of the replay", () => text.includes("console: http"), 30_000);
  view = await browse(`http://127.0.0.1:${port}/`);
  await until("the banner", () => view.part("banner-replay").isVisible());
  await until("six vehicles", async () => (await view.part("count-heard").innerText()).includes("6/6"));
  assert.equal(await view.part("hold-all").count(), 0);
});

test("it can be paused, and any moment be looked at, back and forth", async () => {
  const seconds = async () => {
    const text = await view.part("replay-time").innerText();
    const [, minutes, rest] = /(\d+):(\d+(?:\.\d+)?)/.exec(text);
    return 60 * Number(minutes) + Number(rest);
  };
  await view.part("replay-play").click();
  const jump = async (to) => {
    await view.part("replay-scrubber").fill(String(to));
    await until(`second ${to}`, async () => Math.abs((await seconds()) - to) < 1.1);
  };
  await view.part("tab-mission").click();
  await jump(15);
  await until("the site", () => view.part("site-1").isVisible());
  await view.picture("replay");
  const late = await view.part("site-1").innerText();
  await jump(1);
  await until("no site yet", async () => (await view.page.locator('[data-testid="site-1"]').count()) === 0);
  await jump(15);
  await until("the site again", () => view.part("site-1").isVisible());
  assert.equal(await view.part("site-1").innerText(), late);
});

test("nothing was asked of anybody else, and nothing was complained about", () => {
  assert.deepEqual(view.foreign, []);
  assert.deepEqual(view.complaints, []);
});
