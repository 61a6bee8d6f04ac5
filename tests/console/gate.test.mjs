// SPDX-License-Identifier: Apache-2.0
// Who is let in, over HTTPS with passwords; and a ground station that starts anew under an open page.
import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import { once } from "node:events";
import { mkdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";

import { free_port, programs, until, work } from "./bench.mjs";
import { browse, say } from "./browser.mjs";

const folder = join(work, "gate");
const ground = join(programs, "skein-ground");
let port;
let station;
let view;

async function start() {
  station = spawn(ground, ["--config", "ground.yaml"], { cwd: folder, stdio: ["ignore", "pipe", "pipe"] });
  let text = "";
  station.stdout.on("data", (data) => (text += data));
  await until(`the console\n${text}`, () => text.includes(`console: https://127.0.0.1:${port}/`));
}

async function stop() {
  if (!station || station.exitCode !== null) return;
  station.kill("SIGTERM");
  await once(station, "exit");
}

before(async () => {
  mkdirSync(folder, { recursive: true });
  execFileSync("openssl", ["req", "-x509", "-newkey", "rsa:2048", "-nodes", "-keyout", "key.pem", "-out", "cert.pem", "-days", "1", "-subj", "/CN=localhost"], {
    cwd: folder,
    stdio: "ignore",
  });
  const user = (...who) => execFileSync(ground, ["password", ...who], { input: `word of ${who[0]}\n` });
  writeFileSync(join(folder, "passwords"), Buffer.concat([user("ada"), user("bob", "--observer")]), { mode: 0o600 });
  port = await free_port();
  const network = await free_port();
  writeFileSync(
    join(folder, "ground.yaml"),
    `version: 1
origin: {latitude_deg: 47, longitude_deg: 8}
vehicles: [1, 2]
console: {port: ${port}, passwords: passwords, certificate: cert.pem, key: key.pem}
control_socket: skein-console-test-${port}
network: {port: ${network}}
time: {epoch_unix_ns: ${BigInt(Date.now()) * 1000000n}}
recording_folder: recording
`,
  );
  await start();
  view = await browse(`https://127.0.0.1:${port}/`);
});
after(async () => {
  await view?.browser.close();
  await stop();
});

async function log_in(user, password) {
  await until("the login", () => view.part("login").isVisible());
  await view.part("login-user").fill(user);
  await view.part("login-password").fill(password);
  await view.part("login-submit").click();
}

test("a wrong password is refused, and said to be", async () => {
  await log_in("ada", "word of bob");
  await until("the refusal", async () => (await view.part("login-trouble").innerText()) !== "");
  await view.picture("login");
});

test("an observer sees everything and orders nothing", async () => {
  await log_in("bob", "word of bob");
  await until("the fleet", async () => (await view.part("count-heard").innerText()).includes("0/2"));
  assert.equal(await view.part("banner-observer").isVisible(), true);
  assert.equal(await view.part("hold-all").count(), 0);
  const refused = await say(view.page, { line: "hold all" });
  assert.equal(refused.done, false);
  assert.match(refused.text, /observer/);
  assert.equal((await say(view.page, { line: "status" })).done, true);
  assert.equal((await say(view.page, { line: "preview form /dev/stdin.yaml" })).done, false);
  await view.part("log-out").click();
});

test("an operator does, in the open page also after the ground station has started anew", async () => {
  await log_in("ada", "word of ada");
  await until("the button", () => view.part("hold-all").isVisible());
  await stop();
  await until("the banner", () => view.part("banner-ended").isVisible());
  await start();
  // Sessions ended with the process.
  await log_in("ada", "word of ada");
  await until("the connection", async () => (await view.part("link-state").innerText()).includes("connected"));
  await view.part("hold-all").click();
  const told = () => execFileSync(ground, ["tell", "--config", "ground.yaml", "--json", "audit"], { cwd: folder });
  await until("the order", () => JSON.parse(told()).data.some(({ who, line, done }) => who === "ada" && line === "hold all" && done));
});

test("nothing was asked of anybody else", () => assert.deepEqual(view.foreign, []));
