// SPDX-License-Identifier: Apache-2.0
// The outline by its corners: drawn on the map, typed, or from a file.

import { useState } from "preact/hooks";
import { LocalFrame } from "../map/geodesy";
import { number } from "../shell/format";
import { tool } from "../shell/view";
import { hello } from "../wire/store";
import { area_m2, corners_max, move_corner, outline, outline_of_file, remove_corner, typed_corners, why_no_outline } from "./outline";

const file_max_bytes = 1_000_000;

export function OutlineEditor() {
  const [typed, set_typed] = useState("");
  const [trouble, set_trouble] = useState<string | null>(null);
  const corners = outline.value;
  const drawing = tool.value === "outline";
  const take = (read: ReturnType<typeof typed_corners>) => {
    if ("trouble" in read) return set_trouble(read.trouble);
    set_trouble(null);
    outline.value = read.corners;
  };
  const import_file = async (file: File | undefined) => {
    const greeting = hello.value;
    if (!file || !greeting) return;
    if (file.size > file_max_bytes) return set_trouble("that file is larger than 1 MB");
    take(outline_of_file(await file.text(), new LocalFrame(greeting.origin)));
  };
  const coordinate = (index: number, axis: 0 | 1) => (
    <input
      type="number"
      step="1"
      value={corners[index]![axis]}
      aria-label={`Corner ${index + 1}, ${axis === 0 ? "east" : "north"}, metres`}
      data-testid={`corner-${index + 1}-${axis === 0 ? "east" : "north"}`}
      onChange={(event) => {
        const value = event.currentTarget.valueAsNumber;
        if (!Number.isFinite(value)) return;
        const [east, north] = corners[index]!;
        outline.value = move_corner(corners, index, axis === 0 ? value : east, axis === 1 ? value : north);
      }}
    />
  );
  const wrong = corners.length > 0 ? why_no_outline(corners) : null;
  return (
    <section aria-labelledby="outline-title" data-testid="outline">
      <h2 id="outline-title">Outline</h2>
      <div class="button-row">
        <button type="button" data-testid="outline-draw" aria-pressed={drawing} onClick={() => (tool.value = drawing ? "select" : "outline")}>
          {drawing ? "Done drawing" : "Draw on the map …"}
        </button>
        <button type="button" data-testid="outline-undo" disabled={corners.length === 0} onClick={() => (outline.value = corners.slice(0, -1))}>
          Undo corner
        </button>
        <button type="button" data-testid="outline-clear" disabled={corners.length === 0} onClick={() => (outline.value = [])}>
          Clear
        </button>
        <label class="file-pick">
          From a file
          <input
            type="file"
            accept=".json,.geojson,.plan,application/geo+json,application/json"
            data-testid="outline-file"
            onChange={(event) => {
              const input = event.currentTarget;
              void import_file(input.files?.[0]).then(() => (input.value = ""));
            }}
          />
        </label>
      </div>
      {corners.length > 0 && (
        <ol class="corner-list" tabIndex={0} aria-label="Corners">
          {corners.map((_, index) => (
            <li key={index}>
              <span>{index + 1}</span> E {coordinate(index, 0)} N {coordinate(index, 1)}
              <button type="button" data-testid={`corner-${index + 1}-delete`} aria-label={`Delete corner ${index + 1}`} onClick={() => (outline.value = remove_corner(corners, index))}>
                ✕
              </button>
            </li>
          ))}
        </ol>
      )}
      <label>
        Or type its corners, EAST,NORTH in metres
        <textarea rows={2} value={typed} placeholder="0,0 800,0 800,600 0,600" data-testid="outline-typed" onInput={(event) => set_typed(event.currentTarget.value)} />
      </label>
      <div class="button-row">
        <button type="button" data-testid="outline-take" disabled={typed.trim() === ""} onClick={() => take(typed_corners(typed))}>
          Take these corners
        </button>
      </div>
      {trouble && (
        <p class="problem alarm" role="alert" data-testid="outline-trouble">
          {trouble}
        </p>
      )}
      <p class="muted" role="status" data-testid="outline-state">
        {wrong ?? (corners.length > 0 ? `${corners.length} of at most ${corners_max} corners, ${number(area_m2(corners) / 1e6, 2)} km²` : "nothing is drawn")}
      </p>
    </section>
  );
}
