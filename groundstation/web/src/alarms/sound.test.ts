// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { AlarmSound, mute_ms, muted_for, patterns, volume_in_range } from "./sound";

test("nobody is deaf for more than ten minutes", () => {
  assert.equal(muted_for(null, 1000), 0);
  assert.equal(muted_for(900, 1000), 0);
  assert.equal(muted_for(1000 + mute_ms, 1000), mute_ms);
  assert.equal(muted_for(1001 + mute_ms, 1000), 0, "a longer one was not made here");
  assert.equal(muted_for(Number.NaN, 1000), 0);
  assert.equal(mute_ms, 600_000);
});

test("a volume can be low, and never nothing", () => {
  assert.equal(volume_in_range(0), 0.1);
  assert.equal(volume_in_range(2), 1);
  assert.equal(volume_in_range(Number.NaN), 0.6);
});

test("two patterns that cannot be taken for each other", () => {
  const { alarm, warning } = patterns;
  assert.ok(alarm.tones.length > warning.tones.length && alarm.every_ms < warning.every_ms);
  for (const pattern of [alarm, warning]) assert.ok(pattern.tones.every(({ at_s, for_s }) => (at_s + for_s) * 1000 < pattern.every_ms));
});

function a_context() {
  const begun: number[] = [];
  const gain = { gain: { setValueAtTime() {}, linearRampToValueAtTime() {} }, connect() {} };
  const context = {
    currentTime: 0, state: "suspended", destination: {},
    async resume() { this.state = "running"; },
    createGain: () => gain,
    createOscillator: () => ({ type: "", frequency: { value: 0 }, connect() {}, stop() {}, start() { begun.push(this.frequency.value); } }),
  };
  return { begun, context: context as unknown as AudioContext };
}

test("it is heard again and again until nobody needs it, and only where the browser lets it", async () => {
  let tick = (): void => undefined;
  let every_ms = 0;
  const window = { setInterval: (again: () => void, ms: number) => ((tick = again), (every_ms = ms), 1), clearInterval: () => (tick = () => undefined) };
  globalThis.window = window as unknown as Window & typeof globalThis;
  const { begun, context } = a_context();
  const sound = new AlarmSound(() => context, () => undefined);
  sound.play("alarm");
  assert.equal(sound.sounding, null, "nobody has touched the page yet");
  await sound.allow();
  assert.equal(sound.sounding, "alarm");
  assert.equal(every_ms, patterns.alarm.every_ms);
  for (let i = 0; i < 3; i++) tick();
  assert.equal(sound.bursts, 3);
  assert.equal(begun.length, 3 * patterns.alarm.tones.length);
  sound.play("warning");
  assert.equal(begun.at(-1), patterns.warning.tones[0]!.hz);
  sound.play(null);
  const { bursts } = sound;
  tick();
  assert.equal(sound.bursts, bursts);
  assert.equal(sound.sounding, null);
});
