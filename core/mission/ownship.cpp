// SPDX-License-Identifier: Apache-2.0
#include "ownship.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fence_way.hpp"
#include "return_way.hpp"
#include "skein/base/angles.hpp"
#include "skein/base/shortened.hpp"
#include "skein/planning/avoidance.hpp"
#include "skein/planning/path_follower.hpp"

namespace skein::mission {
namespace {
/// A task counts as flown when the vehicle is this close to where its plan has it.
constexpr double kOnTrackM = 30.0;
constexpr Duration kLeadIn = std::chrono::seconds{3};
/// In so much a plane has turned round.
constexpr Duration kFenceAhead = std::chrono::seconds{8};
/// How close a vehicle must be to its route to take it up.
constexpr double kAtRouteM = 50.0;
/// A copter that is first seen so near to its height flies.
constexpr double kStandsBelow_m = 4.0;

/// Where that copter stands, above the origin; the origin's height where it is seen in the air
/// first.
double stands_m(const VehicleState& state, const VehicleSpec& vehicle) {
  const bool is_high = std::abs(state.z_m - vehicle.height_m) < kStandsBelow_m;
  return state.on_ground() || !is_high ? state.z_m : 0.0;
}

VehicleAgentConfig with_margin(VehicleAgentConfig config) {
  double& margin_m = config.planning.avoidance.margin_m;
  margin_m = std::max(margin_m, kHazardMargin_m);
  return config;
}
}  // namespace

Ownship::Ownship(const VehicleAgentConfig& config)
    : config_{with_margin(config)},
      range_{config.vehicle},
      turn_room_{config.vehicle, config.heeds_wind},
      take_off_{config.vehicle},
      flight_{config.vehicle, config_.planning.avoidance, config.search},
      hazards_{config.hazards},
      loads_{config.vehicle.loads} {
  if (config.heeds_wind) flight_.set_lead_in(kLeadIn);
  flight_.set_fence(config.fence);
  flight_.set_handover(flight_.handover() + from_seconds(config.turn_lead_s));
}

bool Ownship::on_state(const VehicleState& state, Instant now) {
  state_ = state;
  if (descent_) descent_->step(state, now);
  if (!ground_m_) ground_m_ = stands_m(state, spec());
  if (flight_.started() || !take_off_.done(state, now)) return true;
  if (config_.route && is_at_route()) {
    flight_.start_route(*config_.route);
    return true;
  }
  flight_.start(begins_at(state), hazards(), range_to_spend(now), now);
  return !config_.route || told_route_;
}

/// In wind an aircraft moves elsewhere than its nose points.
Pose2 Ownship::begins_at(const VehicleState& state) const {
  return config_.heeds_wind ? state.pose_over_ground() : state.pose();
}

bool Ownship::measures_wind(const VehicleState& state) {
  const bool is_news = turn_room_.on_state(state);
  flight_.set_wind(turn_room_.wind_mps());
  if (!is_news) return false;
  flight_.set_planning_radius(planning_radius_m());
  return true;
}

void Ownship::give_route(const TimedPath& route) {
  config_.route = route;
  told_route_ = true;
}

void Ownship::take_route_back() {
  if (std::exchange(told_route_, false)) config_.route.reset();
}

std::optional<Guidance> Ownship::poll_guidance() {
  if (!flight_.started()) return take_off_.poll_track();
  if (descent_) {
    if (auto track = descent_->poll_track()) return Guidance{*track};
    return std::nullopt;
  }
  return flight_.poll_plan();
}

/// Where a route begins, or goes on for who starts anew in the middle.
bool Ownship::is_at_route() const {
  const Pose2 pose = config_.route->pose_at(state_.time);
  return (Vec2{state_.x_m, state_.y_m} - pose.position()).norm() <= kAtRouteM &&
         std::abs(wrap_pi(state_.heading_rad - pose.heading_rad)) <= kPi / 4.0;
}

bool Ownship::on_hazard(const HazardReport& report) {
  return report.withdrawn ? hazards_.withdraw(report.hazard.id) : hazards_.add(report.hazard);
}

void Ownship::use_load() {
  if (loads_ > 0) --loads_;
}

void Ownship::come_home(Instant now) {
  if (!comes_home()) {
    hold(now);
  } else if (!flight_.homing() || now >= flight_.tries_home_at()) {
    fly_home(now);
  }
}

bool Ownship::at_home(Instant now) const {
  return flight_.at_home(now) && on_track(flight_.plan().timed);
}

bool Ownship::in_orbit(Instant now) const {
  const TimedPath& timed = flight_.plan().timed;
  return now >= timed.end_time() && on_track(timed);
}

bool Ownship::land(Instant now) {
  if (at_home(now)) return come_down(landing_of(spec(), flight_.first_pose()));
  constexpr int kDirections = 8;
  const Duration lap = from_seconds(lap_m() / spec().cruise_speed_mps);
  for (int i = 0; i < kDirections; ++i) {
    const Pose2 begin = flight_.pose_at(now + i * lap / kDirections);
    if (come_down(landing_after(spec(), begin))) return true;
  }
  return false;
}

bool Ownship::come_down(const Landing& landing) {
  if (spec().is_copter()) {
    const double from_m = std::min(spec().height_m, std::max(state_.z_m, approach_m()));
    descent_.emplace(landing, from_m, ground_m_.value_or(0.0));
    return true;
  }
  if (!is_open(landing, hazards(), config_.planning.avoidance.margin_m, config_.fence))
    return false;
  flight_.land(landing);
  return true;
}

bool Ownship::return_along(const TimedPath& way, Instant now) {
  return is_way_home(way, spec(), flight_, hazards(), range_to_spend(now), now) &&
         stays_in_fence(way.path, way.tail_curvature_per_m) && flight_.return_along(way, now);
}

bool Ownship::keep_fence(const Fence& fence) {
  const bool is_home_in =
      !flight_.started() || fence.inside_m(flight_.first_pose().position()) > 0.0;
  if (comes_home() && !is_home_in) return false;
  config_.fence = fence;
  flight_.set_fence(fence);
  return true;
}

bool Ownship::keeps_in(Instant now) {
  const TimedPath& timed = flight_.plan().timed;
  const double ahead_m = timed.distance_at(now);
  const auto rest = timed.piece(ahead_m, std::max(ahead_m, timed.path.length_m()));
  if (!rest || stays_in_fence(*rest, timed.tail_curvature_per_m)) return true;
  return plans_anew(now);
}

bool Ownship::plans_anew(Instant now) {
  if (flight_.homing()) {
    fly_home(now);
    return true;
  }
  if (!flight_.at_will()) return false;
  const bool searches = flight_.searching() || flight_.stands_by();
  searches ? search(now) : hold(now);  // RelayOrbit finds another place
  return true;
}

bool Ownship::plans_for_wind(Instant now) {
  const TimedPath& timed = flight_.plan().timed;
  const bool is_nearly_there = timed.path.length_m() - timed.distance_at(now) < lap_m();
  if (!flight_.homing() || !is_nearly_there) return plans_anew(now);
  flight_.orbit_anew(hazards(), now);
  return true;
}

bool Ownship::keeps_clear(Instant now) {
  const FlightPlan& plan = flight_.plan();
  if (plan.lands &&
      !is_open(plan.landing, hazards(), config_.planning.avoidance.margin_m, config_.fence)) {
    fly_home(now);  // it goes around
  }
  return flight_.keeps_clear(hazards(), now) || plans_anew(now);
}

bool Ownship::way_is_open(Instant now, std::optional<HazardId> news) const {
  const auto& timed = flight_.plan().timed;
  const double ahead = timed.distance_at(now);
  const auto rest = timed.piece(ahead, std::max(ahead, timed.path.length_m()));
  std::vector<Hazard> circles = hazards();
  for (Hazard& circle : circles) {
    if (config_.heeds_wind && circle.id == news) circle.radius_m += kFlownOff_m;
  }
  return rest && planning::is_clear(*rest, circles) && flight_.misses(rest->end(), hazards());
}

bool Ownship::stays_in_fence(const Path& way, double orbit_curvature_per_m) const {
  const Fence& fence = config_.fence;
  if (!fence.exists()) return true;
  const double wanted_m = std::clamp(fence.inside_m(way.start.position()), 0.0, kFlownOff_m);
  if (fence_room_m(fence, way) < wanted_m) return false;
  if (orbit_curvature_per_m == 0.0) return true;
  const Pose2 end = way.end();
  const double radius_m = 1.0 / orbit_curvature_per_m;
  const Vec2 centre = end.position() + radius_m * left_of(unit_vector(end.heading_rad));
  return fence_room_m(fence, centre, std::abs(radius_m)) >= wanted_m;
}

bool Ownship::leaves_fence(Instant now) const {
  if (!config_.fence.exists()) return false;
  if (!in_fence({state_.x_m, state_.y_m}) || state_.z_m > config_.fence.height_max_m) return true;
  const TimedPath& timed = flight_.plan().timed;
  const auto soon = timed.piece(timed.distance_at(now), timed.distance_at(now + kFenceAhead));
  return soon && !config_.fence.holds(*soon);
}

bool Ownship::on_arc(const Vec2& centre, double radius_m) const {
  constexpr double kShare = 0.1;
  const double distance_m = (state_.position().horizontal() - centre).norm();
  return std::abs(distance_m - radius_m) <= kShare * radius_m;
}

bool Ownship::on_track(const TimedPath& timed) const {
  const auto error = planning::follow_error(timed, state_, state_.time);
  return std::abs(error.along_m) < kOnTrackM && std::abs(error.cross_m) < kOnTrackM;
}

event::TaskFailed Ownship::off_path(Instant over, Instant planned) const {
  return {event::TaskFailure::off_path, planned,
          was_located(over) ? "" : "its flight controller did not tell where it was"};
}

double Ownship::along_m() const {
  return planning::follow_error(flight_.plan().timed, state_, state_.time).along_m;
}

bool Ownship::can(const TaskId& task) const {
  return spec().capabilities.has(task.kind) && (task.kind != TaskKind::deliver || loads_ > 0);
}

double Ownship::range_left(Instant at) const {
  const double until_then = std::max(0.0, to_seconds(at - state_.time)) * spec().cruise_speed_mps;
  return range_.left_m() - until_then;
}

double Ownship::range_to_spend(Instant at) const { return range_left(at) - lap_m(); }

double Ownship::range_for(const Site& site, Instant at) const {
  if (!comes_home()) return range_to_spend(at);
  const Pose2 there{site.position.x(), site.position.y(), 0.0};
  return range_to_spend(at) - flight_.way_home_m(there, hazards()) - spec().assess_radius_m -
         lap_m();
}

double Ownship::range_for_route(const TimedPath& route, Instant at) const {
  const Pose2 end = route.path.end();
  if (!comes_home()) return range_to_spend(at);
  if (flight_.started()) return range_to_spend(at) - flight_.way_home_m(end, hazards());
  // It starts where the route does.
  return range_to_spend(at) - (end.position() - route.path.start.position()).norm();
}

/// A metre of flight brings it at most a metre further from home, and its turn towards it takes a
/// lap at most.
double Ownship::lasts_s(double spare_m) const {
  return (spare_m - lap_m()) / (2.0 * spec().cruise_speed_mps);
}

double Ownship::spare_m(Instant now) const {
  const double second_m = 2.0 * spec().cruise_speed_mps;
  return range_to_spend(now) - flight_.way_home_m(flight_.pose_at(now), hazards()) - second_m;
}

event::RangeSpent Ownship::range_spent(Instant now) const {
  const double home_m = comes_home() ? flight_.way_home_m(flight_.pose_at(now), hazards()) : -1.0;
  return {range_left(now), comes_home(), home_m, range_.battery_decides()};
}

planning::Candidate Ownship::candidate(const Pose2& pose, Instant at) const {
  const VehicleSpec& vehicle = spec();
  return {vehicle.id,
          pose,
          vehicle.cruise_speed_mps,
          planning_radius_m(),
          range_left(at),
          vehicle.final_approach_m,
          vehicle.assess_radius_m,
          vehicle.capabilities,
          loads_};
}

Result<planning::TaskPlan> Ownship::plan_task(const planning::Candidate& self, Instant start,
                                              const Site& site,
                                              const TaskAssignment& assignment) const {
  auto plan = planning::plan_task(config_.planning, self, start, site, assignment,
                                  planning::with_room_for_arcs(hazards()));
  if (!plan || turn_room_.wind_mps() == Vec2{0.0, 0.0}) return plan;
  const bool delivers = assignment.task.kind == TaskKind::deliver;
  plan->timed = in_wind(plan->timed);
  plan->timed.on_time_m = delivers ? plan->timed.path.length_m() : plan->gate_m;
  return plan;
}

TimedPath Ownship::in_wind(TimedPath timed) const {
  timed.set_wind(turn_room_.wind_mps());
  return timed;
}

double Ownship::even_speed_mps(const Vec2& from, const Vec2& to, double seconds) const {
  const double cruise_mps = spec().cruise_speed_mps;
  if (seconds <= 0.0) return cruise_mps;
  const Vec2 through_air = (to - from) / (cruise_mps * seconds);
  TimedPath cruise;
  cruise.speed_mps = cruise_mps;
  return cruise_mps * (1.0 + in_wind(cruise).wind_per_speed().dot(shortened(through_air, 1.0)));
}

/// Where the way there has gone with the wind, and the approach against it.
Duration Ownship::approach_time() const {
  const VehicleSpec& vehicle = spec();
  TimedPath cruise;
  cruise.speed_mps = vehicle.cruise_speed_mps;
  const double longer = 1.0 + 2.0 * in_wind(cruise).wind_per_speed().norm();
  return from_seconds(vehicle.final_approach_m / vehicle.cruise_speed_mps * longer);
}

Telemetry Ownship::telemetry() const {
  Telemetry t;
  t.vehicle = spec().id;
  t.instance = config_.instance;
  t.state = state_;
  t.range_left_m = range_.left_m();
  t.loads = loads_;
  t.plan_number = flight_.plan().number;
  t.capabilities = spec().capabilities;
  return t;
}

}  // namespace skein::mission
