// SPDX-License-Identifier: Apache-2.0
import { signal } from "@preact/signals";

/** A signal that changes four times a second: for ages and countdowns between states. */
export const tick = signal(0);
window.setInterval(() => tick.value++, 250);
