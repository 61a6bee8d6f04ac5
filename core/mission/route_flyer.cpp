// SPDX-License-Identifier: Apache-2.0
#include "route_flyer.hpp"

#include <cmath>
#include <utility>

#include "route_join.hpp"
#include "skein/base/angles.hpp"
#include "skein/planning/avoidance.hpp"
#include "skein/planning/fence_check.hpp"

namespace skein::mission {
namespace {

constexpr double kSlack = 1e-9;  ///< of a radius that was sent
constexpr double kSpeedMin_mps = 0.1;
constexpr double kLengthMin_m = 1.0;
constexpr double kLengthMax_m = 1e7;
/// A new way begins this far ahead, as those of Flight.
constexpr Duration kHandover = std::chrono::milliseconds{200};
/// Between the offer and the word to fly, at most: the way must be there then, too.
constexpr Duration kToldWithin = std::chrono::seconds{3};

/// On over the end, whatever it is late by, and around: as `route` of a configuration. None where
/// there is no room for it.
std::optional<TimedPath> completed(TimedPath timed, const VehicleSpec& vehicle) {
  timed.tail_curvature_per_m = 1.0 / vehicle.planning_radius_m();
  timed.paces.clear();
  if (!timed.path.append(Segment{0.0, 2.0 * vehicle.planning_radius_m()})) return std::nullopt;
  return timed;
}

bool has_sense(const TimedPath& timed) {
  const double length_m = timed.path.length_m();
  return timed.speed_mps >= kSpeedMin_mps && length_m >= kLengthMin_m && length_m <= kLengthMax_m;
}

}  // namespace

void RouteFlyer::on_route(const Route& message, const RouteStanding& standing, Instant now) {
  if (message.vehicle != ownship_.spec().id || message.plan < plan_) return;
  if (standing.orders_unknown) return;  // it is told again
  if (message.plan > plan_) take(message);
  const auto before = state_;
  switch (message.step) {
    case RouteStep::offer:
      if (!state_) offered(standing, now);
      break;
    case RouteStep::fly:
      if (!state_ || state_ == RouteState::taken) told_to_fly(standing, now);
      break;
    case RouteStep::call_off:
      called_off(standing, now);
      break;
    case RouteStep::count:
      return;
  }
  if (state_ == before) say();
}

void RouteFlyer::take(const Route& message) {
  plan_ = message.plan;
  state_.reset();
  why_ = RouteObstacle::nothing;
  begins_ = false;
  route_ = has_sense(message.timed) ? completed(message.timed, ownship_.spec()) : std::nullopt;
}

void RouteFlyer::offered(const RouteStanding& standing, Instant now) {
  const RouteObstacle why = obstacle(standing, now + kToldWithin, now);
  answer(why == RouteObstacle::nothing ? RouteState::taken : RouteState::refused, why, now);
}

void RouteFlyer::told_to_fly(const RouteStanding& standing, Instant now) {
  const Instant at = now + kHandover;
  const RouteObstacle why = obstacle(standing, at, now);
  if (why != RouteObstacle::nothing) {
    const bool begun = route_ && now >= route_->start_time;
    return answer(begun ? RouteState::left : RouteState::refused, why, now);
  }
  if (!ownship_.flight().started()) {
    ownship_.give_route(*route_);
    begins_ = true;
  } else {
    ownship_.flight().fly_route(*way(at, now), now);
  }
  answer(RouteState::flies, RouteObstacle::nothing, now);
}

void RouteFlyer::called_off(const RouteStanding& standing, Instant now) {
  const bool over = state_ && *state_ > RouteState::flies;
  if (over) return;
  const bool flew = flies() && ownship_.flight().started() && ownship_.flight().en_route(now);
  ownship_.take_route_back();
  answer(RouteState::called_off, RouteObstacle::nothing, now);
  if (flew && !standing.obeys_others && !standing.setup_differs) ownship_.search(now);
}

RouteObstacle RouteFlyer::fault_of_route() const {
  if (!route_) return RouteObstacle::no_route;
  const VehicleSpec& vehicle = ownship_.spec();
  const double tightest = (1.0 + kSlack) / vehicle.planning_radius_m();
  if (route_->path.curvature_max_per_m() > tightest) return RouteObstacle::too_tight;
  if (route_->speed_mps < vehicle.speed_min_mps || route_->speed_mps > vehicle.speed_max_mps) {
    return RouteObstacle::wrong_speed;
  }
  return RouteObstacle::nothing;
}

RouteObstacle RouteFlyer::obstacle(const RouteStanding& standing, Instant at, Instant now) const {
  if (const auto fault = fault_of_route(); fault != RouteObstacle::nothing) return fault;
  if (standing.setup_differs) return RouteObstacle::setup_differs;
  if (standing.obeys_others) return RouteObstacle::obeys_others;
  if (standing.has_task) return RouteObstacle::has_task;
  // What is left of it, and a lap of the orbit at its end.
  const double left_m = route_->distance_at(now);
  const double end_m = route_->path.length_m();
  const double lap_m = kTwoPi / std::abs(route_->tail_curvature_per_m);
  if (left_m >= end_m) return RouteObstacle::out_of_reach;
  const auto ahead = route_->piece(left_m, end_m + lap_m);
  if (!ahead) return RouteObstacle::no_route;
  if (!planning::is_clear(*ahead, ownship_.hazards()) ||
      planning::first_outside(ownship_.config().fence, *ahead)) {
    return RouteObstacle::into_hazard;
  }
  if (ownship_.range_for_route(*route_, now) < end_m - left_m) return RouteObstacle::out_of_range;
  if (!ownship_.flight().started()) return RouteObstacle::nothing;
  const auto there = way(at, now);
  if (!there) return RouteObstacle::out_of_reach;
  if (planning::first_outside(ownship_.config().fence, there->path))
    return RouteObstacle::into_hazard;
  return RouteObstacle::nothing;
}

std::optional<TimedPath> RouteFlyer::way(Instant at, Instant now) const {
  return way_onto_route({ownship_.flight().plan().timed, *route_, ownship_.spec(),
                         ownship_.config().planning.avoidance, ownship_.hazards(),
                         ownship_.range_for_route(*route_, now)},
                        at, now);
}

void RouteFlyer::step(const RouteStanding& standing, Instant now) {
  if (state_ == RouteState::taken && now >= route_->start_time) {
    return answer(RouteState::refused, RouteObstacle::not_told, now);
  }
  if (!flies() || !ownship_.flight().started()) return;
  if (std::exchange(begins_, false) && !ownship_.flight().en_route(now)) {
    // It has started elsewhere, or took off late.
    const auto why = obstacle(standing, now + kHandover, now);
    if (why != RouteObstacle::nothing) return answer(RouteState::left, why, now);
    ownship_.flight().fly_route(*way(now + kHandover, now), now);
  }
  if (now >= route_->end_time()) {
    answer(RouteState::flown, RouteObstacle::nothing, now);
  } else if (!ownship_.flight().en_route(now)) {
    answer(RouteState::left, why_left(standing), now);
  }
}

RouteObstacle RouteFlyer::why_left(const RouteStanding& standing) const {
  if (standing.setup_differs) return RouteObstacle::setup_differs;
  if (standing.obeys_others) return RouteObstacle::obeys_others;
  return standing.has_task ? RouteObstacle::has_task : RouteObstacle::into_hazard;
}

void RouteFlyer::answer(RouteState state, RouteObstacle why, Instant now) {
  state_ = state;
  why_ = why;
  outbox_.report(event::RouteAnswered{plan_, state, why}, {}, {}, now);
  say();
}

void RouteFlyer::say() {
  if (!state_) return;
  outbox_.messages.push(
      Message{RouteStatus{ownship_.spec().id, ownship_.config().instance, plan_, *state_, why_}});
}

}  // namespace skein::mission
