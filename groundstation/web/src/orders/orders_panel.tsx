// SPDX-License-Identifier: Apache-2.0
import { EndsSearch } from "../areas/ends_search";
import { give, hold_all } from "../shell/give";
import { HoldButton } from "../shell/hold_button";
import { ReturnForm } from "../returns/return_preview";
import { formation, hello, in_replay, is_operator, may_order } from "../wire/store";
import { FormationForm } from "./formation_form";
import { HazardForm } from "./hazard_form";
import { command } from "./orders";
import { SiteForm } from "./site_form";

function ToAll() {
  return (
    <section aria-labelledby="all-title">
      <h2 id="all-title">All vehicles</h2>
      <div class="button-row">
        <button type="button" class="stop" data-testid="orders-hold-all" onClick={hold_all}>
          Hold all
        </button>
        <HoldButton testid="orders-resume-all" on_held={() => void give(command("resume", 0))}>
          Resume all
        </HoldButton>
        <HoldButton testid="orders-return-all" on_held={() => void give(command("return_home", 0))}>
          Return all
        </HoldButton>
        <HoldButton testid="orders-land-all" on_held={() => void give(command("land", 0))}>
          Land all
        </HoldButton>
      </div>
      <EndsSearch vehicles={null} />
      <p class="muted">Orders to one vehicle: select it in the fleet or on the map.</p>
    </section>
  );
}

export function OrdersPanel() {
  if (!may_order.value) {
    const watches = is_operator.value ? "This ground station watches: orders are given where the command is." : "An observer gives no orders.";
    return <p class="empty">{in_replay.value ? "A recording takes no orders." : watches}</p>;
  }
  return (
    <div class="scroll orders" tabIndex={0} role="region" aria-label="Orders">
      <ToAll />
      <ReturnForm />
      {formation.value && (hello.value?.shapes.length ?? 0) > 0 && <FormationForm />}
      {!formation.value && <SiteForm />}
      <HazardForm />
    </div>
  );
}
