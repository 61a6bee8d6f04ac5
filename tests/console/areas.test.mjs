// SPDX-License-Identifier: Apache-2.0
// Areas, hazards and outlines drawn on the page; vehicles on the bench fly what comes of them.
import assert from "node:assert/strict";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join, relative } from "node:path";
import { after, before, test } from "node:test";

import { fly, scenarios, until, work } from "./bench.mjs";
import { barriers, browse, hold, say } from "./browser.mjs";

let mission;
let view;
before(async () => {
  // With a site that nobody finds, or the mission would be over before its searches. Nobody waits for
  // lanes to be flown in their own time.
  const folder = join(work, "areas-scenario");
  mkdirSync(folder, { recursive: true });
  const file = join(folder, "search.yaml");
  const far = "  - {id: 2, east_m: 0, north_m: -9000, survey: {dwell_s: 5}, deliveries: {mode: simultaneous, bearings_deg: []}, reward: 1}\n";
  writeFileSync(file, readFileSync(join(scenarios, "search-3.yaml"), "utf8").replace(/^sites:\n/m, `sites:\n${far}`));
  mission = await fly(relative(scenarios, file), "areas", ["--rate", "3"]);
  view = await browse(mission.url, { viewport: { width: 1440, height: 900 } });
});
after(async () => {
  await view?.browser.close();
  await mission?.stop();
});

const text_of = (id) => view.part(id).innerText();
const percent = async () => Number(/\((\d+) %\)/.exec(await text_of("search-seen"))[1]);

async function take(corners) {
  await view.part("outline-typed").fill(corners);
  await view.part("outline-take").click();
}

/** Places along a way, 5 m apart at most; of a straight line it has the ends alone. */
function along(points) {
  return points.slice(1).flatMap(([x, y], i) => {
    const [from_x, from_y] = points[i];
    const steps = Math.ceil(Math.hypot(x - from_x, y - from_y) / 5) || 1;
    return Array.from({ length: steps }, (_, k) => [from_x + ((x - from_x) * (k + 1)) / steps, from_y + ((y - from_y) * (k + 1)) / steps]);
  });
}

/** Places along every way that a search would give. */
async function ways_of(corners) {
  const answer = await say(view.page, { type: "order", order: { kind: "search", preview: true, corners } });
  assert.equal(answer.done, true, answer.text);
  return answer.data.shares.flatMap((share) => along(share.points));
}

/** How far a place is inside of the rectangle; negative outside. */
const inside_m = ([x, y], [west, south, east, north]) => Math.min(x - west, east - x, y - south, north - y);

test("an outline is drawn corner by corner, a corner dragged, another deleted", async () => {
  await until("three vehicles", async () => (await text_of("count-heard")).includes("3/3"));
  await view.part("tab-areas").click();
  await view.part("outline-draw").click();
  const map = await view.part("map").boundingBox();
  const at = (right, down) => [map.x + map.width * right, map.y + map.height * down];
  for (const place of [at(0.3, 0.6), at(0.6, 0.6), at(0.6, 0.3), at(0.45, 0.15), at(0.3, 0.3)]) await view.page.mouse.click(...place);
  await until("five corners", async () => (await text_of("outline-state")).startsWith("5 of"));
  const east = await view.part("corner-2-east").inputValue();
  await view.page.mouse.move(...at(0.6, 0.6));
  await view.page.mouse.down();
  await view.page.mouse.move(...at(0.65, 0.6), { steps: 5 });
  await view.page.mouse.up();
  await until("the corner at its new place", async () => Number(await view.part("corner-2-east").inputValue()) > Number(east) + 5);
  assert.match(await text_of("outline-state"), /^5 of/, "the end of a drag is no press");
  await view.part("corner-4-delete").click();
  await until("four corners", async () => (await text_of("outline-state")).startsWith("4 of"));
  await view.picture("areas-drawn");
  await view.part("outline-draw").click();
});

test("an outline that is none is not given, and says why", async () => {
  await take("0,0 100,100 100,0 0,100");
  await until("the reason", async () => (await text_of("outline-state")).includes("crosses itself"));
  assert.equal(await view.part("search-preview").isDisabled(), true);
  await take("0,0 nowhere");
  assert.match(await text_of("outline-trouble"), /EAST,NORTH/);
  const answer = await say(view.page, { type: "order", order: { kind: "search", preview: true, corners: [[0, 0], [100, 100], [100, 0], [0, 100]] } });
  assert.equal(answer.done, false);
  assert.match(answer.text, /crosses/);
});

test("a GeoJSON file gives an outline", async () => {
  const [latitude, longitude] = [31.522062, 105.044327];
  const ring = [[0, 0], [0.005, 0], [0.005, 0.004], [0, 0.004], [0, 0]].map(([east, north]) => [longitude + east, latitude + north]);
  await view.part("outline-file").setInputFiles({ name: "area.geojson", mimeType: "application/geo+json", buffer: Buffer.from(JSON.stringify({ type: "Polygon", coordinates: [ring] })) });
  await until("its corners", async () => (await text_of("outline-state")).startsWith("4 of"));
  assert.ok(Math.abs(Number(await view.part("corner-2-east").inputValue()) - 475) < 5);
});

test("an area is previewed with its time and shares", async () => {
  await take("-100,200 900,200 900,850 -100,850");
  await view.part("search-preview").click();
  await until("the preview", () => view.part("search-outcome").isVisible());
  const text = await text_of("search-outcome");
  assert.match(text, /65\.0 ha in lanes 2\d\d m apart, by 3 vehicles: .* covered in (\d+ min )?\d+ s .* 100\.0 % of it/);
  for (const id of [1, 2, 3]) assert.match(text, new RegExp(`vehicle ${id}: \\d+ lanes?, [\\d.]+ km`));
  await view.picture("areas-preview");
  assert.deepEqual(await barriers(view.page), []);
});

test("it is given, taken by all, flown, and seen", async () => {
  await hold(view.part("search-give"));
  await until("the order", async () => (await mission.audit()).some(({ line, done }) => done && line.startsWith("search -100,200")));
  await until("three that fly it", async () => {
    const states = await Promise.all([1, 2, 3].map((id) => text_of(`share-${id}`)));
    return states.every((state) => state.includes("flies"));
  });
  await until("a part that is seen", async () => (await percent()) > 5, 90_000);
  assert.match(await text_of("search-seen"), /^\d+\.\d of 65\.0 ha searched \(\d+ %\)$/);
  assert.match(await text_of("search-expected"), /^expected to be done in .* s, at \d\d:\d\d \(\d\d:\d\d:\d\d UTC\)/);
  assert.match(await text_of("share-1"), /\d+ of \d+, \d+(\.\d)? k?m\s+in .* s, at \d\d:\d\d\s+flies/);
  const prompt = (await say(view.page, { line: "search" })).text;
  assert.match(prompt, /the area is being searched: \d+\.\d of 65\.0 ha searched \(\d+ %\), 100 % when all is flown/);
  assert.match(prompt, /expected to be done in .* at [\d.]+ s \(\d\d:\d\d:\d\d UTC\)/);
  assert.match(prompt, /1  flies: \d+ lanes? with \d+\.\d km of \d+ left, done in/);
  const first = await percent();
  await until("more of it", async () => (await percent()) > first + 20, 90_000);
  await view.picture("areas-flown");
  await until("all of it", async () => (await text_of("search-progress")).includes("flown to its end"), 180_000);
  assert.ok((await percent()) >= 99, `${await percent()} % seen`);
});

const given_line = async (line) => {
  const answer = await say(view.page, { line });
  assert.equal(answer.done, true, answer.text);
  return answer.text;
};
const alarm_text = async () => {
  const row = view.part("alarm-search_ended");
  return (await row.count()) === 1 ? row.innerText() : "";
};

test("who is held before a search begins leaves it alone: said before, and standing until it is dealt with", async () => {
  await given_line("search -100,200 900,200 900,850 -100,850 in 40");
  await until("three that fly it", async () => (await Promise.all([1, 2, 3].map((id) => text_of(`share-${id}`)))).every((state) => state.includes("flies")));
  await view.part("tab-fleet").click();
  await view.part("vehicle-3").click();
  await until("what a hold would end", async () => /Hold, return and land end the search of vehicle 3: \d+\.\d of 65\.0 ha searched/.test(await text_of("ends-search")));
  assert.deepEqual(await barriers(view.page), []);
  assert.match((await say(view.page, { type: "order", order: { kind: "hazard", preview: true, x: 400, y: 500, radius_m: 200 } })).text, /it ends the search of vehicles? [\d,-]+: /);
  await view.part("vehicle-hold").click();
  await until("the answer", async () => (await view.page.locator(".notice, [data-testid^=notice]").allInnerTexts()).some((text) => /it ends the search of vehicle 3/.test(text)));
  await view.part("alarm-counts").click();
  await until("the alarm", async () => /some search no more: .* vehicle 3: it holds/.test(await alarm_text()));
  await view.part("tab-areas").click();
  await until("its share", async () => (await text_of("share-3")).includes("left: it holds"));
  for (const id of [1, 2]) assert.match(await text_of(`share-${id}`), /flies/, "the others fly on");
  await until("the begin", async () => (await percent()) > 5, 90_000);
  for (const id of [1, 2]) assert.match(await text_of(`share-${id}`), /flies|done/);
  await view.picture("areas-one-held");
  const number = await view.part("alarm-search_ended").getAttribute("data-number");
  await view.part(`alarm-acknowledge-${number}`).click();
  await until("no alarm", async () => (await alarm_text()) === "");
  await given_line("resume 3");
  await given_line("withdraw routes");
  await until("that it is called off", async () => /search called off: \d+\.\d of 65\.0 ha searched \(\d+ %\); by the operator/.test(await alarm_text()));
  await view.part("alarm-counts").click();
});

test("a hazard is drawn as a polygon, shown as one, and ways keep out of it", async () => {
  const hazard = [300, 400, 500, 600];
  const area = [[-100, 200], [900, 200], [900, 850], [-100, 850]];
  const before = await ways_of(area);
  assert.ok(before.some((at) => inside_m(at, [200, 300, 600, 700]) > 0), "ways lead there");
  await view.part("outline-use-hazard").check();
  await take("300,400 500,400 500,600 300,600");
  await view.part("area-hazard-preview").click();
  await until("the preview", () => view.part("area-hazard-outcome").isVisible());
  assert.match(await text_of("area-hazard-outcome"), /\d+ circles hold the polygon, and shut out \d+ % more/);
  await hold(view.part("area-hazard-give"));
  const change = view.page.locator('[data-testid^="area-hazard-change-"]');
  await until("one hazard", async () => (await change.count()) === 1);
  await until("its circles", async () => /4 corners; \d+ circles hold it/.test(await text_of("area-hazards")));
  const around = await ways_of(area);
  assert.ok(around.length > 10);
  for (const at of around) assert.ok(inside_m(at, hazard) < 0, `a way leads through the hazard at ${at}`);
  await view.picture("areas-hazard");
});

test("the hazard is changed under its number, and withdrawn as a whole", async () => {
  const change = view.page.locator('[data-testid^="area-hazard-change-"]');
  const number = (await change.getAttribute("data-testid")).split("-").at(-1);
  await change.click();
  await until("its corners", async () => (await text_of("outline-state")).startsWith("4 of"));
  await view.part("corner-2-east").fill("700");
  await view.part("corner-2-east").press("Tab");
  await view.part("corner-3-east").fill("700");
  await view.part("corner-3-east").press("Tab");
  const known = async () => (await say(view.page, { line: "hazards" })).data;
  const before = (await known()).map(({ id }) => id);
  await hold(view.part("area-hazard-give"));
  await until("the order", async () => (await mission.audit()).some(({ line, done }) => done && line.startsWith(`change hazard ${number} polygon`)));
  // The old one stands until all know the new one.
  assert.ok((await known()).length > 0);
  await until("only the new circles", async () => {
    const ids = (await known()).map(({ id }) => id);
    return ids.length > 0 && !ids.some((id) => before.includes(id));
  });
  assert.equal(await view.part(`area-hazard-change-${number}`).count(), 1, "its number has stayed");
  for (const at of await ways_of([[-100, 200], [900, 200], [900, 850], [-100, 850]])) {
    assert.ok(inside_m(at, [300, 400, 700, 600]) < 0, `a way leads through the hazard at ${at}`);
  }
  await hold(view.part(`area-hazard-withdraw-${number}`));
  await until("none any more", async () => (await known()).length === 0);
});

test("a circle is dragged open, and changed", async () => {
  await view.part("area-hazard-circle").click();
  const map = await view.part("map").boundingBox();
  const x = map.x + map.width * 0.5;
  const y = map.y + map.height * 0.15;
  await view.page.mouse.move(x, y);
  await view.page.mouse.down();
  await view.page.mouse.move(x + 60, y, { steps: 6 });
  await view.page.mouse.up();
  await until("a radius", async () => /radius/.test(await text_of("area-hazard-draft")));
  await hold(view.part("area-hazard-give"));
  const change = view.page.locator('[data-testid^="area-hazard-change-"]');
  await until("the circle", async () => (await change.count()) === 1);
  const number = (await change.getAttribute("data-testid")).split("-").at(-1);
  await change.click();
  await hold(view.part("area-hazard-give"));
  await until("the order", async () => (await mission.audit()).some(({ line, done }) => done && line.startsWith(`change hazard ${number}`)));
  await until("none", async () => {
    // The list moves when the draft above it goes.
    const withdraw = view.part(`area-hazard-withdraw-${number}`);
    if (await withdraw.isVisible()) await hold(withdraw).catch(() => {});
    return (await change.count()) === 0;
  });
});

test("who finds a site is released to survey it, and the rest is shared out again", async () => {
  await view.part("outline-use-search").check();
  await take("-100,1500 900,1500 900,2300 -100,2300");
  await view.part("search-preview").click();
  await until("the preview", () => view.part("search-outcome").isVisible());
  await hold(view.part("search-give"));
  await until("one that has left", async () => /left: it has found a site/.test(await text_of("search-progress")), 150_000);
  await view.picture("areas-found");
  await view.part("tab-mission").click();
  await until("the survey", async () => /surveyed|done/.test(await text_of("site-1")), 90_000);
  await view.part("tab-areas").click();
  await until("the end", async () => (await text_of("search-progress")).includes("flown to its end"), 180_000);
  const before = await percent();
  assert.ok(before < 99, `${before} %`);
  // They may be busy at the site for a while.
  await view.part("search-rest").check();
  await until("a preview of the rest", async () => {
    await view.part("search-preview").click();
    await until("an outcome", () => view.part("search-outcome").isVisible());
    return (await text_of("search-outcome")).includes("covered in");
  }, 120_000);
  await hold(view.part("search-give"));
  await until("all of it", async () => (await percent()) >= 99, 240_000);
});

test("a fence can be drawn, copied for the configuration, and given to all in flight", async () => {
  await view.part("outline-use-fence").check();
  await take("-500,-500 1500,-500 1500,3000 -500,3000");
  await view.page.getByText("For the configuration").click();
  assert.match(await text_of("fence-yaml"), /fence:\s+height_max_m: 120\s+corners:\s+- \[-500, -500\]/);
  assert.deepEqual(await barriers(view.page), []);
  await view.part("fence-height").fill("200");
  await view.part("fence-preview").click();
  await until("what it would do", () => view.part("fence-outcome").isVisible());
  assert.match(await text_of("fence-outcome"), /can be ordered: 4 corners/);
  await hold(view.part("fence-give"));
  await until("the order", async () => (await mission.audit()).some(({ line, done }) => done && line.startsWith("fence ")));
  await until("all who keep it", async () => /1[–-]3|1, 2, 3|all/.test(await view.part("fence-keepers-this").innerText().catch(() => "")));
  assert.match(await text_of("fence-action"), /\S/);
  await view.picture("fence-kept");
});

test("nothing was asked of anybody else, and nothing was complained about", () => {
  assert.deepEqual(view.foreign, []);
  assert.deepEqual(view.complaints, []);
});
