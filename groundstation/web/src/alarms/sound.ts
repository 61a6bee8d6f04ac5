// SPDX-License-Identifier: Apache-2.0
// Alarms that can be heard: tones that the page makes itself, two patterns that cannot be taken for
// each other, again and again until nobody needs them.

import type { SoundLevel } from "./alarm_list";

interface Tone {
  hz: number;
  at_s: number;
  for_s: number;
}
export interface Pattern {
  tones: Tone[];
  every_ms: number;
}

export const patterns: Record<"alarm" | "warning", Pattern> = {
  alarm: {
    tones: [
      { hz: 988, at_s: 0, for_s: 0.14 },
      { hz: 740, at_s: 0.18, for_s: 0.14 },
      { hz: 988, at_s: 0.36, for_s: 0.14 },
      { hz: 740, at_s: 0.54, for_s: 0.14 },
    ],
    every_ms: 1500,
  },
  warning: { tones: [{ hz: 523, at_s: 0, for_s: 0.35 }], every_ms: 4000 },
};

/** Longer nobody may be deaf. */
export const mute_ms = 10 * 60_000;

/** How long sound is off yet, ms; whatever was stored, never more than `mute_ms`. */
export function muted_for(until_ms: number | null, now_ms: number): number {
  if (until_ms === null || !Number.isFinite(until_ms)) return 0;
  const left = until_ms - now_ms;
  return left > 0 && left <= mute_ms ? left : 0;
}

export const least_volume = 0.1;
export const volume_in_range = (value: number): number => (Number.isFinite(value) ? Math.min(1, Math.max(least_volume, value)) : 0.6);

/** What of WebAudio is used. */
type Context = Pick<AudioContext, "currentTime" | "state" | "resume" | "destination" | "createGain" | "createOscillator">;

export class AlarmSound {
  private context: Context | null = null;
  private level: SoundLevel = null;
  private timer = 0;
  volume = 0.6;
  /** How often a pattern was begun. */
  bursts = 0;

  constructor(
    private readonly make: () => Context,
    private readonly on_change: () => void,
  ) {}

  /** Browsers let nothing be heard before a person has touched the page. */
  get allowed(): boolean {
    return this.context?.state === "running";
  }
  /** What is heard now. */
  get sounding(): SoundLevel {
    return this.allowed ? this.level : null;
  }

  /** On a gesture. */
  async allow(): Promise<void> {
    this.context ??= this.make();
    if (this.context.state !== "running") await this.context.resume().catch(() => undefined);
    this.on_change();
  }

  play(level: SoundLevel): void {
    if (level === this.level) return;
    this.level = level;
    window.clearInterval(this.timer);
    this.timer = 0;
    if (level !== null) {
      this.burst();
      this.timer = window.setInterval(() => this.burst(), patterns[level].every_ms);
    }
    this.on_change();
  }

  private burst(): void {
    const context = this.context;
    if (!context || !this.allowed || this.level === null) return;
    this.bursts++;
    for (const { hz, at_s, for_s } of patterns[this.level].tones) {
      const from = context.currentTime + at_s;
      const gain = context.createGain();
      // Ramps, since an edge clicks.
      gain.gain.setValueAtTime(0, from);
      gain.gain.linearRampToValueAtTime(this.volume, from + 0.01);
      gain.gain.setValueAtTime(this.volume, from + for_s - 0.02);
      gain.gain.linearRampToValueAtTime(0, from + for_s);
      gain.connect(context.destination);
      const tone = context.createOscillator();
      tone.type = "triangle";
      tone.frequency.value = hz;
      tone.connect(gain);
      tone.start(from);
      tone.stop(from + for_s);
    }
    this.on_change();
  }
}
