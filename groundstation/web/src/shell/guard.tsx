// SPDX-License-Identifier: Apache-2.0
import type { ComponentChildren } from "preact";
import { useErrorBoundary } from "preact/hooks";

/** Keeps a fault in one part of the page from taking the others with it, `HOLD ALL` above all. */
export function Guard({ what, children }: { what: string; children: ComponentChildren }) {
  const [error, again] = useErrorBoundary((fault: unknown) => console.error(what, fault));
  if (!error) return <>{children}</>;
  return (
    <div class="empty" role="alert">
      <p class="problem alarm">
        {what} has failed: {String(error)}
      </p>
      <button type="button" onClick={again}>
        Try again
      </button>
    </div>
  );
}
