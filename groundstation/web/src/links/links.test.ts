// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import test from "node:test";
import type { Link, LinkRow } from "../wire/protocol";
import { sentence_of, sign_of, sorted_links, summary_of, through_others, tone_of } from "./links";

const a_link = (id: number, other: Partial<Link> = {}): Link => ({ id, age_s: 0.2, per_s: 9.5, lost_percent: 2, bytes_per_s: null, through_others: false, ...other });
const a_row = (id: number, hears: Link[], told_age_s: number | null = 0.5): LinkRow => ({ id, told_age_s, tells_loss: true, hears });

test("a link is worth what is lost of it, and nothing when it is old", () => {
  assert.equal(tone_of(a_link(1)), "good");
  assert.equal(tone_of(a_link(1, { lost_percent: 6 })), "some");
  assert.equal(tone_of(a_link(1, { lost_percent: 26 })), "bad");
  assert.equal(tone_of(a_link(1, { lost_percent: 100, per_s: 0, through_others: true })), "through");
  assert.equal(tone_of(a_link(1, { lost_percent: null, per_s: null })), "heard");
  assert.equal(tone_of(a_link(1, { age_s: 5, lost_percent: 0 })), "old");
  assert.equal(sign_of(a_link(1, { lost_percent: 7 })), "7");
  assert.equal(sign_of(a_link(1, { lost_percent: null })), "·");
});

test("the worst links come first", () => {
  const rows = [a_row(0, [a_link(1), a_link(2, { age_s: 30 })]), a_row(1, [a_link(0, { lost_percent: 12 }), a_link(2, { lost_percent: 40 })])];
  assert.deepEqual(
    sorted_links(rows).map(({ row, link }) => [row.id, link.id]),
    [[0, 2], [1, 2], [1, 0], [0, 1]],
  );
  assert.equal(summary_of(rows), "1 good, 1 lossy, 1 bad, 1 silent");
});

test("what is known is said whole, and what is not is said so", () => {
  const row = a_row(3, [a_link(0)], 8);
  assert.equal(sentence_of(row, 0, row.hears[0]!), "vehicle 3 hears ground station: 2 % lost, 9.5 a second, 0.2 s ago; it told that 8.0 s ago");
  assert.equal(sentence_of(row, 4, null), "vehicle 3 does not hear vehicle 4; it told that 8.0 s ago");
  assert.equal(sentence_of(a_row(3, [], null), 4, null), "vehicle 3 has not told whom it hears");
  const old = a_link(2, { lost_percent: null, per_s: null });
  assert.equal(sentence_of(a_row(1, [old]), 2, old), "vehicle 1 hears vehicle 2: loss is not told, 0.2 s ago");
});

test("who is reached through others alone is found", () => {
  const far = a_link(5, { through_others: true, lost_percent: 100, per_s: 0 });
  assert.deepEqual(through_others([a_row(0, [a_link(1), far]), a_row(1, [a_link(4, { through_others: true })])]), [5]);
  assert.deepEqual(through_others([]), []);
});
