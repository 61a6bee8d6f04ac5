// SPDX-License-Identifier: Apache-2.0
// Samples for the tests.

import type { Alarm, Alarms, Coalition, Hello, MissionEvent, PreflightVehicle, SearchArea, SearchShare, TrafficAircraft, Vehicle } from "./protocol";

export function a_hello(): Hello {
  return {
    type: "hello",
    program: "skein-ground 0",
    run: "a",
    role: "operator",
    user: "test",
    origin: { latitude_deg: 31.5, longitude_deg: 105, height_m: 480 },
    epoch_unix_s: null,
    expected: [1, 2, 3],
    shapes: [],
    site_templates: [],
    sealed: true,
    limits: {
      coordinate_m: [-1e5, 1e5],
      hazard_radius_m: [1, 5e4],
      fence_height_m: [1, 1e5],
      spacing_m: [0.5, 1000],
      heading_deg: [-360, 360],
      places: [1, 1000],
      tasks: [0, 16],
      interval_s: [0, 3600],
      dwell_s: [1, 3600],
      reward: [0, 1e9],
    },
    replay: null,
    tiles: null,
    overlays: [],
    videos: [],
  };
}

export function a_vehicle(id: number, other: Partial<Vehicle> = {}): Vehicle {
  return {
    id,
    expected: true,
    silent: false,
    duplicate: false,
    revoked: false,
    x: 0,
    y: 0,
    z: 100,
    heading_deg: 90,
    course_deg: 90,
    groundspeed: 20,
    airspeed: 20,
    activity: "searching",
    state: "searching",
    besides: null,
    task: null,
    heard_age_s: 0.1,
    clock_offset_ms: 30,
    range_left_m: 5000,
    loads: 1,
    plan_number: 1,
    version: "0.1.0",
    flight_controller: null,
    mode: null,
    problems: [],
    links: [],
    control_overruns: 0,
    messages_dropped: 0,
    ...other,
  };
}

export function an_event(seq: number, other: Partial<MissionEvent> = {}): MissionEvent {
  return {
    seq,
    time_s: seq,
    vehicle: 1,
    kind: "announced",
    level: "info",
    site: null,
    task: null,
    coalition: null,
    fields: {},
    news: "",
    text: `event ${seq}`,
    ...other,
  };
}

export function a_coalition(key: string, other: Partial<Coalition> = {}): Coalition {
  return {
    key,
    leader: 1,
    number: 1,
    site: 1,
    state: "announced",
    why: null,
    members: [],
    rounds: [],
    lease_until_s: null,
    ...other,
  };
}

export function a_share(id: number, other: Partial<SearchShare> = {}): SearchShare {
  return { id, state: "flies", why: "", lanes: 5, lanes_left: 5, left_m: 3000, done_s: 300, length_m: 4000, time_s: 200, ways: [], points: [], ...other };
}

export function a_search(other: Partial<SearchArea> = {}): SearchArea {
  return {
    state: "flown",
    why: "",
    area_m2: 650_000,
    expected_s: 300,
    corners: [[0, 0], [1000, 0], [1000, 650], [0, 650]],
    sensor_radius_m: 120,
    spacing_m: 216,
    planned: 1,
    seen: 0,
    least_s: 100,
    begins_s: 40,
    ends_s: 300,
    parts: 1,
    shares: [a_share(1)],
    without: [],
    rest: false,
    ...other,
  };
}

export function a_traffic_aircraft(other: Partial<TrafficAircraft> = {}): TrafficAircraft {
  return {
    address: "4ca2d6",
    callsign: "RYR12",
    x: 4000,
    y: 0,
    z: 300,
    track_deg: 270,
    speed_mps: 60,
    climb_mps: 0,
    age_s: 1,
    barometric: false,
    on_ground: false,
    warned: [],
    nearest: { vehicle: 1, distance_m: 4000, above_m: 200, closest_m: 2000, closest_in_s: 60 },
    ...other,
  };
}

export function a_preflight_vehicle(id: number, other: Partial<PreflightVehicle> = {}): PreflightVehicle {
  return {
    id,
    readiness: "ready",
    why: "",
    counts: true,
    told_s: 1,
    release: "0.1.0",
    firmware: null,
    parameters: null,
    configuration: "00000001",
    odd: [],
    marks: [],
    lines: [],
    lines_left_out: 0,
    ...other,
  };
}

export function an_alarm(number: number, other: Partial<Alarm> = {}): Alarm {
  return {
    number,
    key: "vehicle_silent-7",
    kind: "vehicle_silent",
    level: "alarm",
    since_s: 60,
    over_s: null,
    what: "vehicle 7 is silent",
    remedy: "look for it",
    closest_s: null,
    times: 1,
    vehicle: 7,
    other: null,
    site: null,
    panel: "fleet",
    offers: [],
    acknowledged: null,
    ...other,
  };
}

export function some_alarms(list: Alarm[], orders: Alarms["orders"] = []): Alarms {
  const of = (level: Alarm["level"]) => list.filter((alarm) => alarm.level === level && alarm.over_s === null).length;
  const unacknowledged = list.filter((alarm) => alarm.acknowledged === null && alarm.over_s === null).length;
  return { counts: { alarm: of("alarm"), warning: of("warning"), notice: of("notice"), unacknowledged }, list, orders };
}
