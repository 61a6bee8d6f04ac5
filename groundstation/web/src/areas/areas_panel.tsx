// SPDX-License-Identifier: Apache-2.0
// What is drawn on the map: search areas, hazards of any outline, and the fence.

import { useEffect } from "preact/hooks";
import { in_replay, may_order } from "../wire/store";
import { tool } from "../shell/view";
import { FencePart } from "./fence_part";
import { HazardPart } from "./hazard_part";
import { OutlineEditor } from "./outline_editor";
import { outline, outline_use } from "./outline";
import type { Use } from "./outline";
import { SearchPart } from "./search_part";

const uses: [Use, string][] = [
  ["search", "Search area"],
  ["hazard", "Hazard"],
  ["fence", "Fence"],
];

export function AreasPanel() {
  useEffect(
    () => () => {
      if (tool.value === "outline") tool.value = "select";
      outline.value = [];
    },
    [],
  );
  const use = outline_use.value;
  return (
    <div class="scroll orders areas" tabIndex={0} role="region" aria-label="Areas">
      {may_order.value ? (
        <>
          <fieldset class="choice">
            <legend>Draw</legend>
            {uses.map(([name, words]) => (
              <label key={name}>
                <input type="radio" name="outline-use" checked={use === name} data-testid={`outline-use-${name}`} onChange={() => (outline_use.value = name)} /> {words}
              </label>
            ))}
          </fieldset>
          <OutlineEditor />
        </>
      ) : (
        <p class="empty">{in_replay.value ? "A recording takes no orders." : "An observer draws nothing."}</p>
      )}
      {use === "search" && <SearchPart />}
      {use === "hazard" && <HazardPart />}
      {use === "fence" && <FencePart />}
    </div>
  );
}
