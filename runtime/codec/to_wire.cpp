// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "cut.hpp"
#include "wire.hpp"

namespace skein::codec {
namespace {

// The enumerators of idl/ stand in the order of core's: from_wire.cpp asserts it.
template <class To, class From>
To as_enum(From value) {
  return static_cast<To>(static_cast<std::uint32_t>(value));
}

std::int64_t ns(Instant t) { return t.time_since_epoch().count(); }

template <class Out, class In, class Convert>
std::vector<Out> each(const std::vector<In>& from, Convert convert) {
  std::vector<Out> to;
  to.reserve(from.size());
  for (const In& item : from) to.push_back(convert(item));
  return to;
}

wire::Point point(const Vec2& p) {
  wire::Point w;
  w.x_m(p.x());
  w.y_m(p.y());
  return w;
}

wire::Point3 point3(const Vec3& p) {
  wire::Point3 w;
  w.x_m(p.x());
  w.y_m(p.y());
  w.z_m(p.z());
  return w;
}

wire::Mover mover(const formation::Mover& m) {
  wire::Mover w;
  w.vehicle(m.vehicle.value);
  w.points(each<wire::Point3>(m.points, point3));
  w.around(m.around);
  return w;
}

wire::TaskId task_id(const TaskId& t) {
  wire::TaskId w;
  w.site(t.site.value);
  w.kind(as_enum<wire::TaskKind>(t.kind));
  w.index(t.index);
  return w;
}

wire::TaskAssignment assignment(const TaskAssignment& a) {
  wire::TaskAssignment w;
  w.task(task_id(a.task));
  w.vehicle(a.vehicle.value);
  w.time_ns(ns(a.time));
  return w;
}

wire::ArcRequirement arc(const ArcRequirement& a) {
  wire::ArcRequirement w;
  w.has_start_angle(a.start_angle_rad.has_value());
  w.start_angle_rad(a.start_angle_rad.value_or(0.0));
  w.dwell_ns(a.dwell.count());
  return w;
}

wire::DeliveryRequirement delivery(const DeliveryRequirement& d) {
  wire::DeliveryRequirement w;
  w.bearing_rad(d.bearing_rad);
  w.offset_ns(d.offset.count());
  return w;
}

wire::Site site(const Site& s) {
  wire::Site w;
  w.id(s.id.value);
  w.position(point(s.position));
  w.survey(arc(s.survey));
  w.deliveries(each<wire::DeliveryRequirement>(s.deliveries, delivery));
  w.assess_wait_ns(s.assess_wait.count());
  w.assessments(each<wire::ArcRequirement>(s.assessments, arc));
  w.reward(s.reward);
  w.reward_decay_per_s(s.reward_decay_per_s);
  return w;
}

wire::Round round(const coalition::Round& r) {
  wire::Round w;
  w.leader(r.coalition.leader.value);
  w.leader_instance(r.coalition.instance.value);
  w.coalition(r.coalition.number);
  w.number(r.number);
  return w;
}

wire::CoalitionId coalition_id(const coalition::CoalitionId& id) {
  wire::CoalitionId w;
  w.leader(id.leader.value);
  w.leader_instance(id.instance.value);
  w.number(id.number);
  return w;
}

wire::Announcement body(const coalition::Announcement& m) {
  wire::Announcement w;
  w.round(round(m.round));
  w.site(site(m.site));
  w.tasks(each<wire::TaskId>(m.tasks, task_id));
  w.announced_at_ns(ns(m.announced_at));
  w.bids_until_ns(ns(m.bids_until));
  w.formed_at_ns(ns(m.formed_at));
  w.reward(m.reward);
  w.leader_at_formation(point(m.leader_at_formation));
  return w;
}

wire::Bid body(const coalition::Bid& m) {
  wire::Bid w;
  w.round(round(m.round));
  w.bidder(m.bidder.value);
  w.instance(m.instance.value);
  w.position_at_formation(point(m.pose_at_formation.position()));
  w.heading_at_formation_rad(m.pose_at_formation.heading_rad);
  w.speed_mps(m.speed_mps);
  w.planning_radius_m(m.planning_radius_m);
  w.range_left_m(m.range_left_m);
  w.final_approach_m(m.final_approach_m);
  w.assess_radius_m(m.assess_radius_m);
  w.capabilities(m.capabilities.bits());
  w.loads(m.loads);
  w.eta_ns(ns(m.eta));
  return w;
}

wire::Award body(const coalition::Award& m) {
  wire::Award w;
  w.round(round(m.round));
  w.site(site(m.site));
  w.formed_at_ns(ns(m.formed_at));
  w.assignments(each<wire::TaskAssignment>(m.assignments, assignment));
  w.awarded_at_ns(ns(m.awarded_at));
  w.lease_until_ns(ns(m.lease_until));
  w.continues(coalition_id(m.continues));
  return w;
}

wire::Why why(const coalition::Why& y) {
  wire::Why w;
  w.reason(as_enum<wire::why_not::Reason>(y.reason));
  w.vehicle(y.vehicle.value);
  w.detail(cut(y.detail));
  return w;
}

wire::Confirmation body(const coalition::Confirmation& m) {
  wire::Confirmation w;
  w.round(round(m.round));
  w.member(m.member.value);
  w.accepted(m.accepted);
  w.why(why(m.why));
  return w;
}

wire::Cancel body(const coalition::Cancel& m) {
  wire::Cancel w;
  w.round(round(m.round));
  w.why(why(m.why));
  return w;
}

wire::LeaseRenewal body(const coalition::LeaseRenewal& m) {
  wire::LeaseRenewal w;
  w.round(round(m.round));
  const auto value = [](VehicleId id) { return id.value; };
  w.site(m.site.value);
  w.members(each<std::uint16_t>(m.members, value));
  w.electors(each<std::uint16_t>(m.electors, value));
  w.done(each<wire::TaskId>(m.done, task_id));
  w.unknown(each<wire::TaskId>(m.unknown, task_id));
  w.sent_at_ns(ns(m.sent_at));
  w.lease_until_ns(ns(m.lease_until));
  w.closed(m.closed);
  return w;
}

wire::LeadershipClaim body(const coalition::LeadershipClaim& m) {
  wire::LeadershipClaim w;
  w.coalition(coalition_id(m.coalition));
  w.claimant(m.claimant.value);
  w.sent_at_ns(ns(m.sent_at));
  return w;
}

wire::Allegiance body(const coalition::Allegiance& m) {
  wire::Allegiance w;
  w.coalition(coalition_id(m.coalition));
  w.elector(m.elector.value);
  w.instance(m.instance.value);
  w.follows(m.follows.value);
  w.acknowledges_ns(ns(m.acknowledges));
  return w;
}

wire::MemberStatus body(const coalition::MemberStatus& m) {
  wire::MemberStatus w;
  w.round(round(m.round));
  w.member(m.member.value);
  w.tasks(each<wire::TaskStatus>(m.tasks, [](const coalition::MemberStatus::Entry& e) {
    wire::TaskStatus s;
    s.task(task_id(e.task));
    s.state(as_enum<wire::TaskState>(e.state));
    s.time_ns(ns(e.time));
    return s;
  }));
  return w;
}

void set(wire::CoalitionBody& b, wire::Announcement&& w) { b.announcement(std::move(w)); }
void set(wire::CoalitionBody& b, wire::Bid&& w) { b.bid(std::move(w)); }
void set(wire::CoalitionBody& b, wire::Award&& w) { b.award(std::move(w)); }
void set(wire::CoalitionBody& b, wire::Confirmation&& w) { b.confirmation(std::move(w)); }
void set(wire::CoalitionBody& b, wire::Cancel&& w) { b.cancel(std::move(w)); }
void set(wire::CoalitionBody& b, wire::LeaseRenewal&& w) { b.lease_renewal(std::move(w)); }
void set(wire::CoalitionBody& b, wire::MemberStatus&& w) { b.member_status(std::move(w)); }
void set(wire::CoalitionBody& b, wire::LeadershipClaim&& w) { b.leadership_claim(std::move(w)); }
void set(wire::CoalitionBody& b, wire::Allegiance&& w) { b.allegiance(std::move(w)); }

}  // namespace

wire::CoalitionMessage to_wire(const coalition::Message& m) {
  wire::CoalitionMessage w;
  w.version(wire::kVersion);
  std::visit([&w](const auto& value) { set(w.body(), body(value)); }, m);
  return w;
}

wire::Telemetry to_wire(const mission::Telemetry& m) {
  wire::Telemetry w;
  w.version(wire::kVersion);
  w.vehicle(m.vehicle.value);
  w.instance(m.instance.value);
  w.time_ns(ns(m.state.time));
  w.x_m(m.state.x_m);
  w.y_m(m.state.y_m);
  w.z_m(m.state.z_m);
  w.heading_rad(m.state.heading_rad);
  w.course_rad(m.state.course_rad);
  w.groundspeed_mps(m.state.groundspeed_mps);
  w.airspeed_mps(m.state.airspeed_mps);
  w.distance_flown_m(m.state.distance_flown_m);
  w.activity(as_enum<wire::Activity>(m.activity));
  w.range_left_m(m.range_left_m);
  w.loads(m.loads);
  w.plan_number(m.plan_number);
  w.control_overruns(m.control_overruns);
  w.messages_dropped(m.messages_dropped);
  return w;
}

wire::AuthorisationRequest to_wire(const mission::AuthorisationRequest& m) {
  wire::AuthorisationRequest w;
  w.version(wire::kVersion);
  w.round(round(m.round));
  w.site(m.site.value);
  w.site_position(point(m.site_position));
  w.deliveries(
      each<wire::Delivery>(m.deliveries, [](const mission::AuthorisationRequest::Delivery& d) {
        wire::Delivery to;
        to.assignment(assignment(d.assignment));
        to.bearing_rad(d.bearing_rad);
        return to;
      }));
  w.decide_by_ns(ns(m.decide_by));
  return w;
}

wire::Authorisation to_wire(const mission::Authorisation& m) {
  wire::Authorisation w;
  w.version(wire::kVersion);
  w.round(round(m.round));
  w.site(m.site.value);
  w.granted(m.granted);
  w.decided_by(cut(m.decided_by));
  w.decided_at_ns(ns(m.decided_at));
  return w;
}

wire::Command to_wire(const mission::Command& m) {
  wire::Command w;
  w.version(wire::kVersion);
  w.vehicle(m.vehicle.value);
  w.number(m.number);
  w.kind(as_enum<wire::CommandKind>(m.kind));
  return w;
}

wire::SiteReport to_wire(const mission::SiteReport& m) {
  wire::SiteReport w;
  w.version(wire::kVersion);
  w.found_by(m.finder.value);
  w.site(site(m.site));
  return w;
}

wire::HazardReport to_wire(const mission::HazardReport& m) {
  wire::HazardReport w;
  w.version(wire::kVersion);
  w.id(m.hazard.id.value);
  w.centre(point(m.hazard.centre));
  w.radius_m(m.hazard.radius_m);
  return w;
}

wire::FormationChange to_wire(const formation::Change& m) {
  wire::FormationChange w;
  w.version(wire::kVersion);
  w.number(m.number);
  w.start_ns(ns(m.start));
  w.speed_mps(m.limits.speed_mps);
  w.acceleration_mps2(m.limits.acceleration_mps2);
  w.jerk_mps3(m.limits.jerk_mps3);
  w.separation_m(m.separation.horizontal_m);
  w.vertical_separation_m(m.separation.vertical_m);
  w.stages(static_cast<std::uint8_t>(std::min<std::size_t>(m.stages, 255)));
  w.has_roundabout(m.roundabout.has_value());
  const formation::Roundabout roundabout = m.roundabout.value_or(formation::Roundabout{});
  w.centre(point(roundabout.centre));
  w.radius_m(roundabout.radius_m);
  w.movers(each<wire::Mover>(m.movers, mover));
  return w;
}

wire::FormationStatus to_wire(const mission::FormationStatus& m) {
  wire::FormationStatus w;
  w.version(wire::kVersion);
  w.vehicle(m.vehicle.value);
  w.change(m.progress.change);
  w.progress_at_ns(ns(m.progress.at));
  w.progress(m.progress.done);
  w.rate(m.progress.rate);
  w.off_m(m.progress.off_m);
  w.position(point3(m.position_m));
  w.reference(point3(m.reference_m));
  w.at_rest(m.at_rest);
  return w;
}

wire::PlanReport to_wire(const mission::PlanReport& m) {
  wire::PlanReport w;
  w.version(wire::kVersion);
  w.vehicle(m.vehicle.value);
  w.number(m.plan.number);
  const TimedPath& timed = m.plan.timed;
  w.start_time_ns(ns(timed.start_time));
  w.speed_mps(timed.speed_mps);
  w.tail_curvature_per_m(timed.tail_curvature_per_m);
  w.start(point({timed.path.start.x_m, timed.path.start.y_m}));
  w.heading_rad(timed.path.start.heading_rad);
  w.segments().reserve(timed.path.segments.size());
  for (const Segment& segment : timed.path.segments) {
    wire::Segment s;
    s.curvature_per_m(segment.curvature_per_m);
    s.length_m(segment.length_m);
    w.segments().push_back(s);
  }
  return w;
}

wire::Health to_wire(const mission::Health& m) {
  wire::Health w;
  w.version(wire::kVersion);
  w.vehicle(m.vehicle.value);
  w.instance(m.instance.value);
  w.time_ns(ns(m.time));
  w.program(cut(m.program));
  w.flight_controller(cut(m.flight_controller));
  w.mode(cut(m.mode));
  for (const std::string& problem : m.problems) w.problems().emplace_back(cut(problem));
  w.heard(each<wire::Heard>(m.heard, [](const mission::Health::Heard& heard) {
    wire::Heard h;
    h.vehicle(heard.vehicle.value);
    h.age_ns(heard.age.count());
    return h;
  }));
  return w;
}

}  // namespace skein::codec
