// SPDX-License-Identifier: Apache-2.0
// Everybody is ordered home: seen first on the map with times and separation, then given and flown.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";

import { fly, until } from "./bench.mjs";
import { barriers, browse, hold, say } from "./browser.mjs";

let mission;
let view;
before(async () => {
  mission = await fly("coalition-6.yaml", "return");
  view = await browse(mission.url);
});
after(async () => {
  await view?.browser.close();
  await mission?.stop();
});

/** How much of the map has the colour of previews. */
const previewed_pixels = () =>
  view.page.evaluate(() => {
    const probe = document.createElement("canvas").getContext("2d", { willReadFrequently: true });
    probe.fillStyle = getComputedStyle(document.documentElement).getPropertyValue("--canvas-preview").trim();
    probe.fillRect(0, 0, 1, 1);
    const wanted = probe.getImageData(0, 0, 1, 1).data;
    let count = 0;
    for (const canvas of document.querySelectorAll(".map-canvas")) {
      const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
      for (let i = 0; i < data.length; i += 4) {
        if (data[i + 3] > 200 && Math.abs(data[i] - wanted[0]) + Math.abs(data[i + 1] - wanted[1]) + Math.abs(data[i + 2] - wanted[2]) < 12) ++count;
      }
    }
    return count;
  });

test("the ways are shown before anything is ordered", async () => {
  await until("six vehicles", async () => (await view.part("count-heard").innerText()).includes("6/6"));
  await view.part("tab-orders").click();
  const before_it = await previewed_pixels();
  await until("ways of all", async () => {
    await view.part("return-preview").click();
    await until("an answer", async () => (await view.part("return-outcome").isVisible()) || (await view.part("return-refused").isVisible()));
    return (await view.page.locator('[data-testid^="return-way-"]').count()) === 6;
  });
  const outcome = await view.part("return-outcome").innerText();
  assert.match(outcome, /^6 come home, the last in (\d+ s|\d+ min)/);
  const separation = /least separation ([\d.]+) (k?m)/.exec(outcome);
  assert.ok(separation && (separation[2] === "km" || Number(separation[1]) >= 9), outcome);
  await until("the ways on the map", async () => (await previewed_pixels()) > before_it + 500);
  assert.deepEqual(await barriers(view.page), []);
  await view.picture("return-preview");
  assert.deepEqual((await mission.audit()).filter(({ line }) => line.startsWith("return")), [], "nobody was ordered anywhere");
  // They fly on: what is shown is planned again from where they are.
  const times = () => view.page.locator('[data-testid^="return-way-"]').allInnerTexts().then((all) => all.join());
  const first = await times();
  await until("newer ways", async () => (await times()) !== first);
});

test("one who is not there has no way, and it is said why", async () => {
  await view.part("return-some").fill("2, 77");
  await until("the refusal of the other", async () => {
    await view.part("return-preview").click();
    return (await view.part("return-cannot").isVisible()) && (await view.part("return-cannot").innerText()).includes("Vehicle 77 has no planned way: it is not in the fleet");
  });
  assert.equal(await view.page.locator('[data-testid^="return-way-"]').count(), 1);
  await view.part("return-some").fill("");
});

test("a short press gives nothing, a long one sends all home together", async () => {
  await until("ways of all", async () => {
    await view.part("return-preview").click();
    return (await view.page.locator('[data-testid^="return-way-"]').count()) === 6;
  });
  await hold(view.part("return-give"), 300);
  assert.equal((await mission.audit()).some(({ line }) => line === "return all"), false);
  await hold(view.part("return-give"));
  await until("the order", async () => (await mission.audit()).some(({ line, done, from }) => line === "return all" && done && from === "console"));
  assert.equal(await view.part("return-outcome").count(), 0, "what was looked at is put away");
  await view.part("tab-log").click();
  await until("ways that are planned together", async () => /6 vehicles come home on ways clear of each other, the last in \d+ s/.test(await view.page.locator('[data-testid^="event-"]').allInnerTexts().then((all) => all.join("\n"))));
});

test("nothing was asked of anybody else, and nothing was complained about", () => {
  assert.deepEqual(view.foreign, []);
  assert.deepEqual(view.complaints, []);
});
