// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { empty_picture } from "../wire/picture";
import { a_vehicle, an_alarm, some_alarms } from "../wire/samples";
import { count_alarms, fresh_alarms } from "./alarms";

const picture = (...list: ReturnType<typeof an_alarm>[]) => ({ ...empty_picture(), alarms: some_alarms(list) });

test("an alarm is said once, with what to do", () => {
  const silent = an_alarm(3);
  assert.deepEqual(fresh_alarms(picture(), picture(silent)), ["vehicle 7 is silent. look for it"]);
  assert.deepEqual(fresh_alarms(picture(silent), picture({ ...silent, acknowledged: { by: "ada", at_s: 9 } })), []);
  assert.deepEqual(fresh_alarms(picture(silent), picture()), []);
  assert.equal(fresh_alarms(picture(silent), picture(an_alarm(4))).length, 1, "what is back is said again");
});

test("counts", () => {
  const never = a_vehicle(3, { heard_age_s: null, x: null, y: null });
  const silent = a_vehicle(4, { silent: true });
  const counted = { ...picture(an_alarm(1), an_alarm(2, { level: "warning" })), vehicles: [a_vehicle(1), silent, never] };
  assert.deepEqual(count_alarms(counted), { alarms: 1, warnings: 1, heard: 1, expected: 3, waiting: 0 });
});
