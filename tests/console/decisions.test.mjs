// SPDX-License-Identifier: Apache-2.0
// The authorisation card is a decision: a grant is taken back before the gate, and who authorises a
// plan with a vehicle that is silent says so.
import assert from "node:assert/strict";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join, relative } from "node:path";
import { after, describe, test } from "node:test";

import { fly, scenarios, until, work } from "./bench.mjs";
import { barriers, browse, hold, say } from "./browser.mjs";

/** The small mission with so long from the request to the gate, and nobody else to decide. */
function patient(name, lead_s, more = "") {
  const folder = join(work, "scenarios");
  mkdirSync(folder, { recursive: true });
  const text = readFileSync(join(scenarios, "coalition-6.yaml"), "utf8")
    .replace(/authorisation_lead_s: \d+/, `authorisation_lead_s: ${lead_s}`)
    .replace(/duration_max_s: \d+/, "duration_max_s: 110");
  const file = join(folder, `${name}.yaml`);
  writeFileSync(file, text + more);
  return relative(scenarios, file);
}

async function open(name, lead_s, more) {
  const mission = await fly(patient(name, lead_s, more), name);
  const view = await browse(mission.url);
  await until("six vehicles", async () => (await view.part("count-heard").innerText()).includes("6/6"));
  return { mission, view };
}

const lines = async (mission, line) => (await mission.audit()).filter((entry) => entry.line === line);

describe("a grant", () => {
  let at;
  after(async () => {
    await at?.view.browser.close();
    await at?.mission.stop();
  });

  test("is taken back at once, before the gate, and the vehicles do not fly it", async () => {
    at = await open("taken-back", 30);
    const { mission, view } = at;
    await until("a request", () => view.part("authorise-1").isVisible());
    await hold(view.part("authorise-1"));
    await until("the grant", () => view.part("take-back-1").isVisible());
    assert.match(await view.part("granted-1").innerText(), /before their gates: [\d–, ]+, the first/);
    assert.ok((await view.part("take-back-1").boundingBox()).height >= 44);
    assert.deepEqual(await barriers(view.page), []);
    await view.picture("granted");
    await view.part("tab-fleet").click();
    await until("their deliveries", async () => (await view.part("fleet").innerText()).includes("deliver"));

    await view.part("take-back-1").click();
    await until("the order", async () => (await lines(mission, "withdraw decision 1")).some(({ done }) => done));
    await until("nobody with a delivery", async () => !(await view.part("fleet").innerText()).includes("deliver"));
    assert.equal(await view.part("granted-1").count(), 0);
    await view.part("tab-mission").click();
    assert.match(await view.part("site-1").innerText(), /authorisation taken back · 0\/3 delivered/);
    assert.match(await view.part("authorisations").innerText(), /taken back by/);
    await view.part("tab-log").click();
    await until("what vehicles say of it", async () => /taken the grant back/.test(await view.page.locator('[data-testid^="event-"]').allInnerTexts().then((all) => all.join("\n"))));
    await view.picture("taken-back");
    // Once more there is nothing to take back.
    const again = await say(view.page, { line: "withdraw decision 1" });
    assert.equal(again.done, false);
    assert.match(again.text, /nothing that is granted/);
  });

  test("that is taken back leaves a mission whose checks hold", async () => {
    const { mission, view } = at;
    assert.deepEqual(view.complaints, []);
    await until("its end", async () => (await mission.ended()) === 0, 200_000);
    assert.match(mission.text(), /taken back/);
  });
});

describe("a plan with a vehicle that is silent", () => {
  let at;
  after(async () => {
    await at?.view.browser.close();
    await at?.mission.stop();
  });

  test("is authorised only by a second step, which is noted", async () => {
    at = await open("silent", 60, "\nfaults:\n  - {at_s: 33, kill_vehicle: 3}\n");
    const { mission, view } = at;
    await until("a request", () => view.part("authorise-1").isVisible());
    await until("the silence", () => view.part("authorise-silent-1").isVisible());
    assert.equal(await view.part("authorise-1").count(), 0);
    assert.match(await view.part("authorise-silent-1").innerText(), /vehicle 3 is silent/);
    assert.ok((await view.part("authorise-silent-1").boundingBox()).height >= 44);
    const plain = await say(view.page, { line: "authorise 1" });
    assert.equal(plain.done, false);
    assert.match(plain.text, /vehicle 3 is silent for \d+ s/);
    await view.picture("silent");
    await view.part("authorise-silent-1").click();
    assert.equal((await lines(mission, "authorise 1 override")).length, 0);
    await hold(view.part("override-1"));
    const noted = await until("the decision", async () => (await lines(mission, "authorise 1 override")).find(({ done }) => done));
    assert.match(noted.text, /although vehicle 3 is silent for \d+ s/);
    assert.deepEqual(view.foreign, []);
    assert.deepEqual(view.complaints, []);
  });
});
