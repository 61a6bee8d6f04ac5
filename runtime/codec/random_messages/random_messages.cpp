// SPDX-License-Identifier: Apache-2.0
#include "skein/random_messages/random_messages.hpp"

#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "skein/codec/codec.hpp"
#include "skein/mission/event_fields.hpp"

namespace skein::codec {
namespace {

/// Calls of `random` stand in separate statements: the order in which arguments are evaluated
/// differs between compilers, and the golden encodings must not.
template <class T>
T integer(Random& random) {
  return static_cast<T>(random.next());
}

double coordinate(Random& random) { return random.uniform(-kDistanceMaxM, kDistanceMaxM); }
double distance(Random& random) { return random.uniform(0.0, kDistanceMaxM); }
double speed(Random& random) { return random.uniform(0.0, kSpeedMaxMps); }
double angle(Random& random) { return random.uniform(-kAngleMaxRad, kAngleMaxRad); }

template <class E>
E enumerator(Random& random) {
  return static_cast<E>(random.index(static_cast<std::uint64_t>(E::count)));
}

Duration duration(Random& random) {
  return Duration{
      static_cast<Duration::rep>(random.index(static_cast<std::uint64_t>(kTimeMax.count()) + 1))};
}

Instant instant(Random& random) {
  const Duration since = duration(random);
  return random.chance(0.5) ? Instant{since} : Instant{-since};
}

std::string text(Random& random) {
  static const std::vector<std::string> characters{"a",  "Z", " ", "<",   "\"",
                                                   "\n", "ä", "→", "🛩"};
  std::string made;
  const std::size_t wanted = random.index(coalition::kReasonMax + 1);
  while (true) {
    const std::string& next = characters[random.index(characters.size())];
    if (made.size() + next.size() > wanted) return made;
    made += next;
  }
}

template <class F>
auto several(Random& random, std::size_t limit, F make) {
  std::vector<decltype(make(random))> all;
  const std::size_t count = random.index(limit + 1);
  for (std::size_t i = 0; i < count; ++i) all.push_back(make(random));
  return all;
}

VehicleId vehicle(Random& random) { return VehicleId{integer<std::uint16_t>(random)}; }

Vec2 point(Random& random) {
  const double x = coordinate(random);
  const double y = coordinate(random);
  return {x, y};
}

TaskId task_id(Random& random) {
  TaskId t;
  t.site = SiteId{integer<std::uint16_t>(random)};
  t.kind = enumerator<TaskKind>(random);
  t.index = static_cast<std::uint8_t>(random.index(kTasksPerKindMax));
  return t;
}

TaskAssignment assignment(Random& random) {
  TaskAssignment a;
  a.task = task_id(random);
  a.vehicle = vehicle(random);
  a.time = instant(random);
  return a;
}

ArcRequirement arc(Random& random) {
  ArcRequirement a;
  if (random.chance(0.5)) a.start_angle_rad = angle(random);
  a.dwell = duration(random);
  return a;
}

DeliveryRequirement delivery(Random& random) {
  DeliveryRequirement d;
  d.bearing_rad = angle(random);
  d.offset = duration(random);
  return d;
}

Site site(Random& random) {
  Site s;
  s.id = SiteId{integer<std::uint16_t>(random)};
  s.position = point(random);
  s.survey = arc(random);
  s.deliveries = several(random, kTasksPerKindMax, delivery);
  s.assess_wait = duration(random);
  s.assessments = several(random, kTasksPerKindMax, arc);
  s.reward = random.uniform(0.0, kNumberMax);
  s.reward_decay_per_s = random.uniform();
  return s;
}

coalition::CoalitionId coalition_id(Random& random) {
  coalition::CoalitionId id;
  id.leader = vehicle(random);
  id.instance = InstanceId{random.next()};
  id.number = integer<std::uint32_t>(random);
  return id;
}

coalition::Round round(Random& random) {
  coalition::Round r;
  r.coalition = coalition_id(random);
  r.number = integer<std::uint32_t>(random);
  return r;
}

coalition::Message announcement(Random& random) {
  coalition::Announcement m;
  m.round = round(random);
  m.site = site(random);
  m.tasks = several(random, coalition::kTasksMax, task_id);
  m.announced_at = instant(random);
  m.bids_until = instant(random);
  m.formed_at = instant(random);
  m.reward = random.uniform(0.0, kNumberMax);
  m.leader_at_formation = point(random);
  return m;
}

coalition::Message bid(Random& random) {
  coalition::Bid m;
  m.round = round(random);
  m.bidder = vehicle(random);
  m.instance = InstanceId{random.next()};
  m.pose_at_formation.x_m = coordinate(random);
  m.pose_at_formation.y_m = coordinate(random);
  m.pose_at_formation.heading_rad = angle(random);
  m.speed_mps = speed(random);
  m.planning_radius_m = distance(random);
  m.range_left_m = coordinate(random);
  m.final_approach_m = distance(random);
  m.assess_radius_m = distance(random);
  m.capabilities = Capabilities::from_bits(integer<std::uint8_t>(random));
  m.loads = integer<std::uint8_t>(random);
  m.eta = instant(random);
  return m;
}

coalition::Message award(Random& random) {
  coalition::Award m;
  m.round = round(random);
  m.site = site(random);
  m.formed_at = instant(random);
  m.assignments = several(random, coalition::kTasksMax, assignment);
  m.awarded_at = instant(random);
  m.lease_until = instant(random);
  m.continues = coalition_id(random);
  return m;
}

coalition::Why why(Random& random) {
  coalition::Why w;
  w.reason = enumerator<coalition::Reason>(random);
  w.vehicle = vehicle(random);
  w.detail = text(random);
  return w;
}

coalition::Message confirmation(Random& random) {
  coalition::Confirmation m;
  m.round = round(random);
  m.member = vehicle(random);
  m.accepted = random.chance(0.5);
  m.why = why(random);
  return m;
}

coalition::Message cancel(Random& random) {
  coalition::Cancel m;
  m.round = round(random);
  m.why = why(random);
  return m;
}

coalition::Message lease_renewal(Random& random) {
  coalition::LeaseRenewal m;
  m.round = round(random);
  m.site = SiteId{integer<std::uint16_t>(random)};
  m.members = several(random, coalition::kMembersMax, vehicle);
  m.electors = several(random, coalition::kMembersMax, vehicle);
  m.done = several(random, coalition::kTasksMax, task_id);
  m.unknown = several(random, coalition::kTasksMax, task_id);
  m.sent_at = instant(random);
  m.lease_until = instant(random);
  m.closed = random.chance(0.5);
  return m;
}

coalition::Message leadership_claim(Random& random) {
  coalition::LeadershipClaim m;
  m.coalition = coalition_id(random);
  m.claimant = vehicle(random);
  m.sent_at = instant(random);
  return m;
}

coalition::Message allegiance(Random& random) {
  coalition::Allegiance m;
  m.coalition = coalition_id(random);
  m.elector = vehicle(random);
  m.instance = InstanceId{random.next()};
  m.follows = vehicle(random);
  m.acknowledges = instant(random);
  return m;
}

coalition::Message member_status(Random& random) {
  coalition::MemberStatus m;
  m.round = round(random);
  m.member = vehicle(random);
  m.tasks = several(random, coalition::kTasksMax, [](Random& r) {
    coalition::MemberStatus::Entry e;
    e.task = task_id(r);
    e.state = enumerator<coalition::TaskState>(r);
    e.time = instant(r);
    return e;
  });
  return m;
}

mission::Message telemetry(Random& random) {
  mission::Telemetry m;
  m.vehicle = vehicle(random);
  m.instance = InstanceId{random.next()};
  m.state.time = instant(random);
  m.state.x_m = coordinate(random);
  m.state.y_m = coordinate(random);
  m.state.z_m = coordinate(random);
  m.state.heading_rad = angle(random);
  m.state.course_rad = angle(random);
  m.state.groundspeed_mps = speed(random);
  m.state.airspeed_mps = speed(random);
  m.state.distance_flown_m = distance(random);
  m.activity = enumerator<mission::Activity>(random);
  m.range_left_m = coordinate(random);
  m.loads = integer<std::uint8_t>(random);
  m.plan_number = integer<std::uint32_t>(random);
  m.control_overruns = integer<std::uint32_t>(random);
  m.messages_dropped = integer<std::uint32_t>(random);
  return m;
}

mission::Message authorisation_request(Random& random) {
  mission::AuthorisationRequest m;
  m.round = round(random);
  m.site = SiteId{integer<std::uint16_t>(random)};
  m.site_position = point(random);
  m.deliveries = several(random, coalition::kTasksMax, [](Random& r) {
    mission::AuthorisationRequest::Delivery d;
    d.assignment = assignment(r);
    d.bearing_rad = angle(r);
    return d;
  });
  m.decide_by = instant(random);
  return m;
}

mission::Message authorisation(Random& random) {
  mission::Authorisation m;
  m.round = round(random);
  m.site = SiteId{integer<std::uint16_t>(random)};
  m.granted = random.chance(0.5);
  m.decided_by = text(random);
  m.decided_at = instant(random);
  return m;
}

void draw(Random& random, double& value) { value = random.uniform(-kNumberMax, kNumberMax); }
void draw(Random& random, bool& value) { value = random.chance(0.5); }
void draw(Random& random, std::string& value) { value = text(random); }
void draw(Random& random, Instant& value) { value = instant(random); }
void draw(Random& random, Duration& value) { value = duration(random); }
void draw(Random& random, std::vector<VehicleId>& value) {
  value = several(random, formation::kMoversMax, vehicle);
}
template <class Tag, class Rep>
void draw(Random& random, Id<Tag, Rep>& value) {
  value.value = integer<Rep>(random);
}
template <class T>
void draw(Random& random, T& value) {
  if constexpr (std::is_enum_v<T>) {
    value = enumerator<T>(random);
  } else if constexpr (std::is_integral_v<T>) {
    value = integer<T>(random);
  } else {
    mission::for_each_field(value,
                            [&random](auto /*name*/, auto& member) { draw(random, member); });
  }
}

mission::EventBody event_body(Random& random) {
  auto body = mission::body_of(enumerator<mission::EventKind>(random));
  std::visit([&random](auto& made) { draw(random, made); }, body);
  return body;
}

mission::Message mission_event(Random& random) {
  mission::MissionEvent m;
  m.vehicle = vehicle(random);
  m.time = instant(random);
  m.round = round(random);
  m.task = task_id(random);
  m.body = event_body(random);
  return m;
}

mission::Message command(Random& random) {
  mission::Command m;
  m.vehicle = vehicle(random);
  m.number = integer<std::uint32_t>(random);
  m.kind = enumerator<mission::CommandKind>(random);
  return m;
}

mission::Message site_report(Random& random) {
  mission::SiteReport m;
  m.finder = vehicle(random);
  m.site = site(random);
  return m;
}

mission::Message hazard_report(Random& random) {
  mission::HazardReport m;
  m.hazard.id = HazardId{integer<std::uint16_t>(random)};
  m.hazard.centre = point(random);
  m.hazard.radius_m = distance(random);
  return m;
}

Vec3 point3(Random& random) {
  const Vec2 flat = point(random);
  return {flat.x(), flat.y(), point(random).x()};
}

mission::Message formation_change(Random& random) {
  formation::Change m;
  m.number = integer<std::uint32_t>(random);
  m.start = instant(random);
  m.limits = {random.uniform(0.0, kSpeedMaxMps), random.uniform(0.0, kNumberMax),
              random.uniform(0.0, kNumberMax)};
  m.separation = {distance(random), distance(random)};
  m.stages = 1 + random.index(3);
  if (random.chance(0.5)) m.roundabout = formation::Roundabout{point(random), distance(random)};
  m.movers.resize(random.index(formation::kMoversMax + 1));
  for (formation::Mover& mover : m.movers) {
    mover.vehicle = vehicle(random);
    mover.around = random.chance(0.5);
    for (std::size_t i = random.index(formation::kStagesMax + 2); i > 0; --i) {
      mover.points.push_back(point3(random));
    }
  }
  return m;
}

mission::Message formation_status(Random& random) {
  mission::FormationStatus m;
  m.vehicle = vehicle(random);
  m.progress = {integer<std::uint32_t>(random), instant(random), integer<std::uint32_t>(random),
                integer<std::uint16_t>(random), distance(random)};
  m.position_m = point3(random);
  m.reference_m = point3(random);
  m.at_rest = random.chance(0.5);
  return m;
}

double curvature(Random& random) { return random.uniform(-kCurvatureMaxPerM, kCurvatureMaxPerM); }

mission::Message plan_report(Random& random) {
  mission::PlanReport m;
  m.vehicle = vehicle(random);
  m.plan.number = integer<std::uint32_t>(random);
  m.plan.timed.start_time = instant(random);
  m.plan.timed.speed_mps = random.uniform(0.1, kSpeedMaxMps);
  m.plan.timed.tail_curvature_per_m = curvature(random);
  const Vec2 start = point(random);
  m.plan.timed.path.start = {start.x(), start.y(), angle(random)};
  const std::size_t segments = random.index(kPathSegmentsMax + 1);
  for (std::size_t i = 0; i < segments; ++i) {
    const double turn = curvature(random);
    m.plan.timed.path.segments.push_back({turn, distance(random)});
  }
  return m;
}

mission::Message health(Random& random) {
  mission::Health m;
  m.vehicle = vehicle(random);
  m.instance = InstanceId{random.next()};
  m.time = instant(random);
  m.program = text(random);
  m.flight_controller = text(random);
  m.mode = text(random);
  m.problems = several(random, mission::kProblemsMax, text);
  m.heard = several(random, mission::kHeardMax, [](Random& r) {
    const VehicleId heard = vehicle(r);
    return mission::Health::Heard{heard, duration(r)};
  });
  return m;
}

}  // namespace

mission::Message random_message(std::size_t kind, Random& random) {
  switch (kind % kMessageKinds) {
    case 0:
      return announcement(random);
    case 1:
      return bid(random);
    case 2:
      return award(random);
    case 3:
      return confirmation(random);
    case 4:
      return cancel(random);
    case 5:
      return lease_renewal(random);
    case 6:
      return member_status(random);
    case 7:
      return telemetry(random);
    case 8:
      return authorisation_request(random);
    case 9:
      return authorisation(random);
    case 10:
      return mission_event(random);
    case 11:
      return command(random);
    case 12:
      return site_report(random);
    case 13:
      return hazard_report(random);
    case 14:
      return leadership_claim(random);
    case 15:
      return formation_change(random);
    case 16:
      return formation_status(random);
    case 17:
      return plan_report(random);
    case 18:
      return health(random);
    default:
      return allegiance(random);
  }
}

}  // namespace skein::codec
