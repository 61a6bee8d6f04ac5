// SPDX-License-Identifier: Apache-2.0
// Debian's chromium on a page of ours.
import { mkdir, readFile } from "node:fs/promises";
import { createRequire } from "node:module";
import { join } from "node:path";

import { chromium } from "playwright-core";

/** SKEIN_JS_FLAGS is what V8 is told. Without a graphics processor every frame of a moving map costs: `reducedMotion`
 * leaves out those between states. A page that notes what it asks of others and what it complains about. */
export async function browse(url, options = {}) {
  const browser = await chromium.launch({
    executablePath: process.env.SKEIN_CHROMIUM ?? "/usr/bin/chromium",
    args: [
      "--headless",
      "--no-sandbox",
      "--disable-gpu",
      "--disable-quic",
      "--no-first-run",
      "--disable-background-networking",
      "--disable-component-update",
      "--disable-sync",
      ...(process.env.SKEIN_JS_FLAGS ? [`--js-flags=${process.env.SKEIN_JS_FLAGS}`] : []),
    ],
  });
  const page = await browser.newPage({ viewport: { width: 1280, height: 720 }, ignoreHTTPSErrors: true, reducedMotion: "reduce", ...options });
  const foreign = [];
  const complaints = [];
  page.on("request", (request) => {
    const asked = new URL(request.url());
    if (asked.host !== new URL(url).host && asked.protocol !== "data:" && asked.protocol !== "blob:") foreign.push(request.url());
  });
  page.on("pageerror", (error) => complaints.push(error.message));
  page.on("console", (message) => {
    if (message.type() === "error" && !/401|CONNECTION_REFUSED/.test(message.text())) complaints.push(message.text());
  });
  await page.goto(url);
  return {
    browser,
    page,
    foreign,
    complaints,
    part: (id) => page.getByTestId(id),
    async picture(name) {
      const folder = join(process.env.SKEIN_WORK ?? ".", "screenshots");
      await mkdir(folder, { recursive: true });
      await page.screenshot({ path: join(folder, `${name}.png`) });
    },
  };
}

const axe = createRequire(import.meta.url).resolve("axe-core/axe.min.js");

/** Findings of axe-core that keep people from using the page. */
export async function barriers(page) {
  await page.evaluate(await readFile(axe, "utf8"));
  const { violations } = await page.evaluate(() => globalThis.axe.run());
  return violations
    .filter(({ impact }) => impact === "serious" || impact === "critical")
    .map(({ id, nodes }) => `${id}: ${nodes.map((node) => node.html.slice(0, 120)).join(" ")}`);
}

/** Whatever axe-core finds; `rules`: of these alone. */
export async function findings(page, rules = null) {
  if (!(await page.evaluate(() => "axe" in globalThis))) await page.evaluate(await readFile(axe, "utf8"));
  const violations = await page.evaluate(
    async (only) => (await globalThis.axe.run(document, { resultTypes: ["violations"], ...(only ? { runOnly: { type: "rule", values: only } } : {}) })).violations.map(({ id, nodes }) => ({ id, nodes: nodes.map((node) => node.html.slice(0, 120)) })),
    rules,
  );
  return violations.map(({ id, nodes }) => `${id}: ${nodes.join(" ")}`);
}

/** Presses a button for as long as it wants. */
export async function hold(button, ms = 1300) {
  await button.hover();
  const page = button.page();
  await page.mouse.down();
  await page.waitForTimeout(ms);
  await page.mouse.up();
}

/** What comes of a line over the page's own socket, past its buttons. */
export function say(page, text) {
  return page.evaluate(
    (line) =>
      new Promise((resolve) => {
        const socket = new WebSocket(`${location.origin.replace("http", "ws")}/socket`, "skein.console.1");
        socket.onopen = () => socket.send(JSON.stringify({ type: "line", id: 1, ...line }));
        socket.onmessage = ({ data }) => {
          const message = JSON.parse(data);
          if (message.type !== "answer") return;
          socket.close();
          resolve(message);
        };
        socket.onclose = () => resolve(null);
      }),
    text,
  );
}
