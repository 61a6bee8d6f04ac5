// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import type { Site } from "../wire/protocol";
import { SitesSeen, outside_text } from "./out_of_view";

const site = (id: number, x: number | null, other: Partial<Site> = {}): Site => ({
  id, x, y: x, leader: null, surveyor: null, reward: null, status: "found", tasks: [], news: null, ...other,
});

test("new is what was not there, or stands somewhere else, once", () => {
  const seen = new SitesSeen();
  assert.deepEqual(seen.news([site(1, 5)], true), []);
  assert.deepEqual(seen.news([site(1, 5), site(2, 7)], false), [{ id: 2, x: 7, y: 7 }]);
  assert.deepEqual(seen.news([site(1, 5), site(2, 7)], false), []);
  assert.deepEqual(seen.news([site(1, 6), site(2, 7)], false).map(({ id }) => id), [1]);
});

test("one that is only heard of is new when its place is known, one that is over is not", () => {
  const seen = new SitesSeen();
  assert.deepEqual(seen.news([site(1, null)], false), []);
  assert.equal(seen.news([site(1, 4)], false).length, 1);
  assert.deepEqual(seen.news([site(3, 9, { status: "withdrawn" })], false), []);
});

test("the operator reads which", () => {
  assert.match(outside_text([{ id: 7, x: 0, y: 0 }]), /^Site 7 is/);
  assert.match(outside_text([{ id: 7, x: 0, y: 0 }, { id: 8, x: 0, y: 0 }]), /^Sites 7, 8 are/);
});
