// SPDX-License-Identifier: Apache-2.0
// A formation commanded from the page, and everybody held in one action.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";

import { fly, until } from "./bench.mjs";
import { browse, hold } from "./browser.mjs";

let mission;
let view;
before(async () => {
  mission = await fly("formation-5.yaml", "orders");
  view = await browse(mission.url);
});
after(async () => {
  await view?.browser.close();
  await mission?.stop();
});

const places = () => view.page.locator('[data-testid^="place-"]');

/** Gives an order as an operator does: tried first, then held. */
async function order(kind, fields = {}) {
  await view.part(`formation-kind-${kind}`).check();
  for (const [name, value] of Object.entries(fields)) {
    if (name === "shape") await view.part("formation-shape").selectOption(value);
    else await view.part(`formation-${name}`).fill(value);
  }
  await view.part("formation-preview").click();
  await until(`the preview of ${kind}`, () => view.part("preview-outcome").isVisible());
  await view.picture(`preview-${kind}`);
  await hold(view.part("formation-give"));
}

async function all_at_rest() {
  const states = await places().allInnerTexts();
  return states.length === 5 && states.every((text) => text.includes("at rest")) && !(await view.part("formation").innerText()).includes("is being flown");
}

test("a shape is previewed, given, acknowledged by each vehicle and flown", async () => {
  await until("five vehicles", async () => (await view.part("count-heard").innerText()).includes("5/5"));
  await view.part("tab-orders").click();
  await until("the mission's begin", async () => !(await view.part("mission-time").innerText()).startsWith("−") && !(await view.part("mission-time").innerText()).startsWith("-"));
  await order("take_off");
  await until("all in the air", all_at_rest);
  await order("form", { shape: "wedge", spacing: "5" });
  await until("five acknowledgements", async () => (await view.page.locator('[data-testid^="place-"][data-taken="true"]').count()) === 5);
  await view.picture("formation");
});

test("hold all is one press, and a key", async () => {
  await view.part("hold-all").click();
  await until("the order", async () => (await mission.audit()).some(({ line, done }) => line === "hold all" && done));
  await view.page.keyboard.press("F9");
  await until("the second", async () => (await mission.audit()).filter(({ line, done }) => line === "hold all" && done).length === 2);
});

test("an order that cannot be is refused with its reason", async () => {
  await view.part("formation-kind-form").check();
  for (const [name, value] of [["east", "0"], ["north", "0"], ["height", "5000"]]) await view.part(`formation-${name}`).fill(value);
  await view.part("formation-preview").click();
  await until("the refusal", () => view.part("preview-refused").isVisible());
  assert.match(await view.part("preview-refused").innerText(), /\w{4}/);
  assert.equal(await view.part("formation-give").isDisabled(), true);
});

test("nothing was asked of anybody else, and nothing was complained about", () => {
  assert.deepEqual(view.foreign, []);
  assert.deepEqual(view.complaints, []);
});
