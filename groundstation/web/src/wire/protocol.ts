// SPDX-License-Identifier: Apache-2.0
// What skein-ground and the page say to each other (docs/console-socket.md). Positions are metres
// east, north and up of the origin, directions compass degrees, times mission seconds.

import type { Activity, EventKind, IncidentKind, TaskKind } from "./messages";

export type Level = "info" | "warning";
export type Role = "operator" | "observer";

export interface Origin {
  latitude_deg: number;
  longitude_deg: number;
  height_m: number;
}

export interface Tiles {
  url: string;
  min_zoom: number;
  max_zoom: number;
  attribution: string;
}

/** Where a vehicle's pictures are: for people to open. */
export interface Video {
  vehicle: number;
  url: string;
}

export type Limit = [low: number, high: number];

/** Between which figures the ground station takes orders. */
export interface Limits {
  coordinate_m: Limit;
  hazard_radius_m: Limit;
  fence_height_m: Limit;
  spacing_m: Limit;
  heading_deg: Limit;
  places: Limit;
  tasks: Limit;
  interval_s: Limit;
  dwell_s: Limit;
  reward: Limit;
}

export interface Hello {
  type: "hello";
  program: string;
  run?: string;
  role: Role;
  user: string;
  origin: Origin;
  /** Mission time 0; null in a replay. */
  epoch_unix_s: number | null;
  expected: number[];
  shapes: string[];
  site_templates: string[];
  limits: Limits;
  /** Whether the mission network is sealed; null in a replay. */
  sealed: boolean | null;
  replay: { name: string; from_s: number; to_s: number } | null;
  tiles: Tiles | null;
  overlays: { name: string; url: string }[];
  /** Named groups of vehicles of the configuration; none of an older server. */
  groups?: { name: string; vehicles: number[] }[];
  /** Where vehicles' pictures are; none of an older server. */
  videos?: Video[];
}

export interface Series {
  id: number;
  t: number[];
  x: number[];
  y: number[];
  z: number[];
  speed: number[];
  range: number[];
  delay: (number | null)[];
}

export interface History {
  type: "history";
  series: Series[];
  events: { first_seq: number; next_seq: number };
}

export interface Problem {
  level: "alarm" | "warning";
  text: string;
}

export interface VehicleTask {
  site: number;
  kind: TaskKind;
  index: number;
  time_s: number | null;
  state: string;
}

export interface Vehicle {
  id: number;
  expected: boolean;
  silent: boolean;
  duplicate: boolean;
  /** Put out of the mission: nobody hears it any more. */
  revoked: boolean;
  x: number | null;
  y: number | null;
  z: number | null;
  heading_deg: number | null;
  course_deg: number | null;
  groundspeed: number | null;
  airspeed: number | null;
  activity: Activity | null;
  /** What a person reads of it: its activity told apart, or `silent`. */
  state: string | null;
  /** What it does besides that state, in the same words. */
  besides: string | null;
  task: VehicleTask | null;
  heard_age_s: number | null;
  clock_offset_ms: number | null;
  range_left_m: number | null;
  loads: number | null;
  plan_number: number | null;
  version: string | null;
  flight_controller: string | null;
  mode: string | null;
  problems: Problem[];
  links: { id: number; age_s: number }[];
  control_overruns: number | null;
  messages_dropped: number | null;
  /** Of a picture that no news comes for: all of it is as it was then (aged.ts). */
  stale?: boolean;
}

export interface Plan {
  id: number;
  number: number;
  start_s: number;
  end_s: number;
  points: [x: number, y: number, t_s: number][];
  hold: [x: number, y: number][];
}

export interface SiteTask {
  kind: TaskKind;
  index: number;
  bearing_deg: number | null;
  vehicle: number | null;
  time_s: number | null;
  state: string;
}

export interface Site {
  id: number;
  x: number | null;
  y: number | null;
  leader: number | null;
  /** The vehicle that was told of it. */
  surveyor: number | null;
  reward: number | null;
  status: string;
  tasks: SiteTask[];
  news: string | null;
}

export interface Round {
  number: number;
  announced_s: number | null;
  bids_until_s: number | null;
  reward: number | null;
  tasks: string[];
  bids: { vehicle: number; eta_s: number | null; range_left_m: number | null; loads: number | null }[];
  declined: { vehicle: number; why: string }[];
  award: { vehicle: number; task: string; time_s: number | null }[];
  answers: { vehicle: number; accepted: boolean; why: string | null }[];
  cancelled: string | null;
}

export interface Coalition {
  key: string;
  leader: number;
  number: number;
  site: number;
  state: "announced" | "awarded" | "formed" | "failed" | "closed";
  why: string | null;
  members: number[];
  rounds: Round[];
  lease_until_s: number | null;
}

export interface Delivery {
  vehicle: number;
  index: number;
  time_s: number;
  bearing_deg: number;
  /** Granted, and not begun as far as is known: it can be taken back. */
  before_gate: boolean;
  /** What speaks against it: its vehicle is silent, late, low on range. */
  marks: Problem[];
}

export interface Authorisation {
  site: number;
  leader: number;
  coalition: string;
  round: number;
  x: number;
  y: number;
  latitude_deg: number;
  longitude_deg: number;
  asked_s: number;
  decide_by_s: number;
  waiting: boolean;
  decision: { granted: boolean; taken_back: boolean; by: string; at_s: number } | null;
  /** Some of what was granted. */
  can_take_back: boolean;
  deliveries: Delivery[];
  /** Of those that it names: it is authorised only by who passes over their silence. */
  silent: number[];
  leader_marks: Problem[];
  /** What the site wants besides, and why it is not in the plan. */
  missing: { index: number; bearing_deg: number; why: string }[];
  did_not_bid: { vehicle: number; why: string }[];
  /** Since the request before this one. */
  changes: string[];
}

export interface Hazard {
  id: number;
  x: number;
  y: number;
  radius_m: number;
}

export interface Mover {
  id: number;
  points: [x: number, y: number, z: number][];
}

export interface Place {
  id: number;
  x: number;
  y: number;
  z: number;
  reference: [x: number, y: number, z: number] | null;
  off_m: number | null;
  change: number;
  at_rest: boolean;
  lost: boolean;
}

export interface Formation {
  in_place: boolean;
  moving: boolean;
  change: { number: number; start_s: number; end_s: number; movers: Mover[] } | null;
  places: Place[];
}

/** What each vehicle did. */
export interface Timeline {
  /** Those that there are. */
  states: string[];
  vehicles: TimelineRow[];
}

/** Of a vehicle, in columns of one length: each state until the next one begins. */
export interface TimelineRow {
  id: number;
  /** Places in the time line's `states`. */
  states: number[];
  from_s: number[];
  sites: (number | null)[];
}

export interface AuditEntry {
  seq: number;
  time_s: number;
  who: string;
  from: string;
  line: string;
  done: boolean;
  in_part?: boolean; // done for some of whom it was for
  text: string;
}

export interface ReplayState {
  time_s: number;
  playing: boolean;
  speed: number;
}

/** Sections of a state; each is only there when it has changed. */
export interface Sections {
  vehicles: Vehicle[];
  plans: Plan[];
  sites: Site[];
  coalitions: Coalition[];
  authorisations: Authorisation[];
  hazards: Hazard[];
  formation: Formation | null;
  timeline: Timeline;
  audit: AuditEntry[];
  replay: ReplayState | null;
  proposals: Proposal[];
  preflight: Preflight | null;
  fence: Fence | null;
  links: LinkRow[];
  wind: Wind | null;
  areas: Areas | null;
  alarms: Alarms | null;
  traffic: TrafficAircraft[];
  command: CommandState | null;
  team: TeamRow[];
}

/** Where all vehicles are to stay. */
export interface Fence {
  /** Of the operator; null: it is that of the configuration. */
  order: number | null;
  corners: [x: number, y: number][];
  height_m: number;
  /** What vehicles do at its edge, for people. */
  action: string;
  keepers: { id: number; keeps: "this" | "another" | "none" | "not_known" }[];
}

/** How somebody hears another, over ten seconds. */
export interface Link {
  /** Whom; 0: the ground station. */
  id: number;
  /** Since its newest word, on whatever way that came. */
  age_s: number;
  /** Datagrams that come of it itself; null: not told. */
  per_s: number | null;
  lost_percent: number | null;
  bytes_per_s: number | null;
  /** Nothing comes of it itself: others pass on what it says. */
  through_others: boolean;
}

export interface LinkRow {
  id: number;
  told_age_s: number | null;
  tells_loss: boolean;
  hears: Link[];
}

export interface WindFigures {
  /** From where it blows; null: it is calm. */
  from_deg: number | null;
  speed_mps: number;
  gust_mps: number;
  age_s: number;
}

/** As the planes that fly tell it together. */
export interface Wind extends WindFigures {
  spread_mps: number;
  vehicles: (WindFigures & { id: number })[];
}

export type Corners = [east: number, north: number][];

/** One vehicle's share of a search area. */
export interface SearchShare {
  id: number;
  state: "waits" | "flies" | "done" | "left";
  /** It has left. */
  why: string;
  lanes: number;
  /** By its route, as are the metres of lanes. */
  lanes_left: number;
  left_m: number;
  /** When it will have flown all of it, as far as is known. */
  done_s: number | null;
  length_m: number;
  time_s: number;
  /** The lanes that it has not flown. */
  ways: [from_x: number, from_y: number, to_x: number, to_y: number][];
  /** Of the route that it has. */
  points: Corners;
}

export interface SearchArea {
  kind?: "search";
  state: "previewed" | "flown" | "over" | "called_off";
  why: string;
  area_m2: number;
  /** When all that is flown will be; null: nobody flies. */
  expected_s: number | null;
  corners: Corners;
  sensor_radius_m: number;
  spacing_m: number;
  /** Shares of the area: of what is covered when all is flown, and of what was seen. */
  planned: number;
  seen?: number;
  /** By all together without any turn. */
  least_s: number;
  begins_s: number;
  ends_s: number;
  /** Routes that each flies one after another. */
  parts: number;
  shares: SearchShare[];
  without: { id: number; why: string }[];
  /** Something is left that nobody flies. */
  rest?: boolean;
}

/** A hazard that is not one circle for good. */
export interface AreaHazard {
  hazard: number;
  /** Of a polygon; none: a circle. */
  corners: Corners;
  x: number;
  y: number;
  radius_m: number;
  /** What its circles shut out besides, as a share of the polygon. */
  more: number;
  circles: number[];
}

export interface Areas {
  search: SearchArea | null;
  hazards: AreaHazard[];
}

export type AlarmLevel = "alarm" | "warning" | "notice";

/** What may not be overlooked. */
export interface Alarm {
  /** Its own: what comes back, or has become worse, has another one. */
  number: number;
  /** Which it is, whatever its figures. */
  key: string;
  kind: string;
  level: AlarmLevel;
  since_s: number;
  /** It is not so any more, and nobody has acknowledged it. */
  over_s: number | null;
  what: string;
  remedy: string;
  /** When two that come too near to each other are closest; null of all else. */
  closest_s: number | null;
  times: number;
  vehicle: number | null;
  /** Of two vehicles. */
  other: number | null;
  site: number | null;
  /** Where one acts: a panel, or `decisions`. */
  panel: string;
  /** Orders that may help, to its vehicle or to all. */
  offers: Command["command"][];
  acknowledged: { by: string; at_s: number } | null;
}

/** An order, and who has shown since that he obeys. */
export interface GivenOrder {
  /** A command, `authorise` or `refuse`. */
  kind: string;
  line: string;
  /** None: all; null of a decision. */
  vehicles: number[] | null;
  site: number | null;
  given_s: number;
  answered: { vehicle: number; after_s: number }[];
  waiting: number[];
}

export interface Alarms {
  counts: { alarm: number; warning: number; notice: number; unacknowledged: number };
  /** The worst first of those that are not acknowledged; then those that are, then what is over. */
  list: Alarm[];
  /** Oldest first. */
  orders: GivenOrder[];
}

/** An aircraft that is not of the team, where it is now; the nearest first. */
export interface TrafficAircraft {
  /** Of ICAO, six hexadecimal digits. */
  address: string;
  /** Empty: not told. */
  callsign: string;
  x: number;
  y: number;
  z: number;
  track_deg: number;
  speed_mps: number;
  climb_mps: number;
  /** Since its place was heard. */
  age_s: number;
  /** Its height is from pressure. */
  barometric: boolean;
  on_ground: boolean;
  /** Vehicles that are too near to it, and whether they give way. */
  warned: { vehicle: number; gives_way: boolean }[];
  nearest: {
    vehicle: number;
    distance_m: number;
    above_m: number;
    /** To the side, if both fly straight on. */
    closest_m: number;
    closest_in_s: number;
  } | null;
}

/** Which ground station has the command. */
export interface CommandState {
  state: "listening" | "watching" | "commanding";
  /** There are others, to which it can be handed, or from which it can be taken. */
  several: boolean;
  name: string;
  /** Who has it, or had it last; empty: not known. */
  who: string;
  since_s: number;
  heard_s: number | null;
  /** Who had it has not been heard for 10 s. */
  nobody: boolean;
  /** Who has it asks others to take it. */
  offered: boolean;
  /** Vehicles that are heard, and do not heed this one that has the command. */
  unheeding: number[];
  text: string;
}

/** The team's state as a whole; the first row is it. */
export interface TeamRow {
  state: string;
  level: "alarm" | "warning" | "info";
  title: string;
  means: string;
  to_do: string;
  vehicles: number[];
}

export type Readiness = "ready" | "not_ready" | "in_flight" | "not_known";
export type CheckMark = "ok" | "warn" | "fail" | "not_looked_at" | "not_known";

export interface PreflightLine {
  group: string;
  verdict: "warn" | "fail";
  what: string;
  found: string;
  remedy: string;
}

/** What a vehicle's checks find. */
export interface PreflightVehicle {
  id: number;
  readiness: Readiness;
  /** Where it is not ready; empty: nothing is. */
  why: string;
  /** What it has told is of now: else it is only what was. */
  counts: boolean;
  told_s: number | null;
  release: string | null;
  firmware: string | null;
  parameters: string | null;
  configuration: string | null;
  /** Those of the four of which at least as many others have another one. */
  odd: string[];
  /** One for each of the groups. */
  marks: CheckMark[];
  /** What is not ok. */
  lines: PreflightLine[];
  lines_left_out: number;
}

export interface Preflight {
  summary: string;
  groups: string[];
  vehicles: PreflightVehicle[];
}

/** What a detector has seen, and nobody has answered. */
export interface Proposal {
  number: number;
  kind: IncidentKind;
  x: number;
  y: number;
  seen_by: number;
  /** Of the detector, 0 to 1. */
  confidence: number;
  detector: string;
  time_s: number;
}

export type State = { type: "state"; time_s: number } & Partial<Sections>;

export interface MissionEvent {
  seq: number;
  time_s: number;
  vehicle: number;
  kind: EventKind;
  level: Level;
  site: number | null;
  task: string | null;
  coalition: string | null;
  /** What the kind tells besides, by name; times in seconds end in _s. */
  fields: Record<string, unknown>;
  /** For people: what it says, and the whole line. */
  news: string;
  text: string;
}

export interface Events {
  type: "events";
  events: MissionEvent[];
}

export interface Preview {
  kind: "preview";
  way: string;
  duration_s: number;
  least_separation_m: number | null;
  movers: Mover[];
  lost: number[];
  /** Only this one moves, out of the way of others that rest too near it; then the order is given. */
  makes_room?: number;
}

/** The ways home of those that would be ordered there now. */
export interface ReturnPreview {
  kind: "return_preview";
  last_s: number;
  least_separation_m: number | null;
  ways: (Omit<Plan, "number"> & { z: number; length_m: number; home_assumed: boolean })[];
  cannot: { id: number; why: string }[];
}

export interface Answer {
  type: "answer";
  id: number;
  done: boolean;
  text: string;
  data: Preview | ReturnPreview | { kind: string } | null;
}

export interface Pong {
  type: "pong";
  id: number;
  time_s: number;
}

/** The ground station's last word: it has been told to end. */
export interface Ended {
  type: "ended";
  time_s: number;
  /** What the mission has come to, in lines for people. */
  text: string;
}

export type FromServer = Hello | History | State | Events | Answer | Pong | Ended;

export interface Command {
  kind: "command";
  command: "hold" | "resume" | "return_home" | "give_back" | "land";
  /** 0: all. */
  vehicle: number;
}

/** The same to several, as one order. */
export interface CommandToSeveral {
  kind: "commands";
  command: "hold" | "resume" | "return_home" | "land";
  vehicles: number[];
}

export interface TakeCommand {
  kind: "take_command";
  /** For the others' operators; may be empty. */
  reason: string;
}

export interface HandOver {
  kind: "hand_over";
}

/** On the plan that was on the screen, and on no other. */
export interface Decision {
  kind: "decision";
  site: number;
  grant: boolean;
  coalition: string;
  round: number;
  /** A grant, also where one that it names is silent. */
  override?: boolean;
}

/** A circle, or a polygon; `hazard`: in place of that one. */
export interface NewHazard {
  kind: "hazard";
  x?: number;
  y?: number;
  radius_m?: number;
  corners?: Corners;
  hazard?: number;
  preview?: boolean;
}

/** What is left out is left to the ground station. */
export interface SearchOrder {
  kind: "search";
  preview: boolean;
  corners?: Corners;
  /** What was not seen of the last area. */
  rest?: boolean;
  vehicles?: number[];
  spacing_m?: number;
  in_s?: number;
}

export interface FenceOrder {
  kind: "fence";
  preview: boolean;
  corners: Corners;
  height_m: number;
}

/** What is left out is left to the ground station. */
export interface FormationOrder {
  kind: "formation";
  order: "take_off" | "rally" | "form" | "land";
  preview: boolean;
  shape?: string;
  spacing_m?: number;
  heading_deg?: number;
  x?: number;
  y?: number;
  z?: number;
  places?: number;
}

/** A new site, or one in place of `site`. What is left out is as the template, or the site before, has it. */
export interface SiteOrder {
  kind: "site";
  preview: boolean;
  site?: number;
  x?: number;
  y?: number;
  like?: string;
  bearings_deg?: number[];
  interval_s?: number;
  assessments?: number;
  dwell_s?: number;
  reward?: number;
  anyway?: boolean;
}

/** One of them. */
export interface Withdrawal {
  kind: "withdraw";
  routes?: true;
  site?: number;
  hazard?: number;
  /** What is authorised at that site. */
  decision?: number;
}

export interface ProposalAnswer {
  kind: "proposal";
  number: number;
  accept: boolean;
}

/** By number, so that what has come since is not meant. */
export interface Acknowledgement {
  kind: "acknowledge";
  alarms: number[];
}

export type Order = Acknowledgement | Command | CommandToSeveral | Decision | NewHazard | SearchOrder | FenceOrder | SiteOrder | Withdrawal | ProposalAnswer | FormationOrder | TakeCommand | HandOver;

export interface Session {
  user: string;
  role: Role;
  /** Whether it came of a login, which can be ended. */
  login?: boolean;
}
