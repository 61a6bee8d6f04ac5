// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { empty_picture } from "../wire/picture";
import { a_vehicle } from "../wire/samples";
import { count_alarms, fresh_alarms } from "./alarms";

const silent = (age: number) => a_vehicle(7, { silent: true, heard_age_s: age, problems: [{ level: "alarm", text: `silent for ${age.toFixed(1)} s` }] });
const picture = (...vehicles: ReturnType<typeof a_vehicle>[]) => ({ ...empty_picture(), vehicles });

test("an alarm is said once, not at each of its figures", () => {
  assert.deepEqual(fresh_alarms(picture(a_vehicle(7)), picture(silent(3))), ["Vehicle 7: silent for 3.0 s"]);
  assert.deepEqual(fresh_alarms(picture(silent(3)), picture(silent(4.5))), []);
  assert.deepEqual(fresh_alarms(picture(silent(3)), picture(a_vehicle(7))), []);
});

test("counts", () => {
  const never = a_vehicle(3, { heard_age_s: null, x: null, y: null });
  assert.deepEqual(count_alarms(picture(a_vehicle(1), silent(4), never)), {
    alarms: 1, warnings: 0, heard: 1, expected: 3, waiting: 0,
  });
});
