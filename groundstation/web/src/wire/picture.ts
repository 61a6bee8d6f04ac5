// SPDX-License-Identifier: Apache-2.0
// What the page knows, as a pure reduction of what the server has said.

import type { FromServer, Hello, MissionEvent, Sections } from "./protocol";

export interface Picture extends Sections {
  hello: Hello | null;
  /** Mission time of the newest state; null before the first. */
  time_s: number | null;
  /** Ascending by seq, none twice. In a mission the newest, and older warnings. */
  events: MissionEvent[];
  /** The first event that the page has not seen. */
  next_seq: number;
  /** Events that are only in the recording: the server no longer had them when the page asked, or the page
   *  has not kept them. */
  events_missed: number;
  /** Where a coalition stands in the palette: by its key, in the order of appearance. */
  coalition_slots: ReadonlyMap<string, number>;
  /** The ground station's last word, until it is there again. */
  ended: { time_s: number; text: string } | null;
  /** Grows when what the page holds belongs to another run: the server must be asked from event 0. */
  generation: number;
}

// As many as the server has.
const most_events = 20000;
/** Of a mission, whatever they say: lest memory grow for as long as it lasts. Of older ones warnings alone
 *  are kept. A recording has an end, and is read from wherever one likes: of it all are kept. */
export const newest_events = 1000;

export const section_names = [
  "vehicles",
  "plans",
  "sites",
  "coalitions",
  "authorisations",
  "hazards",
  "formation",
  "timeline",
  "audit",
  "replay",
  "proposals",
  "preflight",
  "fence",
  "links",
  "wind",
  "areas",
  "alarms",
  "traffic",
  "command",
  "team",
] as const satisfies readonly (keyof Sections)[];

export function empty_picture(): Picture {
  return {
    hello: null,
    time_s: null,
    vehicles: [],
    plans: [],
    sites: [],
    coalitions: [],
    authorisations: [],
    hazards: [],
    formation: null,
    timeline: { states: [], vehicles: [] },
    audit: [],
    replay: null,
    proposals: [],
    preflight: null,
    fence: null,
    links: [],
    wind: null,
    areas: null,
    alarms: null,
    traffic: [],
    command: null,
    team: [],
    events: [],
    next_seq: 0,
    events_missed: 0,
    coalition_slots: new Map(),
    ended: null,
    generation: 0,
  };
}

/** The picture after `message`. What has not changed is the same object as before. */
export function reduce(picture: Picture, message: FromServer): Picture {
  switch (message.type) {
    case "hello":
      return on_hello(picture, message);
    case "history":
      return on_history(picture, message.events);
    case "state":
      return on_state(picture, message);
    case "events":
      return on_events(picture, message.events);
    case "ended":
      return { ...picture, ended: { time_s: message.time_s, text: message.text } };
    default:
      return picture;
  }
}

function forget(picture: Picture, hello: Hello | null): Picture {
  return { ...empty_picture(), hello, generation: picture.generation + 1 };
}

function on_hello(picture: Picture, hello: Hello): Picture {
  const other_run = picture.hello !== null && picture.hello.run !== hello.run;
  return other_run ? forget(picture, hello) : { ...picture, hello, ended: null };
}

function on_history(picture: Picture, events: { first_seq: number; next_seq: number }): Picture {
  if (picture.next_seq > events.next_seq) {
    // A recording that was wound back; any other server with fewer events than we have seen has
    // started anew.
    return picture.hello?.replay ? wound_back(picture, events.next_seq) : forget(picture, picture.hello);
  }
  const missed = Math.max(0, events.first_seq - Math.max(picture.next_seq, 1));
  if (missed === 0 || picture.next_seq === 0) return picture;
  return { ...picture, events_missed: picture.events_missed + missed };
}

function wound_back(picture: Picture, next_seq: number): Picture {
  return { ...picture, events: picture.events.filter((event) => event.seq < next_seq), next_seq };
}

function on_state(picture: Picture, state: { time_s: number } & Partial<Sections>): Picture {
  const next: Picture = { ...picture, time_s: state.time_s };
  const into = next as unknown as Record<string, unknown>;
  for (const name of section_names) {
    if (state[name] !== undefined) into[name] = state[name];
  }
  if (state.coalitions) next.coalition_slots = with_slots(picture.coalition_slots, next.coalitions);
  return next;
}

function with_slots(slots: ReadonlyMap<string, number>, coalitions: { key: string }[]) {
  const unknown = coalitions.filter((coalition) => !slots.has(coalition.key));
  if (unknown.length === 0) return slots;
  const next = new Map(slots);
  for (const { key } of unknown) next.set(key, next.size);
  return next;
}

function on_events(picture: Picture, arrived: MissionEvent[]): Picture {
  const fresh: MissionEvent[] = [];
  let next_seq = picture.next_seq;
  for (const event of arrived) {
    if (event.seq < next_seq) continue;
    fresh.push(event);
    next_seq = event.seq + 1;
  }
  if (fresh.length === 0) return picture;
  const all = picture.events.concat(fresh);
  const events = kept(all, Boolean(picture.hello?.replay));
  return { ...picture, events, next_seq, events_missed: picture.events_missed + all.length - events.length };
}

function kept(events: MissionEvent[], all: boolean): MissionEvent[] {
  if (all || events.length <= newest_events) return events.slice(-most_events);
  const warnings = events.slice(0, -newest_events).filter(({ level }) => level === "warning");
  return [...warnings, ...events.slice(-newest_events)].slice(-most_events);
}
