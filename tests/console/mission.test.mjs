// SPDX-License-Identifier: Apache-2.0
// The small mission: watched, authorised and finished from the page.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";

import { fly, until } from "./bench.mjs";
import { barriers, browse, hold, say } from "./browser.mjs";

let mission;
let view;
before(async () => {
  mission = await fly("coalition-6.yaml", "mission");
  view = await browse(mission.url);
});
after(async () => {
  await view?.browser.close();
  await mission?.stop();
});

const event_numbers = () =>
  view.page.locator('[data-testid^="event-"]').evaluateAll((rows) => rows.map((row) => Number(row.dataset.testid.slice("event-".length))));

test("the fleet is there, well, and accounted for", async () => {
  await until("six vehicles", async () => (await view.part("count-heard").innerText()).includes("6/6"));
  await view.part("tab-fleet").click();
  await until("six rows", async () => (await view.part("fleet").locator("tbody tr").count()) === 6);
  await view.picture("fleet");
});

test("an observer's eyes: no serious barrier in any panel", async () => {
  for (const panel of ["fleet", "mission", "orders", "log", "plots", "preflight", "links"]) {
    await view.part(`tab-${panel}`).click();
    assert.deepEqual(await barriers(view.page), [], panel);
  }
  await view.part("theme").click();
  assert.deepEqual(await barriers(view.page), [], "the other theme");
  await view.picture("night");
  await view.part("theme").click();
});

test("a delivery is authorised by a long press, and not by a short one", async () => {
  await until("a request", () => view.part("request-1").first().isVisible());
  await view.picture("request");
  await hold(view.part("authorise-1").first(), 300);
  // A decision on another plan than the one that waits; and by its answer all before it is told.
  const other = await say(view.page, {
    type: "order",
    order: { kind: "decision", site: 1, grant: true, coalition: "9-0000000000000001-1", round: 1 },
  });
  assert.equal(other.done, false);
  assert.match(other.text, /does not wait/);
  assert.deepEqual(
    (await mission.audit()).filter(({ line }) => line.startsWith("authorise")).map(({ done }) => done),
    [false],
  );
  // The deadline may pass while we look; then the coalition asks again.
  await until("a decision", async () => {
    const button = view.part("authorise-1").first();
    if (await button.isVisible()) await hold(button).catch(() => {});
    return (await mission.audit()).some(({ line, done, from }) => line === "authorise 1" && done && from === "console");
  });
});

test("a reload in mid-mission loses nothing", async () => {
  await view.part("tab-log").click();
  await until("events", async () => (await event_numbers()).length > 5);
  const seen = await event_numbers();
  await view.page.reload();
  await until("the connection", async () => (await view.part("link-state").innerText()).includes("connected"));
  await view.part("tab-log").click();
  await until("the events of before", async () => {
    const now = await event_numbers();
    return seen.every((number) => now.includes(number));
  });
  const numbers = (await event_numbers()).sort((a, b) => a - b);
  assert.equal(new Set(numbers).size, numbers.length, "none is doubled");
  assert.equal(numbers.at(-1) - numbers[0] + 1, numbers.length, "none is missing");
});

test("the mission is done, and every check held", async () => {
  await view.part("tab-mission").click();
  await until("the site's end", async () => /done/.test(await view.part("site-1").innerText().catch(() => "")), 120_000);
  await view.picture("done");
  assert.equal(await mission.ended(), 0, mission.text());
  await until("what came of it", async () => /1 of 1 sites done, 3 of 3 deliveries/.test(await view.part("banner-ended").innerText().catch(() => "")));
  assert.equal(await view.part("banner-lost").count(), 0);
});

test("nothing was asked of anybody else, and nothing was complained about", () => {
  assert.deepEqual(view.foreign, []);
  assert.deepEqual(view.complaints, []);
});
