// SPDX-License-Identifier: Apache-2.0
// A fleet that is too large to be read row by row: counted, filtered, selected, ordered as one, and
// seen whole on time line and map.
import assert from "node:assert/strict";
import { after, before, describe, test } from "node:test";

import { fly, until } from "./bench.mjs";
import { browse, hold } from "./browser.mjs";
import { a_hello, a_site, a_vehicle, pretend } from "./station.mjs";

const states = ["searching", "surveying", "holding_by_order", "returning"];
/** 50 of them, of which 12 and 33 need attention, and 7 has another release. */
const fleet = (count, more = () => ({})) =>
  Array.from({ length: count }, (_, i) => {
    const id = i + 1;
    return a_vehicle(id, {
      state: states[i % 4],
      ...(id === 12 ? { problems: [{ level: "alarm", text: "its range is overdrawn" }] } : {}),
      ...(id === 33 ? { silent: true, state: "silent", heard_age_s: 9 } : {}),
      ...more(id),
    });
  });
const timeline = (count) => ({
  states: ["searching", "surveying"],
  vehicles: Array.from({ length: count }, (_, i) => ({ id: i + 1, states: [0, 1], from_s: [0, 40], sites: [null, null] })),
});
const nothing = { plans: [], sites: [], coalitions: [], authorisations: [], hazards: [], audit: [], proposals: [] };

describe("50 vehicles", () => {
  let station;
  let view;
  let page;
  before(async () => {
    const hello = a_hello(50, { groups: [{ name: "west", vehicles: [1, 2, 3] }] });
    station = await pretend("fleet", hello, { ...nothing, vehicles: fleet(50), timeline: timeline(50) });
    ({ view } = station);
    ({ page } = view);
    await until("the list", () => view.part("vehicle-12").isVisible());
  });
  after(() => station?.stop());

  const shown = () => view.part("fleet-shown").innerText();
  const listed = () => page.locator('[data-testid="fleet"] tr.vehicle').evaluateAll((rows) => rows.map((row) => Number(row.dataset.testid.slice("vehicle-".length))));
  const picked = async () => ((await view.part("selection-bar").count()) ? (await view.part("selection-bar").locator(".selection-ids").innerText()) : "");
  const clear = async () => {
    await page.keyboard.press("Escape");
    await until("nobody is selected", async () => (await view.part("selection-bar").count()) === 0 && (await page.locator("tr.selected").count()) === 0);
  };

  test("it is counted by state, what needs attention first", async () => {
    assert.match(await view.part("chip-attention").innerText(), /^2 need attention/);
    assert.match(await view.part("chip-silent").innerText(), /1 silent/);
    assert.match(await view.part("chip-searching").innerText(), /12 searching/);
    assert.match(await view.part("chip-surveying").innerText(), /13 surveying/);
    assert.deepEqual((await listed()).slice(0, 3), [12, 33, 1]);
  });

  test("a count lists only those, and filters are combined", async () => {
    await view.part("chip-returning").click();
    await until("12 of 50", async () => (await shown()) === "12 of 50");
    await view.part("chip-attention").click();
    await until("one of them", async () => (await shown()) === "1 of 50" && (await listed())[0] === 12);
    await view.part("fleet-clear").click();
    await until("all", async () => (await shown()) === "50");
    await view.part("fleet-search").fill("3, 40-44");
    await until("those numbers", async () => (await shown()) === "6 of 50");
    await view.part("fleet-search").fill("overdrawn");
    await until("who has that problem", async () => (await listed()).join() === "12");
    await view.part("fleet-search").fill("nobody has this");
    await until("no row", async () => /None of the fleet/.test(await view.part("fleet").innerText()));
    await view.part("fleet-clear").click();
    await view.part("fleet-group").selectOption("west");
    await until("the group", async () => (await listed()).join() === "1,2,3");
    await view.part("fleet-clear").click();
  });

  test("a column sorts upwards, downwards, and then attention is first again", async () => {
    await view.part("sort-id").click();
    await until("upwards", async () => (await listed()).slice(0, 3).join() === "1,2,3");
    await view.part("sort-id").click();
    await until("downwards", async () => (await listed()).slice(0, 3).join() === "50,49,48");
    assert.equal(await page.locator("th", { has: view.part("sort-id") }).getAttribute("aria-sort"), "descending");
    await view.part("sort-id").click();
    await until("attention", async () => (await listed())[0] === 12);
  });

  test("several are selected by boxes, ranges and keys, and have one order", async () => {
    await view.part("pick-2").click();
    await view.part("pick-5").click();
    await until("two", async () => (await picked()) === "2, 5");
    await view.part("pick-8").click({ modifiers: ["Shift"] });
    await until("a range", async () => (await picked()) === "2, 5–8" || (await picked()) === "5–8");
    await view.picture("selection");
    await view.part("selection-hold").click();
    await until("the order", () => station.orders.length === 1);
    assert.equal(station.orders[0].kind, "commands");
    assert.equal(station.orders[0].command, "hold");
    assert.deepEqual(station.orders[0].vehicles.filter((id) => id >= 5), [5, 6, 7, 8]);
    await clear();

    await view.part("vehicle-1").getByRole("button", { name: /^Vehicle 1,/ }).click();
    await page.keyboard.press("Shift+ArrowDown");
    await page.keyboard.press("Shift+ArrowDown");
    await until("three by keys", async () => (await picked()) === "1–3");
    // A short press of what flies is no order.
    await hold(view.part("selection-return"), 300);
    await hold(view.part("selection-return"));
    await until("the second", () => station.orders.length === 2);
    assert.deepEqual(station.orders[1], { kind: "commands", command: "return_home", vehicles: [1, 2, 3] });
    await view.part("chip-holding_by_order").click();
    await until("those that hold", async () => (await shown()) === "12 of 50");
    await view.part("fleet-scroll").focus();
    await page.keyboard.press("Control+a");
    await until("all that are listed", async () => /^12 selected/.test(await view.part("selection-count").innerText()));
    await view.part("fleet-clear").click();
    await clear();
  });

  /** Where a place is on the screen, by what the map itself says of two of its pixels. */
  async function on_screen() {
    const box = await view.part("map").boundingBox();
    const at = async (x, y) => {
      await page.mouse.move(box.x + x, box.y + y);
      const text = await until("the cursor", async () => (await view.part("map-cursor").count()) && (await view.part("map-cursor").innerText()));
      const [, east, north] = /E (\S+) N (\S+) m/.exec(text.replaceAll("−", "-"));
      return { x: Number(east), y: Number(north) };
    };
    const [a, b] = [await at(60, 60), await at(460, 360)];
    const scale = 400 / (b.x - a.x);
    return { scale, of: (x, y) => ({ x: box.x + 60 + (x - a.x) * scale, y: box.y + 60 - (y - a.y) * scale }), box };
  }

  test("on the map a press with Shift adds, a box selects what is in it", async () => {
    const map = await on_screen();
    const at = (id) => map.of(100 * (id % 20), 100 * Math.floor(id / 20));
    await page.mouse.click(at(5).x, at(5).y);
    await until("one", async () => (await page.locator("tr.selected").count()) === 1 && (await view.part("vehicle-details").isVisible()));
    await page.keyboard.down("Shift");
    await page.mouse.click(at(25).x, at(25).y);
    await until("another one", async () => (await picked()) === "5, 25");
    await page.mouse.move(at(7).x - 6, at(7).y + 8);
    await page.mouse.down();
    await page.mouse.move(at(9).x + 6, at(9).y - 8, { steps: 4 });
    await page.mouse.up();
    await page.keyboard.up("Shift");
    await until("those in the box besides", async () => (await picked()) === "5, 7–9, 25");
    assert.ok(Math.abs((await on_screen()).of(0, 0).x - map.of(0, 0).x) < 3, "the map has not moved");
    await view.part("box").click();
    await page.mouse.move(at(42).x - 6, at(42).y + 8);
    await page.mouse.down();
    await page.mouse.move(at(44).x + 6, at(44).y - 8, { steps: 4 });
    await page.mouse.up();
    await until("those in the box alone", async () => (await picked()) === "42–44");
    assert.equal(await view.part("box").getAttribute("aria-pressed"), "false");
    await view.picture("box");
  });

  test("a selection is kept as a group, and selected again by a key after a reload", async () => {
    await view.part("groups-open").click();
    await view.part("group-name").fill("north");
    await view.part("group-keep").click();
    await until("the group", () => view.part("group-north").isVisible());
    await page.keyboard.press("Escape");
    await page.reload();
    await until("the list", () => view.part("vehicle-12").isVisible());
    assert.equal(await view.part("selection-bar").count(), 0);
    await page.keyboard.press("Shift+Digit2");
    await until("the operator's own", async () => (await picked()) === "42–44");
    await page.keyboard.press("Shift+Digit1");
    await until("the configured one", async () => (await picked()) === "1–3");
    await until("its column", async () => /west/.test(await view.part("vehicle-1").innerText()));
    await view.part("groups-open").click();
    await view.part("forget-north").click();
    await until("it is forgotten", async () => (await view.part("group-north").count()) === 0);
    await page.keyboard.press("Escape");
    await clear();
  });

  test("the time line has all of them in sight, what needs attention on top", async () => {
    await until("50 rows", async () => (await view.part("timeline").getAttribute("data-rows")) === "50");
    await view.part("timeline").click({ position: { x: 100, y: 18 + 7 } });
    await until("the one with the alarm", async () => /Vehicle 12/.test(await view.part("vehicle-details").innerText()));
    await view.part("timeline-all").click();
    await until("rows that are scrolled", async () => Number(await view.part("timeline").getAttribute("data-rows")) < 20);
    await view.part("timeline-all").click();
    await until("all again", async () => (await view.part("timeline").getAttribute("data-rows")) === "50");
    await clear();
  });

  test("a new site comes into sight by itself, until the map is moved by hand", async () => {
    const sees = async (x, y) => {
      const { of, box } = await on_screen();
      const at = of(x, y);
      return at.x > box.x && at.x < box.x + box.width && at.y > box.y && at.y < box.y + box.height;
    };
    assert.equal(await sees(5000, 5000), false);
    station.state({ sites: [a_site(7, 5000, 5000)] });
    await until("the site", () => sees(5000, 5000));
    assert.equal(await view.part("show-outside").count(), 0);

    const { box } = await on_screen();
    await page.mouse.move(box.x + 200, box.y + 200);
    await page.mouse.down();
    await page.mouse.move(box.x + 240, box.y + 220, { steps: 4 });
    await page.mouse.up();
    // What is let go in motion glides on for a moment.
    let rests;
    await until("that the map rests", async () => {
      const last = rests;
      rests = (await on_screen()).of(0, 0);
      return last?.x === rests.x && last?.y === rests.y;
    });
    station.state({ sites: [a_site(7, 5000, 5000), a_site(8, -9000, 0)] });
    await until("the offer", () => view.part("show-outside").isVisible());
    assert.match(await view.part("show-outside").innerText(), /Site 8 is outside the view/);
    assert.ok(Math.abs((await on_screen()).of(0, 0).x - rests.x) < 3, "the map stays where it was put");
    await view.picture("outside");
    await view.part("show-outside").click();
    await until("both", async () => (await sees(-9000, 0)) && (await sees(5000, 5000)));
    assert.equal(await view.part("show-outside").count(), 0);
    // By hand again: and taken back by All.
    station.state({ sites: [a_site(7, 5000, 5000), a_site(8, -9000, 0), a_site(9, 0, -30000)] });
    await until("the next offer", () => view.part("show-outside").isVisible());
    await view.part("fit").click();
    await until("all of it", () => sees(0, -30000));
    station.state({ sites: [] });
  });

  test("a narrow list says in an opened row what has no column", async () => {
    await page.setViewportSize({ width: 390, height: 844 });
    await until("fewer columns", async () => (await view.part("sort-mode").count()) === 0);
    await view.part("open-12").click();
    await until("the rest", async () => /Mode/.test(await view.part("sheet-12").innerText()) && /Clock\s+30 ms/.test(await view.part("sheet-12").innerText()));
    await view.picture("narrow-row");
    await view.part("fleet-tools-open").click();
    await view.part("columns-open").click();
    await view.part("columns-auto").click();
    await view.part("column-clock").check();
    await until("the column", () => view.part("sort-clock").isVisible());
    await view.part("columns-auto").click();
    await until("as many as fit", async () => (await view.part("sort-clock").count()) === 0);
    await page.keyboard.press("Escape");
    await page.setViewportSize({ width: 1280, height: 720 });
  });

  test("nothing was asked of anybody else, and nothing was complained about", () => {
    assert.deepEqual(view.complaints, []);
  });
});

describe("versions and digests of 50 vehicles", () => {
  let station;
  let view;
  const row = (id, more = {}) => ({
    id, readiness: "in_flight", why: "", counts: true, told_s: 70, release: "0.2.0", firmware: "4.6.1", parameters: "0a1b2c3d", configuration: "deadbeef",
    odd: [], marks: ["ok"], lines: [], lines_left_out: 0, ...more,
  });
  before(async () => {
    const rows = Array.from({ length: 50 }, (_, i) => row(i + 1, i === 36 ? { parameters: "0a1b2c3e", odd: ["parameters"] } : i === 4 ? { release: "0.1.0", odd: ["release"] } : {}));
    station = await pretend("digests", a_hello(50), { ...nothing, vehicles: fleet(50), timeline: timeline(0), preflight: { summary: "50 armed or in the air", groups: ["clock"], vehicles: rows } });
    ({ view } = station);
    await view.part("tab-preflight").click();
    await view.part("preflight-versions").click();
  });
  after(() => station?.stop());

  test("the odd ones are seen at a glance, in flight too", async () => {
    await until("the grid", () => view.part("digest-grid").isVisible());
    await view.picture("digests");
    assert.match(await view.part("odd-summary").innerText(), /^2 of 50 are not as the others: 5, 37/);
    assert.match(await view.part("odd-parameters").innerText(), /≠ 0a1b2c on 37/);
    assert.match(await view.part("kinds-release").innerText(), /0\.2\.0 × 49/);
    assert.match(await view.part("odd-release").innerText(), /0\.1\.0 on 5/);
    const height = view.page.viewportSize().height;
    for (const id of [1, 37, 50]) {
      const box = await view.part(`tile-${id}`).boundingBox();
      assert.ok(box.y + box.height <= height, `tile ${id} is in sight`);
    }
    assert.match(await view.part("tile-37").innerText(), /≠P/);
    assert.deepEqual(await view.page.locator('[data-testid^="tile-"][data-odd]:not([data-odd=""])').evaluateAll((all) => all.map((one) => one.dataset.testid)), ["tile-5", "tile-37"]);
    await view.part("odd-parameters").click();
    await view.part("tab-fleet").click();
    await until("it is selected", async () => /Vehicle 37/.test(await view.part("vehicle-details").innerText()));
  });
});

describe("1,000 vehicles", () => {
  let station;
  let view;
  before(async () => {
    station = await pretend("thousand", a_hello(1000), { ...nothing, vehicles: fleet(1000), timeline: timeline(1000) });
    ({ view } = station);
    await until("the list", () => view.part("vehicle-12").isVisible());
  });
  after(() => station?.stop());

  test("only rows in sight are in the page, and any can be reached", async () => {
    const rows = () => view.page.locator('[data-testid="fleet"] tr.vehicle').count();
    assert.equal(await view.page.locator(".fleet-table").getAttribute("aria-rowcount"), "1001");
    assert.ok((await rows()) < 80, `${await rows()} rows`);
    await view.part("fleet-scroll").focus();
    await view.page.keyboard.press("End");
    await until("the last", () => view.part("vehicle-1000").isVisible());
    assert.ok((await rows()) < 80, `${await rows()} rows`);
    assert.match(await view.part("vehicle-details").innerText(), /Vehicle 1000/);
    await view.page.keyboard.press("Home");
    await until("the first", () => view.part("vehicle-12").isVisible());
    await view.page.keyboard.press("Control+a");
    await until("all", async () => /^1000 selected/.test(await view.part("selection-count").innerText()));
  });
});

describe("a real mission", () => {
  let mission;
  let view;
  before(async () => {
    mission = await fly("coalition-6.yaml", "several");
    view = await browse(mission.url);
    await until("six vehicles", async () => (await view.part("count-heard").innerText()).includes("6/6"));
    await until("they search", async () => /searching/.test(await view.part("vehicle-6").innerText()));
  });
  after(async () => {
    await view?.browser.close();
    await mission?.stop();
  });
  const does = async (id) => view.part(`vehicle-${id}`).locator(".cell-state").innerText();

  test("one order holds three of six, in one line of the audit", async () => {
    for (const id of [2, 4, 5]) await view.part(`pick-${id}`).click();
    await view.part("selection-hold").click();
    const line = await until("the order", async () => (await mission.audit()).find(({ line: given }) => given === "hold 2,4,5"));
    assert.equal(line.done, true);
    assert.match(line.text, /told to 2,4,5/);
    await until("the three hold", async () => (await Promise.all([2, 4, 5].map(does))).every((state) => /holding by order/.test(state)));
    for (const id of [1, 3, 6]) assert.doesNotMatch(await does(id), /holding by order/);
    assert.equal((await mission.audit()).filter(({ line: given }) => given.startsWith("hold")).length, 1);
    await view.picture("three-hold");
  });

  test("they go on by one order that is held", async () => {
    await hold(view.part("selection-resume"));
    await until("the order", async () => (await mission.audit()).some(({ line, done }) => line === "resume 2,4,5" && done));
    await until("nobody holds", async () => (await Promise.all([2, 4, 5].map(does))).every((state) => !/holding by order/.test(state)));
    assert.deepEqual(view.complaints, []);
  });
});
