// SPDX-License-Identifier: Apache-2.0
// A mission's report in a browser: figures under the pointer, legends, and from a check to its
// moment in the replay.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { once } from "node:events";
import { createServer } from "node:net";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";

import { fly, programs, until } from "./bench.mjs";
import { barriers, browse } from "./browser.mjs";

/** Where a report leads. */
const replay_port = 7460;

let mission;
let player;
let view;
before(async () => {
  // Nobody decides: what is not done is told by a check that does not hold.
  mission = await fly("coalition-6.yaml", "report", ["--rate", "3"]);
  await mission.ended();
  view = await browse(pathToFileURL(join(mission.folder, "report.html")).href, { viewport: { width: 1280, height: 900 } });
  await view.page.context().grantPermissions(["clipboard-read", "clipboard-write"]).catch(() => {});
});
after(async () => {
  await view?.browser.close();
  player?.kill("SIGTERM");
  await mission?.stop();
});

/** The place on the screen of a line's point, counted from its begin as a share. */
const place_on = (line, share) =>
  line.evaluate((element, at) => {
    const points = element.getAttribute("points").split(" ").map((pair) => pair.split(",").map(Number));
    const [x, y] = points[Math.floor(at * (points.length - 1))];
    const svg = element.ownerSVGElement;
    const place = new DOMPoint(x, y).matrixTransform(svg.getScreenCTM());
    const [from, to, pixel_from, pixel_to] = (svg.dataset.value ?? "").split(" ").map(Number);
    return { x: place.x, y: place.y, value: from + ((y - pixel_from) / (pixel_to - pixel_from)) * (to - from) };
  }, share);

test("a plot tells time, vehicle and figure under the pointer", async () => {
  const curve = view.page.locator("svg[data-value] polyline[data-series]").first();
  await curve.scrollIntoViewIfNeeded();
  const place = await place_on(curve, 0.5);
  await view.page.mouse.move(place.x, place.y);
  const tip = await view.page.locator("#tip").innerText();
  const found = /^([\d.]+) s · (vehicle \d+), (?:delivers|assesses) · ([\d.]+) m$/.exec(tip);
  assert.ok(found, tip);
  assert.equal(found[2], await curve.getAttribute("data-series"));
  // A pixel of the chart is a few metres.
  assert.ok(Math.abs(Number(found[3]) - place.value) < 25, `${tip}, the line is at ${place.value} m`);
  await view.picture("report-hover");
});

test("a track tells when it was where it is pointed at", async () => {
  const track = view.page.locator("polyline.track[data-times]").last();
  await track.scrollIntoViewIfNeeded();
  const place = await place_on(track, 0.5);
  await view.page.mouse.move(place.x, place.y);
  assert.match(await view.page.locator("#tip").innerText(), /^[\d.]+ s · vehicle \d+.* · E -?\d+ N -?\d+ m$/);
  await view.page.mouse.move(2, 2);
  assert.equal(await view.page.locator("#tip").isVisible(), false);
});

test("a legend hides what it names, and shows it again", async () => {
  const figure = view.page.locator("figure.plot").first();
  const key = figure.locator(".legend button", { hasText: /^vehicle 2$/ });
  const shown = () => figure.locator('[data-series$="vehicle 2"]:visible').count();
  assert.ok((await shown()) > 0);
  await key.click();
  assert.equal(await key.getAttribute("aria-pressed"), "false");
  assert.equal(await shown(), 0);
  await key.press("Enter");
  assert.ok((await shown()) > 0);
  await figure.locator(".legend button", { hasText: /^none$/ }).click();
  assert.equal(await figure.locator("[data-series]:visible").count(), 0);
  await figure.locator(".legend button", { hasText: /^all$/ }).click();
});

test("there is no barrier, day or night", async () => {
  assert.deepEqual(await barriers(view.page), []);
  await view.page.emulateMedia({ colorScheme: "dark" });
  assert.deepEqual(await barriers(view.page), []);
  await view.page.emulateMedia({ colorScheme: null });
});

test("every check has a link to its moment, which copies what opens it", async () => {
  const rows = view.page.locator("table:has(th:text-is('check')) tbody > tr:not(.sentences)");
  assert.ok((await rows.count()) > 10);
  for (const row of await rows.all()) assert.equal(await row.locator("a.moment").count(), 1, await row.innerText());
  const link = rows.filter({ hasText: "separation" }).locator("a.moment");
  const moment = /#seek=([\d.]+)/.exec(await link.getAttribute("href"))[1];
  // Nobody listens there: a browser says so, and the report stays.
  await view.page.evaluate(() => document.addEventListener("click", (event) => event.preventDefault(), { capture: true, once: true }));
  await link.click();
  await until("the command line", () => view.page.locator("#said").isVisible());
  const said = await view.page.locator("#said").innerText();
  assert.ok(said.startsWith("Copied: ") && said.endsWith(` replay ${mission.folder} --at ${moment}`), said);
});

/** A port that others of this machine may have for a while. */
async function wait_for_port(port) {
  await until(`port ${port}`, async () => {
    const server = createServer();
    const free = await new Promise((resolve) => {
      server.once("error", () => resolve(false));
      server.listen(port, "127.0.0.1", () => resolve(true));
    });
    if (!free) return false;
    server.close();
    await once(server, "close");
    return true;
  });
}

test("followed where the replay runs, a link shows that moment", async () => {
  await wait_for_port(replay_port);
  player = spawn(join(programs, "skein-ground"), ["replay", mission.folder, "--at", "5"], { stdio: ["pipe", "pipe", "pipe"] });
  let text = "";
  player.stdout.on("data", (data) => (text += data));
  player.stderr.on("data", (data) => (text += data));
  await until("the console of the replay", () => text.includes("console: http"), 30_000);
  assert.ok(text.includes(`console: http://127.0.0.1:${replay_port}/`), text);

  const links = view.page.locator("tr:not(.sentences) a.moment");
  const hrefs = await links.evaluateAll((all) => all.map((link) => link.getAttribute("href")));
  const moment_of = (href) => Number(/#seek=(-?[\d.]+)/.exec(href)[1]);
  const late = hrefs.findIndex((href) => moment_of(href) > 20);
  const other = hrefs.findIndex((href) => Math.abs(moment_of(href) - moment_of(hrefs[late])) > 5);
  assert.ok(late >= 0 && other >= 0, hrefs.join("\n"));
  const opened = view.page.context().waitForEvent("page");
  await links.nth(late).click();
  let replay = await opened;
  const seconds = async () => {
    const [, minutes, rest] = /(\d+):(\d+(?:\.\d+)?)/.exec(await replay.getByTestId("replay-time").innerText());
    return 60 * Number(minutes) + Number(rest);
  };
  const shows = (moment) =>
    until(`second ${moment}`, async () => (await replay.getByTestId("replay-time").count()) > 0 && Math.abs((await seconds()) - moment) <= 1);
  await shows(moment_of(hrefs[late]));
  await until("a replay that waits there", async () => (await replay.getByTestId("replay-play").innerText()) === "Play");
  const again = view.page.context().waitForEvent("page");
  await links.nth(other).click();
  replay = await again;
  await shows(moment_of(hrefs[other]));
  // A page that is open goes where its address is changed to.
  await replay.evaluate((to) => (location.hash = to), `seek=${moment_of(hrefs[late])}`);
  await shows(moment_of(hrefs[late]));

  // Of another run it is not shown as if it were this one's.
  await replay.evaluate(() => (location.hash = "seek=1&of=another"));
  await until("the note", async () => (await replay.locator("body").innerText()).includes("that link is of another"));
  await shows(moment_of(hrefs[late]));
});

test("the report asked nobody for anything, and nothing was complained about", () => {
  assert.deepEqual(view.foreign, []);
  assert.deepEqual(view.complaints, []);
});
