// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "check.hpp"
#include "wire.hpp"

namespace skein::codec {
namespace {

static_assert(wire::kTasksPerKindMax == kTasksPerKindMax);
static_assert(wire::kTasksMax == coalition::kTasksMax);
static_assert(wire::kMembersMax == coalition::kMembersMax);
static_assert(wire::kMoversMax == formation::kMoversMax);
static_assert(wire::kTeamMax == formation::kMoversMax);
static_assert(wire::kMoverPointsMax == formation::kStagesMax + 1);
static_assert(wire::kSegmentsMax == kPathSegmentsMax);
static_assert(wire::kProblemsMax == mission::kProblemsMax);
static_assert(wire::kHeardMax == mission::kHeardMax);
static_assert(wire::ASSESS + 1 == static_cast<int>(TaskKind::count));
static_assert(wire::UNKNOWN + 1 == static_cast<int>(coalition::TaskState::count));
static_assert(wire::EN_ROUTE + 1 == static_cast<int>(mission::Activity::count));
static_assert(wire::SURVEYING == static_cast<int>(mission::Activity::surveying));
static_assert(wire::EXECUTING == static_cast<int>(mission::Activity::executing));
static_assert(wire::event::FLIGHT_WARNING + 1 == static_cast<int>(mission::EventKind::count));
static_assert(wire::event::TASK_DONE == static_cast<int>(mission::EventKind::task_done));
static_assert(wire::why_not::SITE_DONE + 1 == static_cast<int>(coalition::Reason::count));
static_assert(wire::GIVE_BACK + 1 == static_cast<int>(mission::CommandKind::count));

Vec2 point(Check& c, const wire::Point& w) {
  return {c.coordinate(w.x_m()), c.coordinate(w.y_m())};
}

Vec3 point3(Check& c, const wire::Point3& w) {
  return {c.coordinate(w.x_m()), c.coordinate(w.y_m()), c.coordinate(w.z_m())};
}

formation::Mover mover(Check& c, const wire::Mover& w) {
  return {VehicleId{w.vehicle()}, c.each(w.points(), wire::kMoverPointsMax, point3), w.around()};
}

TaskId task_id(Check& c, const wire::TaskId& w) {
  c.require(w.index() < kTasksPerKindMax);
  return {SiteId{w.site()}, c.enumerator<TaskKind>(w.kind()), w.index()};
}

TaskAssignment assignment(Check& c, const wire::TaskAssignment& w) {
  return {task_id(c, w.task()), VehicleId{w.vehicle()}, c.instant(w.time_ns())};
}

ArcRequirement arc(Check& c, const wire::ArcRequirement& w) {
  ArcRequirement a;
  const double angle = c.angle(w.start_angle_rad());
  if (w.has_start_angle()) a.start_angle_rad = angle;
  a.dwell = c.duration(w.dwell_ns());
  return a;
}

DeliveryRequirement delivery(Check& c, const wire::DeliveryRequirement& w) {
  return {c.angle(w.bearing_rad()), c.duration(w.offset_ns())};
}

Site site(Check& c, const wire::Site& w) {
  Site s;
  s.id = SiteId{w.id()};
  s.position = point(c, w.position());
  s.survey = arc(c, w.survey());
  s.deliveries = c.each(w.deliveries(), kTasksPerKindMax, delivery);
  s.assess_wait = c.duration(w.assess_wait_ns());
  s.assessments = c.each(w.assessments(), kTasksPerKindMax, arc);
  s.reward = c.amount(w.reward());
  s.reward_decay_per_s = c.amount(w.reward_decay_per_s());
  return s;
}

coalition::Round round(const wire::Round& w) {
  return {{VehicleId{w.leader()}, InstanceId{w.leader_instance()}, w.coalition()}, w.number()};
}

coalition::CoalitionId coalition_id(const wire::CoalitionId& w) {
  return {VehicleId{w.leader()}, InstanceId{w.leader_instance()}, w.number()};
}

coalition::Message body(Check& c, const wire::Announcement& w) {
  coalition::Announcement m;
  m.round = round(w.round());
  m.site = site(c, w.site());
  m.tasks = c.each(w.tasks(), coalition::kTasksMax, task_id);
  m.announced_at = c.instant(w.announced_at_ns());
  m.bids_until = c.instant(w.bids_until_ns());
  m.formed_at = c.instant(w.formed_at_ns());
  m.reward = c.amount(w.reward());
  m.leader_at_formation = point(c, w.leader_at_formation());
  return m;
}

coalition::Message body(Check& c, const wire::Bid& w) {
  coalition::Bid m;
  m.round = round(w.round());
  m.bidder = VehicleId{w.bidder()};
  m.instance = InstanceId{w.instance()};
  const Vec2 position = point(c, w.position_at_formation());
  m.pose_at_formation = {position.x(), position.y(), c.angle(w.heading_at_formation_rad())};
  m.speed_mps = c.speed(w.speed_mps());
  m.planning_radius_m = c.distance(w.planning_radius_m());
  m.range_left_m = c.coordinate(w.range_left_m());
  m.final_approach_m = c.distance(w.final_approach_m());
  m.assess_radius_m = c.distance(w.assess_radius_m());
  m.capabilities = Capabilities::from_bits(w.capabilities());
  c.require(m.capabilities.bits() == w.capabilities());
  m.loads = w.loads();
  m.eta = c.instant(w.eta_ns());
  return m;
}

coalition::Message body(Check& c, const wire::Award& w) {
  coalition::Award m;
  m.round = round(w.round());
  m.site = site(c, w.site());
  m.formed_at = c.instant(w.formed_at_ns());
  m.assignments = c.each(w.assignments(), coalition::kTasksMax, assignment);
  m.awarded_at = c.instant(w.awarded_at_ns());
  m.lease_until = c.instant(w.lease_until_ns());
  m.continues = coalition_id(w.continues());
  return m;
}

coalition::Why why(Check& c, const wire::Why& w) {
  return {c.enumerator<coalition::Reason>(w.reason()), VehicleId{w.vehicle()},
          c.text(w.detail().to_string())};
}

coalition::Message body(Check& c, const wire::Confirmation& w) {
  return coalition::Confirmation{round(w.round()), VehicleId{w.member()}, w.accepted(),
                                 why(c, w.why())};
}

coalition::Message body(Check& c, const wire::Cancel& w) {
  return coalition::Cancel{round(w.round()), why(c, w.why())};
}

coalition::Message body(Check& c, const wire::LeaseRenewal& w) {
  coalition::LeaseRenewal m;
  m.round = round(w.round());
  const auto vehicle = [](Check&, std::uint16_t id) { return VehicleId{id}; };
  m.site = SiteId{w.site()};
  m.members = c.each(w.members(), coalition::kMembersMax, vehicle);
  m.electors = c.each(w.electors(), coalition::kMembersMax, vehicle);
  m.done = c.each(w.done(), coalition::kTasksMax, task_id);
  m.unknown = c.each(w.unknown(), coalition::kTasksMax, task_id);
  m.sent_at = c.instant(w.sent_at_ns());
  m.lease_until = c.instant(w.lease_until_ns());
  m.closed = w.closed();
  return m;
}

coalition::Message body(Check& c, const wire::LeadershipClaim& w) {
  return coalition::LeadershipClaim{coalition_id(w.coalition()), VehicleId{w.claimant()},
                                    c.instant(w.sent_at_ns())};
}

coalition::Message body(Check& c, const wire::Allegiance& w) {
  return coalition::Allegiance{coalition_id(w.coalition()), VehicleId{w.elector()},
                               InstanceId{w.instance()}, VehicleId{w.follows()},
                               c.instant(w.acknowledges_ns())};
}

coalition::Message body(Check& c, const wire::MemberStatus& w) {
  coalition::MemberStatus m;
  m.round = round(w.round());
  m.member = VehicleId{w.member()};
  m.tasks = c.each(w.tasks(), coalition::kTasksMax, [](Check& check, const wire::TaskStatus& s) {
    return coalition::MemberStatus::Entry{task_id(check, s.task()),
                                          check.enumerator<coalition::TaskState>(s.state()),
                                          check.instant(s.time_ns())};
  });
  return m;
}

coalition::Message body(Check& c, const wire::CoalitionBody& w) {
  switch (w._d()) {
    case wire::ANNOUNCEMENT:
      return body(c, w.announcement());
    case wire::BID:
      return body(c, w.bid());
    case wire::AWARD:
      return body(c, w.award());
    case wire::CONFIRMATION:
      return body(c, w.confirmation());
    case wire::CANCEL:
      return body(c, w.cancel());
    case wire::LEASE_RENEWAL:
      return body(c, w.lease_renewal());
    case wire::MEMBER_STATUS:
      return body(c, w.member_status());
    case wire::LEADERSHIP_CLAIM:
      return body(c, w.leadership_claim());
    case wire::ALLEGIANCE:
      return body(c, w.allegiance());
  }
  c.require(false);
  return coalition::Cancel{};
}

}  // namespace

mission::Message from_wire(const wire::CoalitionMessage& w, bool& ok) {
  Check c{ok};
  return body(c, w.body());
}

mission::Message from_wire(const wire::Telemetry& w, bool& ok) {
  Check c{ok};
  mission::Telemetry m;
  m.vehicle = VehicleId{w.vehicle()};
  m.instance = InstanceId{w.instance()};
  m.state.time = c.instant(w.time_ns());
  m.state.x_m = c.coordinate(w.x_m());
  m.state.y_m = c.coordinate(w.y_m());
  m.state.z_m = c.coordinate(w.z_m());
  m.state.heading_rad = c.angle(w.heading_rad());
  m.state.course_rad = c.angle(w.course_rad());
  m.state.groundspeed_mps = c.speed(w.groundspeed_mps());
  m.state.airspeed_mps = c.speed(w.airspeed_mps());
  m.state.distance_flown_m = c.distance(w.distance_flown_m());
  m.activity = c.enumerator<mission::Activity>(w.activity());
  m.range_left_m = c.coordinate(w.range_left_m());
  m.loads = w.loads();
  m.plan_number = w.plan_number();
  m.control_overruns = w.control_overruns();
  m.messages_dropped = w.messages_dropped();
  return m;
}

mission::Message from_wire(const wire::AuthorisationRequest& w, bool& ok) {
  Check c{ok};
  mission::AuthorisationRequest m;
  m.round = round(w.round());
  m.site = SiteId{w.site()};
  m.site_position = point(c, w.site_position());
  m.deliveries =
      c.each(w.deliveries(), coalition::kTasksMax, [](Check& check, const wire::Delivery& d) {
        return mission::AuthorisationRequest::Delivery{assignment(check, d.assignment()),
                                                       check.angle(d.bearing_rad())};
      });
  m.decide_by = c.instant(w.decide_by_ns());
  return m;
}

mission::Message from_wire(const wire::Authorisation& w, bool& ok) {
  Check c{ok};
  return mission::Authorisation{round(w.round()), SiteId{w.site()}, w.granted(),
                                c.text(w.decided_by().to_string()), c.instant(w.decided_at_ns())};
}

mission::Message from_wire(const wire::Command& w, bool& ok) {
  Check c{ok};
  return mission::Command{VehicleId{w.vehicle()}, w.number(),
                          c.enumerator<mission::CommandKind>(w.kind())};
}

mission::Message from_wire(const wire::SiteReport& w, bool& ok) {
  Check c{ok};
  return mission::SiteReport{VehicleId{w.found_by()}, site(c, w.site())};
}

mission::Message from_wire(const wire::HazardReport& w, bool& ok) {
  Check c{ok};
  return mission::HazardReport{{HazardId{w.id()}, point(c, w.centre()), c.distance(w.radius_m())}};
}

mission::Message from_wire(const wire::FormationChange& w, bool& ok) {
  Check c{ok};
  formation::Change m;
  m.number = w.number();
  m.start = c.instant(w.start_ns());
  m.limits = {c.speed(w.speed_mps()), c.amount(w.acceleration_mps2()), c.amount(w.jerk_mps3())};
  m.separation = {c.distance(w.separation_m()), c.distance(w.vertical_separation_m())};
  c.require(w.stages() >= 1 && w.stages() < wire::kMoverPointsMax);
  m.stages = w.stages();
  const formation::Roundabout roundabout{point(c, w.centre()), c.distance(w.radius_m())};
  if (w.has_roundabout()) m.roundabout = roundabout;
  m.movers = c.each(w.movers(), wire::kMoversMax, mover);
  return m;
}

mission::Message from_wire(const wire::FormationStatus& w, bool& ok) {
  Check c{ok};
  mission::FormationStatus m;
  m.vehicle = VehicleId{w.vehicle()};
  m.progress = {w.change(), c.instant(w.progress_at_ns()), w.progress(), w.rate(),
                c.distance(w.off_m())};
  m.position_m = point3(c, w.position());
  m.reference_m = point3(c, w.reference());
  m.at_rest = w.at_rest();
  return m;
}

mission::Message from_wire(const wire::PlanReport& w, bool& ok) {
  Check c{ok};
  mission::PlanReport m;
  m.vehicle = VehicleId{w.vehicle()};
  m.plan.number = w.number();
  TimedPath& timed = m.plan.timed;
  timed.start_time = c.instant(w.start_time_ns());
  timed.speed_mps = c.speed(w.speed_mps());
  c.require(timed.speed_mps > 0.0);
  timed.tail_curvature_per_m = c.curvature(w.tail_curvature_per_m());
  const Vec2 start = point(c, w.start());
  timed.path.start = {start.x(), start.y(), c.angle(w.heading_rad())};
  c.require(w.segments().size() <= kPathSegmentsMax);
  if (!ok) return m;
  for (const wire::Segment& segment : w.segments()) {
    timed.path.segments.push_back(
        {c.curvature(segment.curvature_per_m()), c.distance(segment.length_m())});
  }
  return m;
}

mission::Message from_wire(const wire::Health& w, bool& ok) {
  Check c{ok};
  mission::Health m;
  m.vehicle = VehicleId{w.vehicle()};
  m.instance = InstanceId{w.instance()};
  m.time = c.instant(w.time_ns());
  m.program = c.text(w.program().to_string());
  m.flight_controller = c.text(w.flight_controller().to_string());
  m.mode = c.text(w.mode().to_string());
  m.problems = c.each(w.problems(), mission::kProblemsMax, [](Check& check, const auto& problem) {
    return check.text(problem.to_string());
  });
  m.heard = c.each(w.heard(), mission::kHeardMax, [](Check& check, const wire::Heard& heard) {
    return mission::Health::Heard{VehicleId{heard.vehicle()}, check.duration(heard.age_ns())};
  });
  return m;
}

}  // namespace skein::codec
