// SPDX-License-Identifier: Apache-2.0
// A mission on the bench with its console.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { once } from "node:events";
import { readFile } from "node:fs/promises";
import { createServer } from "node:net";
import { join } from "node:path";

export const programs = process.env.SKEIN_PROGRAMS;
export const scenarios = process.env.SKEIN_SCENARIOS;
export const work = process.env.SKEIN_WORK;
assert(programs && scenarios && work, "run by run.sh");

/** A port of loopback that nobody has. */
export async function free_port() {
  const server = createServer().listen(0, "127.0.0.1");
  await once(server, "listening");
  const { port } = server.address();
  server.close();
  await once(server, "close");
  return port;
}

export async function until(what, condition, patience_ms = 60_000) {
  const end = Date.now() + patience_ms;
  while (Date.now() < end) {
    const value = await condition();
    if (value) return value;
    await new Promise((resolve) => setTimeout(resolve, 100));
  }
  assert.fail(`waited ${patience_ms / 1000} s for ${what}`);
}

/** Flies a scenario with nobody at the prompt: whoever is at the console decides. */
export async function fly(scenario, name, more = []) {
  const port = await free_port();
  const folder = join(work, name);
  const child = spawn(
    join(programs, "skein-hil"),
    ["run", join(scenarios, scenario), "--headless", "--prompt", "--console", String(port), "--out", folder, ...more],
    { stdio: ["ignore", "pipe", "pipe"] },
  );
  let text = "";
  child.stdout.on("data", (data) => (text += data));
  child.stderr.on("data", (data) => (text += data));
  const exited = once(child, "exit").then(([status]) => status);
  let running = true;
  void exited.then(() => (running = false));
  let url;
  await until(`the console\n${text}`, async () => {
    assert(running, `the bench has ended:\n${text}`);
    url = /^console: (\S+)$/m.exec(text)?.[1];
    return url && fetch(url).then((answer) => answer.ok, () => false);
  });
  return {
    url,
    /** For programs that keep no cookies. */
    socket: url.replace("http", "ws").replace("#", "?token="),
    folder,
    port,
    /** Its exit status, when the mission is over. */
    ended: () => exited,
    text: () => text,
    /** Ends it, whatever it does. */
    stop: async () => {
      if (running) child.kill("SIGTERM");
      await exited;
    },
    audit: async () => (await readFile(join(folder, "ground", "audit.jsonl"), "utf8")).split("\n").filter(Boolean).map((line) => JSON.parse(line)),
  };
}
