// SPDX-License-Identifier: Apache-2.0
// Beside orders: what they would end besides.

import { areas } from "../wire/store";
import { ends_search_text } from "./progress";

export function EndsSearch({ vehicles }: { vehicles: readonly number[] }) {
  const text = ends_search_text(areas.value?.search ?? null, vehicles);
  return text === "" ? null : (
    <p class="problem warning" data-testid="ends-search">
      {text}
    </p>
  );
}
