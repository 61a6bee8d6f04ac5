// SPDX-License-Identifier: Apache-2.0
// Beside orders: what they would end besides.

import { areas } from "../wire/store";
import { ends_search_text } from "./progress";

/** `null`: orders to all. */
export function EndsSearch({ vehicles }: { vehicles: readonly number[] | null }) {
  const search = areas.value?.search ?? null;
  const text = ends_search_text(search, vehicles ?? search?.shares.map(({ id }) => id) ?? []);
  return text === "" ? null : (
    <p class="problem warning" data-testid="ends-search">
      {text}
    </p>
  );
}
