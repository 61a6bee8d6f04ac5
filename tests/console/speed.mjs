// SPDX-License-Identifier: Apache-2.0
//
// node speed.mjs CONSOLE_LOAD VEHICLES SECONDS [PACE [PANEL]]: how fast the page is drawn, how old what it
// shows is, and whether its memory grows, with so many vehicles that report ten times a second, for so many
// seconds of their mission, which goes PACE times as fast as the clock: with the messages of an hour in less.
// Memory has V8's machine code in it, some of which an hour in less compiles after its ten minutes; without:
// SKEIN_JS_FLAGS="--no-opt --no-maglev --no-sparkplug".
import { spawn } from "node:child_process";
import { once } from "node:events";
import { createInterface } from "node:readline";

import { browse } from "./browser.mjs";

const [load, vehicles, mission_s] = [process.argv[2], process.argv[3], Number(process.argv[4])];
const pace = Number(process.argv[5] ?? 1);
const seconds = mission_s / pace;
const server = spawn(load, [vehicles, `${pace}`], { stdio: ["pipe", "pipe", "inherit"] });
const [line] = await once(createInterface({ input: server.stdout }), "line");
const [url, epoch_ms] = line.split(" ");

// Before the page's own scripts: notes each state, and when the frame after it has been drawn.
const watch = ([epoch, pace]) => {
  // Counts by milliseconds: a list of all would be the page's growth.
  const watched = { ages: new Uint32Array(10_000), frames: 0, longest: 0 };
  globalThis.watched = watched;
  const note = (age_ms) => ++watched.ages[Math.max(0, Math.min(watched.ages.length - 1, Math.round(age_ms)))];
  const native = globalThis.WebSocket;
  globalThis.WebSocket = class extends native {
    constructor(...all) {
      super(...all);
      this.addEventListener("message", ({ data }) => {
        const first = /"vehicles":\[\{"id":1,.*?"x":(-?[\d.]+)/.exec(data);
        if (!first) return;
        // The first frame draws it; at the begin of the second it is on the screen.
        requestAnimationFrame(() => requestAnimationFrame(() => note(Date.now() - epoch - (Number(first[1]) * 100) / pace)));
      });
    }
  };
  let last = performance.now();
  const frame = (now) => {
    watched.frames += 1;
    watched.longest = Math.max(watched.longest, now - last);
    last = now;
    requestAnimationFrame(frame);
  };
  requestAnimationFrame(frame);
};

const { browser, page } = await browse("about:blank", { reducedMotion: "no-preference" });
await page.addInitScript(watch, [Number(epoch_ms), pace]);
await page.goto(url);
if (process.argv[6]) await page.getByTestId(`tab-${process.argv[6]}`).click();
const cdp = await page.context().newCDPSession(page);
// Processor time of the page's thread, which does not depend on what else the machine does.
await cdp.send("Performance.enable", { timeDomain: "threadTicks" });
const worked_s = async () => (await cdp.send("Performance.getMetrics")).metrics.find(({ name }) => name === "TaskDuration").value;
/** What is in use, MB. A state that comes before it is read has left what nobody uses any more: the least of several. */
const heap = async () => {
  const readings = [];
  while (readings.length < 5) {
    await cdp.send("HeapProfiler.collectGarbage");
    const { metrics } = await cdp.send("Performance.getMetrics");
    readings.push(metrics.find(({ name }) => name === "JSHeapUsedSize").value / 2 ** 20);
  }
  return Math.min(...readings);
};
/** The age that such a share of them does not exceed, ms. */
const quantile = (ages, share) => {
  const all = ages.reduce((sum, count) => sum + count, 0);
  let passed = 0;
  return ages.findIndex((count) => (passed += count) > share * all);
};

// What is kept of ten minutes is full after ten minutes: before, memory has to grow.
const settle = Math.min(seconds / 2, 600 / pace);
await page.waitForTimeout(Math.min(5000, 1000 * settle));
await page.evaluate(() => {
  globalThis.watched.ages.fill(0);
  Object.assign(globalThis.watched, { frames: 0, longest: 0 });
});
const begun = Date.now();
const worked_before = await worked_s();
await page.waitForTimeout(1000 * settle);
const before = await heap();
await page.waitForTimeout(1000 * (seconds - settle));
const worked = (await worked_s()) - worked_before;
const after = await heap();
const spent = (Date.now() - begun) / 1000;
const { ages, frames, longest } = await page.evaluate(() => ({ ...globalThis.watched, ages: [...globalThis.watched.ages] }));
console.log(`${vehicles} vehicles, ${spent.toFixed(0)} s${pace > 1 ? ` at ${pace} times the pace: ${(spent * pace).toFixed(0)} s of the mission` : ""}`);
console.log(`frames a second     ${(frames / spent).toFixed(1)} (longest without one: ${longest.toFixed(0)} ms)`);
console.log(`processor time      ${((1000 * worked) / spent).toFixed(0)} ms a second of the page's thread`);
console.log(`telemetry to pixel  median ${quantile(ages, 0.5).toFixed(0)} ms, 95 % ${quantile(ages, 0.95).toFixed(0)} ms, ${ages.reduce((sum, count) => sum + count, 0)} states`);
console.log(`memory of the page  ${before.toFixed(1)} MB after ${(settle * pace).toFixed(0)} s, ${after.toFixed(1)} MB at the end (${((after / before - 1) * 100).toFixed(1)} %)`);
await browser.close();
server.stdin.end();
await once(server, "exit");
