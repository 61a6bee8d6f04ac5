// SPDX-License-Identifier: Apache-2.0
// Several are selected: one order for all of them.

import { EndsSearch } from "../areas/ends_search";
import { command_to } from "../orders/orders";
import { ids } from "../shell/format";
import { give } from "../shell/give";
import { HoldButton } from "../shell/hold_button";
import { select, selection, vehicles_to_show } from "../shell/view";
import { may_order } from "../wire/store";

export function SelectionBar() {
  const chosen = [...selection.value];
  if (chosen.length < 2) return null;
  const tell = (kind: Parameters<typeof command_to>[0]) => () => void give(command_to(kind, selection.peek()));
  return (
    <section class="selection-bar" aria-label="Selected vehicles" data-testid="selection-bar">
      <header>
        <h2 data-testid="selection-count">{chosen.length} selected</h2>
        <span class="muted selection-ids" title={ids(chosen)}>
          {ids(chosen)}
        </span>
        <span class="grow" />
        <button type="button" class="quiet" data-testid="selection-show" onClick={() => (vehicles_to_show.value = chosen)}>
          Show
        </button>
        <button type="button" class="quiet" aria-label="Select nobody" data-testid="selection-clear" onClick={() => select(null)}>
          ✕
        </button>
      </header>
      {may_order.value && (
        <div class="button-row" role="group" aria-label={`One order to ${chosen.length} vehicles`}>
          <button type="button" class="stop" data-testid="selection-hold" onClick={tell("hold")}>
            Hold {chosen.length}
          </button>
          <HoldButton testid="selection-resume" on_held={tell("resume")}>
            Resume
          </HoldButton>
          <HoldButton testid="selection-return" on_held={tell("return_home")}>
            Return
          </HoldButton>
          <HoldButton testid="selection-land" on_held={tell("land")}>
            Land
          </HoldButton>
        </div>
      )}
      {may_order.value && <EndsSearch vehicles={chosen} />}
    </section>
  );
}
