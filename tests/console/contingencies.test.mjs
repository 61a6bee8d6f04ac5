// SPDX-License-Identifier: Apache-2.0
// One operator, 50 vehicles, ten things that happen in one moment: each is acted on in at most three
// gestures and ten seconds, by the keyboard alone, and by the mouse alone.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { once } from "node:events";
import { join } from "node:path";
import { after, test } from "node:test";

import { programs, until } from "./bench.mjs";
import { browse } from "./browser.mjs";

const vehicles = 50;
/** What happens, and the order that is to come of it; none: it is looked at, and acknowledged. */
const wanted = {
  "separation_no_room-14-15": /"command":"hold".*"vehicle":14/,
  "traffic_no_room-18-4b1a2c": /"command":"hold".*"vehicle":18/,
  "left_fence-11": /"command":"resume".*"vehicle":11/,
  "vehicle_silent-3": null,
  "decision_lapsed-site-1": /"kind":"decision".*"site":1/,
  "range_reserve-7": /"command":"return_home".*"vehicle":7/,
  "autopilot_trouble-22": /"command":"give_back".*"vehicle":22/,
  "vehicle_trouble-26-3": /"command":"resume".*"vehicle":26/,
  "task_unknown-41-site-2-100": null,
  "duplicate_id-30": null,
};

/** All that have been begun: one that fails leaves none behind. */
const begun = [];
after(async () => {
  for (const end of begun) await end();
});

async function begin() {
  const station = spawn(join(programs, "console_contingencies"), [String(vehicles)], { stdio: ["pipe", "pipe", "inherit"] });
  let text = "";
  station.stdout.on("data", (data) => (text += data));
  let browser;
  begun.push(async () => {
    await browser?.close();
    station.stdin.end();
    if (station.exitCode === null) await once(station, "exit");
  });
  const url = await until("the console", () => /^(http:\S+)/.exec(text)?.[1]);
  const view = await browse(url);
  browser = view.browser;
  await until("the fleet", async () => (await view.part("count-heard").innerText()).includes(`${vehicles}/${vehicles}`));
  await until("a quiet fleet", async () => /No alarms/.test(await view.part("alarm-counts").innerText()));
  station.stdin.write("now\n");
  const keys = () => view.page.locator("[data-testid^=alarm-][data-number].open").evaluateAll((rows) => rows.map((row) => row.dataset.testid.slice("alarm-".length)));
  await view.part("alarm-counts").click();
  await until("all ten", async () => (await keys()).filter((key) => key in wanted).length === 10, 20_000);
  return { view, said: () => text };
}

/** The one in the bar, which keys and presses are about; the list may have another on top. */
const worst_of = (view) =>
  view.page.evaluate(() => {
    const number = document.querySelector('[data-testid="alarm-bar"] [data-testid^="alarm-acknowledge-"]')?.dataset.testid.slice("alarm-acknowledge-".length);
    return document.querySelector(`.alarm-row.open[data-number="${number}"]`)?.dataset.testid.slice("alarm-".length) ?? null;
  });
const number_of = (view, key) => view.part(`alarm-${key}`).getAttribute("data-number");

/** Keeps count of what the hands do. */
function hands(view) {
  let gestures = 0;
  const counted = (what) => async (...of) => {
    gestures++;
    await what(...of);
  };
  return {
    count: () => gestures,
    key: counted((name) => view.page.keyboard.press(name)),
    keep_key: counted(async (name) => {
      await view.page.keyboard.down(name);
      await view.page.waitForTimeout(1200);
      await view.page.keyboard.up(name);
    }),
    click: counted((button) => button.click()),
    keep: counted(async (button) => {
      await button.hover();
      await view.page.mouse.down();
      await view.page.waitForTimeout(1200);
      await view.page.mouse.up();
    }),
  };
}

async function by_keyboard(view, key, order, hand) {
  await hand.key("j");
  if (order) {
    const of = key.startsWith("decision") ? "authorise-" : "alarm-offer-";
    await until("the hand at the button", () => view.page.evaluate((id) => document.activeElement?.dataset.testid?.startsWith(id) ?? false, of));
    if (/hold/.test(String(order))) await hand.key("Enter");
    else await hand.keep_key("Enter");
  }
  await hand.key("k");
}

async function by_mouse(view, key, order, hand) {
  const number = await number_of(view, key);
  await hand.click(view.part("alarm-worst"));
  if (order) {
    const button = key.startsWith("decision") ? view.part("authorise-1") : view.part(`alarm-offer-${number}-0`);
    if (/hold/.test(String(order))) await hand.click(button);
    else await hand.keep(button);
  }
  await hand.click(view.part(`alarm-acknowledge-${number}`));
}

for (const [name, act] of [["keyboard", by_keyboard], ["mouse", by_mouse]]) {
  test(`ten contingencies among ${vehicles} vehicles, by ${name}`, async () => {
    const { view, said } = await begin();
    const since = Date.now();
    const figures = [];
    const done = new Set();
    while (done.size < 10) {
      const key = await until("the next", () => worst_of(view));
      const at = Date.now();
      const hand = hands(view);
      const order = wanted[key] ?? null;
      const before = said().length;
      await act(view, key, order, hand);
      await until(`${key} acted on`, () => {
        const news = said().slice(before);
        return news.includes(`acknowledged ${key}`) && (!order || order.test(news));
      });
      await until(`${key} out of the way`, async () => (await worst_of(view)) !== key);
      const took_s = (Date.now() - at) / 1000;
      if (key in wanted) {
        done.add(key);
        figures.push({ key, gestures: hand.count(), took_s });
        assert.ok(hand.count() <= 3, `${key}: ${hand.count()} gestures`);
        assert.ok(took_s <= 10, `${key}: ${took_s} s`);
      }
    }
    for (const { key, gestures, took_s } of figures) console.log(`${name}: ${key}: ${gestures} gestures, ${took_s.toFixed(1)} s`);
    console.log(`${name}: all ten in ${((Date.now() - since) / 1000).toFixed(1)} s`);
    assert.deepEqual(view.complaints, []);
    await view.picture(`contingencies-${name}`);
  });
}
