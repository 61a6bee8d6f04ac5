// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import type { CommandState } from "../wire/protocol";
import { mark_of, standing } from "./command";

const watching: CommandState = {
  state: "watching", several: true, name: "ridge-2", who: "ridge-1 (ada)", since_s: 0, heard_s: 5, nobody: false, offered: false, unheeding: [], text: "",
};

test("one ground station alone says nothing of the command", () => {
  assert.equal(standing(null), "alone");
  assert.equal(standing({ ...watching, state: "commanding", several: false }), "alone");
});

test("who watches is told who has the command", () => {
  assert.equal(standing(watching), "watching");
  assert.deepEqual(mark_of(watching), { text: "WATCHING (ridge-1 (ada) has the command)", level: "plain" });
  assert.equal(mark_of({ ...watching, who: "" }).text, "WATCHING");
});

test("nobody in command comes before an offer that was made", () => {
  assert.equal(standing({ ...watching, offered: true }), "offered");
  assert.equal(standing({ ...watching, offered: true, nobody: true }), "nobody");
  assert.equal(mark_of({ ...watching, nobody: true }).level, "alarm");
});

test("who is not heeded by all is told before anything else that is well", () => {
  const commanding: CommandState = { ...watching, state: "commanding" };
  assert.equal(standing({ ...commanding, unheeding: [3] }), "unheeded");
  assert.equal(standing({ ...commanding, several: false, unheeding: [3] }), "alone");
  assert.deepEqual(mark_of({ ...commanding, unheeding: [3] }), { text: "in command, not heeded by all", level: "alarm" });
});

test("who was superseded and is not one of several cannot take it back", () => {
  assert.equal(standing({ ...watching, several: false }), "superseded");
  assert.equal(standing({ ...watching, state: "commanding" }), "commanding");
  assert.equal(standing({ ...watching, state: "commanding", offered: true }), "offering");
});
