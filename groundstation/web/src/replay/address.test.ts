// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import test from "node:test";
import { moment_in, token_in } from "./address";

test("a moment is read of the address, and what is none is not", () => {
  assert.deepEqual(moment_in("#seek=12.5"), { seek_s: 12.5, of: null });
  assert.deepEqual(moment_in("#seek=-3&of=coalition%206"), { seek_s: -3, of: "coalition 6" });
  for (const none of ["", "#", "#seek=", "#seek=soon", "#seek=Infinity", "#of=run", `#${"0".repeat(32)}`]) {
    assert.equal(moment_in(none), null, none);
  }
});

test("a token is taken out of the address, and the moment stays", () => {
  const token = "0123456789abcdef".repeat(2);
  assert.deepEqual(token_in(`#${token}`), { token, rest: "" });
  assert.deepEqual(token_in(`#${token}&seek=4&of=a`), { token, rest: "#seek=4&of=a" });
  assert.equal(token_in("#seek=4"), null);
  assert.equal(token_in(`#${token}0`), null);
});
