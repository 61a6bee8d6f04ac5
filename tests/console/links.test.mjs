// SPDX-License-Identifier: Apache-2.0
// Who hears whom, the wind as the team tells it, and where a vehicle's pictures are: of a mission on
// a radio that loses a fifth; and of one in which the ground station hears some through others alone.
import assert from "node:assert/strict";
import { readFile, writeFile } from "node:fs/promises";
import { join, relative } from "node:path";
import { after, before, test } from "node:test";

import { fly, scenarios, until, work } from "./bench.mjs";
import { barriers, browse, say } from "./browser.mjs";

const loss_percent = 20;
const wind = { speed: 4, from_deg: 300 };
const video = "rtsp://127.0.0.1:8554/three";

/** The small mission with another radio and wind, a file beside the others. */
async function scenario(name, changes) {
  let text = await readFile(join(scenarios, "coalition-6.yaml"), "utf8");
  // It waits for a decision that nobody takes, for as long as it is looked at.
  changes = [[/duration_max_s: 120/, "duration_max_s: 900"], ...changes];
  for (const [before, after] of changes) {
    assert.match(text, before);
    text = text.replace(before, after);
  }
  const file = join(work, `${name}.yaml`);
  await writeFile(file, text);
  return relative(scenarios, file);
}

let mission;
let view;
before(async () => {
  const file = await scenario("links-6", [
    [/loss_ratio: 0\b/, `loss_ratio: ${loss_percent / 100}`],
    [/^wind: .*$/m, `wind: {speed_mps: ${wind.speed}, from_deg: ${wind.from_deg}, gust_mps: 0}\nconsole: {videos: [{vehicle: 3, url: "${video}"}]}`],
  ]);
  mission = await fly(file, "links");
  view = await browse(mission.url);
});
after(async () => {
  await view?.browser.close();
  await mission?.stop();
});

const percents = (selector) => view.page.locator(selector).evaluateAll((cells) => cells.map((cell) => Number(cell.textContent)).filter(Number.isFinite));

test("all hear all, and what the radio loses is told of each link", async () => {
  await until("six vehicles", async () => (await view.part("count-heard").innerText()).includes("6/6"));
  await view.part("tab-links").click();
  await view.part("links-matrix").click();
  // The ground station's row, and what each vehicle tells of itself: 7 times 6 links.
  await until("figures of all links", async () => (await percents('[data-testid^="link-"][data-tone="some"], [data-testid^="link-"][data-tone="bad"]')).length === 42);
  const mean = () => percents('.link-matrix button').then((all) => all.reduce((sum, one) => sum + one, 0) / all.length);
  await until(`about ${loss_percent} % lost`, async () => Math.abs((await mean()) - loss_percent) < 4);
  await view.picture("links");
});

test("a field says its figures when it is pointed at, or reached by the keyboard", async () => {
  await view.part("link-2-0").hover();
  await until("the figures", async () => /^vehicle 2 hears ground station: \d+ % lost, \d+\.\d a second, /.test(await view.part("link-figures").innerText()));
  await view.part("link-0-5").focus();
  await until("those of another", async () => /^ground station hears vehicle 5: \d+ % lost, \d+\.\d a second, \d+ B\/s, /.test(await view.part("link-figures").innerText()));
});

test("the list has the worst first, and the prompt the same figures", async () => {
  await view.part("links-list").click();
  // Read at once, as they may be ordered anew at any time.
  const listed = await view.part("link-list").locator("li").evaluateAll((items) => items.map((item) => ({ tone: item.dataset.tone, text: item.innerText })));
  assert.equal(listed.length, 42);
  // On a busy machine a link may be silent for so long that it is worse than any that loses something.
  const worst_first = ["old", "bad", "some", "good"];
  const ranks = listed.map(({ tone, text }) => [worst_first.indexOf(tone), Number(/(\d+) % lost/.exec(text)?.[1])]);
  assert.ok(ranks.every(([tone, lost]) => tone >= 0 && Number.isFinite(lost)), JSON.stringify(listed));
  assert.deepEqual(ranks, [...ranks].sort(([tone, lost], [other_tone, other_lost]) => tone - other_tone || other_lost - lost));
  const answer = await say(view.page, { line: "links" });
  assert.match(answer.text, /^ground {2}1 \d+\.\d\/s \d+ % \d+ B\/s, 2 /m);
  assert.match(answer.text, /^6 +ground \d+\.\d\/s \d+ %, 1 /m);
});

test("the links are drawn on the map, and no barrier is in the panel", async () => {
  await view.part("links-on-map").click();
  assert.equal(await view.part("links-on-map").getAttribute("aria-pressed"), "true");
  for (const way of ["matrix", "list"]) {
    await view.part(`links-${way}`).click();
    assert.deepEqual(await barriers(view.page), [], way);
  }
  await view.picture("links-map");
});

test("the wind is told as it is, from those that fly in it", async () => {
  const figures = async () => {
    if (!(await view.part("wind").isVisible())) return null;
    const found = /from (\d+)°, ([\d.]+) m\/s, gusts ([\d.]+)/.exec(await view.part("wind-figures").innerText());
    return found && { from_deg: Number(found[1]), speed: Number(found[2]) };
  };
  const off = ({ from_deg, speed }) => {
    const vector = (direction, length) => [length * Math.sin((direction * Math.PI) / 180), length * Math.cos((direction * Math.PI) / 180)];
    const [a, b] = [vector(from_deg, speed), vector(wind.from_deg, wind.speed)];
    return Math.hypot(a[0] - b[0], a[1] - b[1]);
  };
  await until("the scenario's wind, within half a metre a second", async () => {
    const now = await figures();
    return now && off(now) < 0.5;
  });
  assert.match(await view.part("wind-tellers").innerText(), /^[3-6] planes tell, /);
  const answer = await say(view.page, { line: "wind" });
  assert.match(answer.text, /^from \d{3} deg at \d\.\d m\/s, gusts \d\.\d m\/s; [3-6] planes tell/);
});

test("a vehicle's pictures are a link that opens elsewhere, and nothing of ours asks for them", async () => {
  await view.part("tab-fleet").click();
  await view.part("vehicle-3").click();
  const link = view.part("vehicle-video");
  await until("the link", () => link.isVisible());
  assert.equal(await link.getAttribute("href"), video);
  assert.equal(await link.getAttribute("target"), "_blank");
  assert.match(await link.getAttribute("rel"), /noopener/);
  assert.equal(await view.page.locator("video, iframe, img[src^='rtsp']").count(), 0);
  const answer = await say(view.page, { line: "status 3" });
  assert.match(answer.text, new RegExp(`^video +${video}$`, "m"));
  await view.part("vehicle-2").click();
  await until("another vehicle", async () => (await view.part("vehicle-details").innerText()).includes("Vehicle 2"));
  assert.equal(await view.part("vehicle-video").count(), 0);
});

test("nothing was asked of anybody else, and nothing was complained about", () => {
  assert.deepEqual(view.foreign, []);
  assert.deepEqual(view.complaints, []);
});

test("who is out of the ground station's reach is heard through others, and shown so", async () => {
  await view.browser.close();
  await mission.stop();
  // Vehicle 6 waits 530 m away; those between pass on what it says.
  const file = await scenario("links-mesh-6", [[/ground_range_m: 5000/, "ground_range_m: 420"], [/^wind: /m, "air: {hops_max: 3}\nwind: "]]);
  mission = await fly(file, "links-mesh");
  view = await browse(mission.url);
  await until("vehicle 6", async () => (await view.part("count-heard").innerText()).includes("6/6"));
  await view.part("tab-links").click();
  await view.part("links-matrix").click();
  await until("its link", async () => (await view.part("link-0-6").getAttribute("data-tone")) === "through");
  assert.match(await view.part("links-through").innerText(), /^Heard through others only: .*6/);
  await view.part("links-on-map").click();
  await view.picture("links-mesh");
  // Its neighbours hear it themselves.
  await until("a neighbour's link", async () => ["good", "some"].includes(await view.part("link-2-6").getAttribute("data-tone")));
  assert.deepEqual(view.complaints, []);
});
