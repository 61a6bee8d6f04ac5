// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { empty_picture, newest_events, reduce } from "./picture";
import type { Picture } from "./picture";
import type { Coalition, FromServer, Hello, MissionEvent } from "./protocol";
import { a_coalition, a_hello, an_event, a_vehicle } from "./samples";

const after = (...messages: FromServer[]): Picture => messages.reduce(reduce, empty_picture());
const events = (...list: MissionEvent[]): FromServer => ({ type: "events", events: list });
const history = (first_seq: number, next_seq: number): FromServer => ({
  type: "history",
  series: [],
  events: { first_seq, next_seq },
});

test("a state changes the sections that it has and keeps the others as they are", () => {
  const before = after({ type: "state", time_s: 1, vehicles: [a_vehicle(1)], hazards: [] });
  const then = reduce(before, { type: "state", time_s: 1.1, sites: [] });
  assert.equal(then.time_s, 1.1);
  assert.equal(then.vehicles, before.vehicles);
  assert.notEqual(then.sites, before.sites);
});

test("a section that became null is taken, one that is left out is not", () => {
  const formation = { in_place: true, moving: false, change: null, places: [] };
  const before = after({ type: "state", time_s: 1, formation });
  assert.equal(reduce(before, { type: "state", time_s: 2 }).formation, formation);
  assert.equal(reduce(before, { type: "state", time_s: 2, formation: null }).formation, null);
});

test("events that come again after a reconnection are not doubled, and none is lost", () => {
  const picture = after(
    events(an_event(0), an_event(1), an_event(2)),
    history(0, 5),
    events(an_event(1), an_event(2), an_event(3)),
    events(an_event(4)),
  );
  assert.deepEqual(picture.events.map((event) => event.seq), [0, 1, 2, 3, 4]);
  assert.equal(picture.next_seq, 5);
});

test("events that the server no longer has are counted", () => {
  const picture = after(events(an_event(1), an_event(2)), history(10, 20));
  assert.equal(picture.events_missed, 7);
  assert.equal(after(history(10, 20)).events_missed, 0);
});

test("of a mission the newest events are kept, and every warning", () => {
  const list = Array.from({ length: newest_events + 100 }, (_, seq) => ({ ...an_event(seq), level: seq % 10 === 0 ? "warning" : "info" }) as const);
  const seqs = ({ events: all }: Picture) => all.map(({ seq }) => seq);
  const newest = list.slice(100).map(({ seq }) => seq);
  const picture = after(...list.map((event) => events(event)));
  assert.deepEqual(seqs(picture), [0, 10, 20, 30, 40, 50, 60, 70, 80, 90, ...newest]);
  assert.equal(picture.events_missed, 90);
  assert.deepEqual(seqs(after(events(...list))), seqs(picture));
  const replay: Hello = { ...a_hello(), replay: { name: "m", from_s: 0, to_s: 9 } };
  assert.equal(after(replay, ...list.map((event) => events(event))).events.length, list.length);
});

test("another run of the server: all is forgotten, and asked for anew", () => {
  const hello = (run: string): Hello => ({ ...a_hello(), run });
  const before = after(hello("a"), events(an_event(0)), { type: "state", time_s: 9, vehicles: [a_vehicle(1)] });
  assert.equal(reduce(before, hello("a")).generation, 0);
  const then = reduce(before, hello("b"));
  assert.equal(then.generation, 1);
  assert.equal(then.next_seq, 0);
  assert.deepEqual(then.vehicles, []);
  assert.equal(then.hello?.run, "b");
  assert.equal(reduce(before, history(0, 0)).generation, 1);
});

test("a recording that is wound back takes its events back, and gives them again", () => {
  const hello: Hello = { ...a_hello(), replay: { name: "m", from_s: 0, to_s: 9 } };
  const back = after(hello, events(an_event(0), an_event(1), an_event(2)), history(0, 1));
  assert.equal(back.generation, 0);
  assert.deepEqual(back.events.map((event) => event.seq), [0]);
  assert.deepEqual(reduce(back, events(an_event(1))).events.map((event) => event.seq), [0, 1]);
});

test("a coalition keeps its place in the palette", () => {
  const state = (...coalitions: Coalition[]): FromServer => ({ type: "state", time_s: 1, coalitions });
  const picture = after(
    state(a_coalition("7/1")),
    state(a_coalition("7/1"), a_coalition("9/1")),
    state(a_coalition("9/1"), a_coalition("3/1")),
  );
  assert.deepEqual([...picture.coalition_slots], [["7/1", 0], ["9/1", 1], ["3/1", 2]]);
});
