// SPDX-License-Identifier: Apache-2.0
// To authorise a plan: held for a second; where one that it names is silent only by a second step,
// which says so.

import { useState } from "preact/hooks";
import { give } from "../shell/give";
import { HoldButton } from "../shell/hold_button";
import type { Authorisation } from "../wire/protocol";
import { silence_text } from "./requests";

export function Authorise({ request }: { request: Authorisation }) {
  const { site, coalition, round } = request;
  const silence = silence_text(request);
  // What was looked at: another silence is another step.
  const [passed_over, set_passed_over] = useState("");
  const order = { kind: "decision", site, coalition, round, grant: true } as const;
  if (silence === "") {
    return (
      <HoldButton kind="go" testid={`authorise-${site}`} on_held={() => void give(order)}>
        Authorise
      </HoldButton>
    );
  }
  if (passed_over !== silence) {
    return (
      <button type="button" class="tall" data-testid={`authorise-silent-${site}`} onClick={() => set_passed_over(silence)}>
        Authorise? {silence}
      </button>
    );
  }
  return (
    <HoldButton kind="go" testid={`override-${site}`} on_held={() => void give({ ...order, override: true })}>
      Authorise although {silence}
    </HoldButton>
  );
}
