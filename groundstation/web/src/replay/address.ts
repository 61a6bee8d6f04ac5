// SPDX-License-Identifier: Apache-2.0
// What the address of a replay's page says behind its #: a moment to look at, and of which recording.

export interface Moment {
  seek_s: number;
  /** How the recording is called; null: whichever is there. */
  of: string | null;
}

/** `#seek=12.5&of=coalition-6`; whatever else is there is not of the moment. */
export function moment_in(hash: string): Moment | null {
  const said = new URLSearchParams(hash.replace(/^#/, ""));
  const text = said.get("seek");
  const seek_s = text === null || text === "" ? Number.NaN : Number(text);
  if (!Number.isFinite(seek_s)) return null;
  return { seek_s, of: said.get("of") };
}

/** The token that opens the page, and what is left of the address without it. */
export function token_in(hash: string): { token: string; rest: string } | null {
  const found = /^#([0-9a-f]{32})(?:&(.*))?$/.exec(hash);
  return found ? { token: found[1]!, rest: found[2] ? `#${found[2]}` : "" } : null;
}
