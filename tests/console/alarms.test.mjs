// SPDX-License-Identifier: Apache-2.0
// What may not be quiet is not: a vehicle that falls silent in a mission is seen, heard, acknowledged by
// one for all, and over when it is heard again.
import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { after, before, test } from "node:test";

import { fly, until } from "./bench.mjs";
import { barriers, browse, hold } from "./browser.mjs";

let mission;
let view;
let other;
before(async () => {
  mission = await fly("coalition-6.yaml", "alarms");
  view = await browse(mission.url);
  other = await browse(mission.url);
  await until("six vehicles", async () => (await view.part("count-heard").innerText()).includes("6/6"));
});
after(async () => {
  resume_all();
  await view?.browser.close();
  await other?.browser.close();
  await mission?.stop();
});

/** The process of a program of this mission's, of vehicle `id` where that is given. */
function process_of(program, id) {
  for (const pid of readdirSync("/proc").filter((name) => /^\d+$/.test(name))) {
    let words;
    try {
      words = readFileSync(`/proc/${pid}/cmdline`, "utf8").split("\0");
    } catch {
      continue; // it has ended meanwhile
    }
    const of_id = id === undefined || words.some((word) => word.startsWith(mission.folder) && new RegExp(`\\b0*${id}\\b`).test(word.slice(mission.folder.length)));
    if (words[0].endsWith(`/${program}`) && words.some((word) => word.startsWith(mission.folder)) && of_id) return Number(pid);
  }
  return assert.fail(`no ${program} ${id ?? ""} of this mission`);
}

const stopped = new Set();
function stop(pid) {
  process.kill(pid, "SIGSTOP");
  stopped.add(pid);
}
function resume(pid) {
  if (stopped.delete(pid)) process.kill(pid, "SIGCONT");
}
function resume_all() {
  for (const pid of [...stopped]) resume(pid);
}

const sounding = () => view.page.evaluate(() => document.documentElement.dataset.sounding);
const bursts = async () => Number(await view.page.evaluate(() => document.documentElement.dataset.bursts));
const open_list = async (of) => {
  if ((await of.part("alarm-counts").getAttribute("aria-expanded")) !== "true") await of.part("alarm-counts").click();
};
let vehicle;

test("a page that may not be heard yet says so, with a button", async () => {
  await until("the button", () => view.part("sound-on").isVisible());
  assert.equal(await sounding(), "nothing");
  await view.part("sound-on").click();
  await until("that it may be heard", async () => (await view.part("sound-on").count()) === 0);
  await until("the volume", () => view.part("volume").isVisible());
});

test("a vehicle that falls silent is seen, heard and said", async () => {
  await open_list(view);
  await open_list(other);
  vehicle = process_of("skein-onboard", 6);
  stop(vehicle);
  await until("the alarm", () => view.part("alarm-vehicle_silent-6").isVisible());
  assert.match(await view.part("alarm-vehicle_silent-6").innerText(), /vehicle 6 is silent: heard last at .*look for it/s);
  await until("its sound", async () => (await sounding()) === "alarm");
  const before = await bursts();
  await until("its sound again", async () => (await bursts()) > before + 1);
  assert.match(await view.page.title(), /^!! \d+ alarms? .*Skein$/);
  await until("that it is said", async () => /vehicle 6 is silent/.test(await view.part("spoken-alarms").innerText()));
  await until("the other page", () => other.part("alarm-vehicle_silent-6").isVisible());
  await view.picture("alarms");
});

test("a press on it shows the vehicle, and where one acts", async () => {
  await view.part("tab-log").click();
  const number = await view.part("alarm-vehicle_silent-6").getAttribute("data-number");
  await view.part(`alarm-go-${number}`).click();
  await until("the fleet", async () => (await view.part("tab-fleet").getAttribute("aria-selected")) === "true");
  await until("the vehicle", () => view.page.evaluate(() => document.querySelector('[data-testid="vehicle-6"]')?.matches('[aria-selected="true"], .selected, [data-selected="true"]') ?? false));
});

test("one acknowledges it for all, and it stays", async () => {
  const of = async (page) => page.part("alarm-vehicle_silent-6").innerText();
  const number = await view.part("alarm-vehicle_silent-6").getAttribute("data-number");
  const button = view.part(`alarm-acknowledge-${number}`).first();
  assert.ok((await button.boundingBox()).height >= 44);
  await button.click();
  await until("here", async () => /acknowledged by/.test(await of(view)));
  await until("there", async () => /acknowledged by/.test(await of(other)));
  await until("the audit", async () => (await mission.audit()).some(({ line, done, from }) => line === `acknowledge ${number}` && done && from === "console"));
  // Nobody decides in this mission: what else asks for the operator is acknowledged as well.
  await until("silence", async () => {
    if (await view.part("alarm-acknowledge-all").isVisible()) await view.part("alarm-acknowledge-all").click();
    else if (await view.page.locator(".alarms .acknowledge").first().isVisible()) await view.page.locator(".alarms .acknowledge").first().click();
    return (await sounding()) === "nothing";
  });
  assert.ok(await view.part("alarm-vehicle_silent-6").isVisible());
});

test("it is over when the vehicle is heard again, and was acknowledged: it is gone", async () => {
  resume(vehicle);
  await until("its end", async () => (await view.part("alarm-vehicle_silent-6").count()) === 0);
});

test("what vehicles make of an order is shown with the time that it took, and that all are held stands", async () => {
  await view.part("hold-all").click();
  await until("the answers", async () => /\d of \d obey; the last \(\d\) after \d+\.\d s/.test(await view.part("notices").innerText()));
  console.log((await view.part("notices").innerText()).replace(/\s+/g, " "));
  await until("that all are held", () => view.part("alarm-all_held").isVisible());
  await view.picture("all-held");
  const number = await view.part("alarm-all_held").getAttribute("data-number");
  // What is most urgent may change while one presses: then it is another's button.
  await until("the order", async () => {
    const offer = view.part(`alarm-offer-${number}-0`).last();
    if (await offer.isVisible()) await hold(offer).catch(() => {});
    return (await mission.audit()).some(({ line, done }) => line === "resume all" && done);
  });
  await until("its end", async () => {
    const row = view.part("alarm-all_held");
    return (await row.count()) === 0 || /over at/.test(await row.innerText());
  });
});

test("mute is shown while it lasts, and can be ended", async () => {
  await view.part("mute").click();
  await until("how long", async () => /Muted for (10|9) min/.test(await view.part("unmute").innerText()));
  assert.equal(await sounding(), "nothing");
  await view.page.reload();
  await view.part("sound-on").click();
  await until("it still", () => view.part("unmute").isVisible());
  await view.part("unmute").click();
  await until("the volume", () => view.part("volume").isVisible());
});

test("an observer's eyes: no serious barrier in bar and list, day and night", async () => {
  await open_list(view);
  for (const theme of ["one", "the other"]) {
    assert.deepEqual(await barriers(view.page), [], theme);
    await view.part("theme").click();
  }
});

test("a page without connection alarms about that by itself", async () => {
  process.kill(process_of("skein-ground"), "SIGKILL");
  await until("the alarm", () => view.part("alarm-no_connection").isVisible());
  await until("its sound", async () => (await sounding()) === "alarm");
  await view.part("alarm-acknowledge-0").click();
  await until("silence", async () => (await sounding()) === "nothing");
  assert.ok(await view.part("alarm-no_connection").isVisible());
});

test("nothing was asked of anybody else, and nothing was complained about", () => {
  assert.deepEqual(view.foreign, []);
  assert.deepEqual(view.complaints, []);
});
