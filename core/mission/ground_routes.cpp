// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/ground_routes.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "names.hpp"
#include "skein/base/angles.hpp"
#include "skein/planning/avoidance.hpp"
#include "skein/planning/fence_check.hpp"
#include "told_at_once.hpp"

namespace skein::mission {
namespace {

constexpr Duration kTellAgain = std::chrono::seconds{1};
/// Who flies is asked now and then how far it is.
constexpr Duration kAskAgain = std::chrono::seconds{5};
/// All must have taken theirs so long before the plan begins, or there is no time to tell them.
constexpr Duration kAllTakenBefore = std::chrono::seconds{2};
constexpr Duration kBegunWithin = std::chrono::seconds{3};
/// Who has not heard that a plan is called off gives it up by itself, or is lost.
constexpr Duration kCalledOffFor = std::chrono::seconds{60};
constexpr Duration kOverAfter = std::chrono::seconds{60};  ///< the last route's end
constexpr double kAtStart_m = 50.0;
/// A vehicle may hurry to where its route begins, by so much at most.
constexpr double kHurry = 1.5;

/// What it takes to tell so many, beyond a moment.
Duration telling_takes(std::size_t vehicles) {
  return static_cast<std::int64_t>(vehicles / (kToldAtOnce + 1)) * kToldEvery;
}

bool has_ended(const GivenRoute& route) {
  return route.answer && *route.answer != RouteState::taken && *route.answer != RouteState::flies;
}

bool answers(const GivenRoute& route, RouteStep step) {
  if (!route.answer) return false;
  if (route.released) return has_ended(route);
  return step == RouteStep::offer || *route.answer != RouteState::taken;
}

/// Beyond the end: straight on, and around as tightly as the route itself turns.
Path with_way_on(const TimedPath& timed) {
  Path path = timed.path;
  const double curvature = path.curvature_max_per_m();
  const double radius_m = curvature > 0.0 ? 1.0 / curvature : 1.0;
  (void)(path.append(Segment{0.0, 2.0 * radius_m}) &&
         path.append(Segment{1.0 / radius_m, kTwoPi * radius_m}));
  return path;
}

std::string whole(double metres) { return std::to_string(std::lround(metres)); }

Result<void> check_one(VehicleId id, const TimedPath& timed, const std::vector<Hazard>& hazards,
                       const Fence& fence, const Fleet& fleet, Instant now) {
  const auto known = fleet.vehicles().find(id);
  if (known == fleet.vehicles().end() || !known->second.expected) {
    return Error{name_of(id) + " has a route, and is not in the fleet"};
  }
  if (auto why = fleet.why_not_with(id)) return Error{*why};
  const FleetEntry& entry = known->second;
  if (!entry.telemetry || entry.silent) return Error{name_of(id) + " is not heard"};
  const Telemetry& telemetry = *entry.telemetry;
  if (telemetry.activity == Activity::holding) {
    return Error{name_of(id) + " holds; let it resume before it is given a route"};
  }
  if (telemetry.activity == Activity::landing || telemetry.activity == Activity::landed) {
    return Error{name_of(id) + " lands, or has; it is given no route"};
  }
  if (telemetry.activity == Activity::forming) {
    return Error{name_of(id) + " flies in a formation"};
  }
  const Path path = with_way_on(timed);
  if (const Hazard* hazard = planning::first_entered(path, hazards)) {
    return Error{"the route of " + name_of(id) + " enters hazard " +
                 std::to_string(hazard->id.value) + "; plan it anew"};
  }
  if (const auto out = planning::first_outside(fence, path)) {
    return Error{"the route of " + name_of(id) + " leads out of the fence at " +
                 planning::place_text(*out) + "; plan it anew"};
  }
  const Vec2 at{telemetry.state.x_m, telemetry.state.y_m};
  const double away_m = (at - timed.path.start.position()).norm();
  if (timed.path.length_m() + away_m > telemetry.range_left_m) {
    return Error{"the route of " + name_of(id) + ", with the way to it, is longer than the " +
                 whole(telemetry.range_left_m) + " m that are left of its range"};
  }
  const double time_s = to_seconds(timed.start_time - std::max(now, Instant{}));
  if (away_m > std::max(kAtStart_m, kHurry * timed.speed_mps * time_s)) {
    return Error{name_of(id) + " is " + whole(away_m) +
                 " m from where its route begins, and cannot be there in time; begin later"};
  }
  return {};
}

}  // namespace

// --- what is heard, and was said ---

void GroundRoutes::recall(const Message& message, VehicleId sender, Instant at) {
  const auto* route = std::get_if<Route>(&message);
  if (sender != kGroundStation) {
    on_message(message, at);
  } else if (route != nullptr) {
    recall_own(*route, at);
  }
}

void GroundRoutes::recall_own(const Route& route, Instant at) {
  if (given_ && route.plan < given_->plan) return;
  if (!given_ || route.plan > given_->plan) {
    given_.emplace();
    given_->plan = route.plan;
    given_->begins = route.timed.start_time;
  }
  GivenRoutes& plan = *given_;
  GivenRoute& entry = plan.routes[route.vehicle];
  entry.timed = route.timed;
  entry.released = route.step == RouteStep::call_off;
  // One that alone was called off was released.
  const bool is_for_all = !entry.released || std::ranges::all_of(plan.routes, [](const auto& r) {
    return r.second.released;
  });
  if (route.step > plan.step && is_for_all) {
    plan.step = route.step;
    plan.step_at = at;
    for (auto& [id, known] : plan.routes) known.told_since = answers(known, plan.step);
  }
  // Nobody looked while this program was down: who has not begun says so, and is told alone.
  plan.begun = plan.step == RouteStep::fly && at >= plan.begins;
  next_ = at;
}

void GroundRoutes::on_message(const Message& message, Instant now) {
  if (const auto* status = std::get_if<RouteStatus>(&message)) on_status(*status, now);
}

void GroundRoutes::on_status(const RouteStatus& status, Instant now) {
  if (!given_ || status.plan != given_->plan) return;
  const auto known = given_->routes.find(status.vehicle);
  if (known == given_->routes.end()) return;
  GivenRoute& route = known->second;
  route.answer = status.state;
  route.why = status.why;
  route.instance = status.instance;
  route.told_since = answers(route, given_->step);
  if (!given_->over) next_ = std::min(next_, now);
}

// --- orders ---

Result<void> GroundRoutes::check(const Routes& routes, const std::vector<Hazard>& hazards,
                                 const Fleet& fleet, Instant now) const {
  if (routes.empty()) return Error{"the plan has no routes"};
  if (routes.size() > kVehiclesMax) {
    return Error{"the plan is of " + std::to_string(routes.size()) + " vehicles, and " +
                 std::to_string(kVehiclesMax) + " are the most of one; give it in several"};
  }
  const Instant begins = routes.begin()->second.start_time;
  if (begins < now + kNotice + 2 * telling_takes(routes.size())) {
    return Error{"the plan begins too soon for all to answer; begin it later, as in 'in 60'"};
  }
  if (stands()) {
    return Error{"the routes of plan " + std::to_string(given_->plan) +
                 " are not over; 'withdraw routes' calls them off"};
  }
  for (const auto& [id, timed] : routes) {
    if (auto good = check_one(id, timed, hazards, fence_, fleet, now); !good) return good;
  }
  return {};
}

Result<std::uint32_t> GroundRoutes::give(const Routes& routes, const std::vector<Hazard>& hazards,
                                         const Fleet& fleet, Instant now, RouteBond bond) {
  if (auto good = check(routes, hazards, fleet, now); !good) return good.error();
  // Numbers grow also over a restart of this process, or vehicles would take a new plan for old.
  const auto since_epoch = std::chrono::duration_cast<std::chrono::milliseconds>(
                               std::max(now, Instant{}).time_since_epoch())
                               .count();
  const std::uint32_t last = given_ ? given_->plan : 0;
  given_.emplace();
  given_->plan = std::max(last, static_cast<std::uint32_t>(since_epoch)) + 1;
  given_->begins = routes.begin()->second.start_time;
  given_->step_at = now;
  given_->bond = bond;
  for (const auto& [id, timed] : routes) given_->routes[id].timed = timed;
  report(event::RoutesGiven{given_->plan, static_cast<std::uint16_t>(routes.size()), given_->begins,
                            false},
         now);
  next_ = now;
  return given_->plan;
}

Result<void> GroundRoutes::call_off(Instant now) {
  if (!stands() || given_->step == RouteStep::call_off) {
    return Error{"there are no routes to be called off"};
  }
  given_->by_operator = true;
  call_off({given_->plan, RoutesEnd::by_operator, {}, RouteObstacle::nothing}, now);
  return {};
}

bool GroundRoutes::release(VehicleId vehicle, Instant now) {
  if (!stands() || !given_->begun) return false;
  const auto known = given_->routes.find(vehicle);
  if (known == given_->routes.end() || known->second.released || has_ended(known->second)) {
    return false;
  }
  leave_out(known->second, now);
  next_ = now;
  return true;
}

void GroundRoutes::leave_out(GivenRoute& route, Instant now) {
  route.released = true;
  route.released_at = now;
  route.told_since = false;
  route.next = now;
}

// --- what becomes of them ---

void GroundRoutes::take_step(RouteStep step, Instant now) {
  given_->step = step;
  given_->step_at = now;
  for (auto& [id, route] : given_->routes) {
    route.told_since = answers(route, step) && (step != RouteStep::call_off || has_ended(route));
    route.next = now;
  }
}

void GroundRoutes::call_off(const event::RoutesCalledOff& why, Instant now) {
  take_step(RouteStep::call_off, now);
  report(why, now);
  next_ = now;
}

void GroundRoutes::decide_offer(Instant now) {
  GivenRoutes& plan = *given_;
  const bool alone = plan.bond == RouteBond::each_alone;
  const VehicleId* silent = nullptr;
  const VehicleId* refused = nullptr;
  std::size_t taken = 0;
  for (const auto& [id, route] : plan.routes) {
    if (has_ended(route)) {
      if (alone || refused == nullptr) refused = &id;
    } else if (route.answer) {
      ++taken;
    } else if (silent == nullptr) {
      silent = &id;
    }
  }
  const bool none_left = taken == 0 && silent == nullptr;
  if (refused != nullptr && (!alone || none_left)) {
    const RouteObstacle why = plan.routes.at(*refused).why;
    return call_off({plan.plan, RoutesEnd::route_refused, *refused, why}, now);
  }
  if (silent != nullptr) {
    if (now < plan.begins - kAllTakenBefore - telling_takes(plan.routes.size())) return;
    if (!alone || taken == 0) {
      return call_off({plan.plan, RoutesEnd::not_answered, *silent, RouteObstacle::nothing}, now);
    }
    for (auto& [id, route] : plan.routes) {
      if (!route.answer) leave_out(route, now);
    }
  }
  take_step(RouteStep::fly, now);
  report(event::RoutesGiven{plan.plan, static_cast<std::uint16_t>(plan.routes.size()), plan.begins,
                            true},
         now);
}

void GroundRoutes::decide_flight(Instant now) {
  GivenRoutes& plan = *given_;
  if (plan.begun) return;
  const bool alone = plan.bond == RouteBond::each_alone;
  for (const auto& [id, route] : plan.routes) {
    if (alone || route.answer == RouteState::flown || !has_ended(route)) continue;
    return call_off({plan.plan, RoutesEnd::route_refused, id, route.why}, now);
  }
  if (now < plan.begins + kBegunWithin) return;
  plan.begun = true;
  for (auto& [id, route] : plan.routes) {
    if (route.answer == RouteState::flies || route.answer == RouteState::flown) continue;
    if (!alone) return call_off({plan.plan, RoutesEnd::not_begun, id, RouteObstacle::nothing}, now);
    if (!has_ended(route) && !route.released) leave_out(route, now);
  }
}

void GroundRoutes::decide(Instant now) {
  GivenRoutes& plan = *given_;
  if (plan.step == RouteStep::offer) decide_offer(now);
  if (plan.step == RouteStep::fly) decide_flight(now);
  Instant end = plan.begins;
  for (const auto& [id, route] : plan.routes) end = std::max(end, route.timed.end_time());
  const bool all_ended = std::ranges::all_of(plan.routes, [now](const auto& r) {
    const bool given_up = r.second.released && now >= r.second.released_at + kCalledOffFor;
    return has_ended(r.second) || given_up;
  });
  plan.over = (plan.step == RouteStep::call_off && now >= plan.step_at + kCalledOffFor) ||
              (plan.step != RouteStep::offer && all_ended) || now >= end + kOverAfter;
}

bool GroundRoutes::tell(const Fleet& fleet, Instant now) {
  GivenRoutes& plan = *given_;
  std::size_t told = 0;
  // On from whom was told last, or the first would be told again before the last are told once.
  auto next = plan.routes.upper_bound(told_last_);
  for (std::size_t i = 0; i < plan.routes.size(); ++i, ++next) {
    if (next == plan.routes.end()) next = plan.routes.begin();
    auto& [id, route] = *next;
    const auto known = fleet.vehicles().find(id);
    const bool anew = route.instance && known != fleet.vehicles().end() &&
                      known->second.telemetry &&
                      known->second.telemetry->instance != *route.instance;
    if (anew && route.answer != RouteState::flown) {
      route.answer.reset();
      route.instance.reset();
      route.told_since = false;
      route.next = now;
    }
    if (route.told_since && has_ended(route)) {
      route.next = Instant::max();
    } else if (now >= route.next) {
      if (told == kToldAtOnce) return false;
      ++told;
      told_last_ = id;
      const RouteStep step = route.released ? RouteStep::call_off : plan.step;
      messages_.push(Message{Route{id, plan.plan, step, route.timed}});
      const bool flies = route.told_since && plan.step == RouteStep::fly;
      route.next = now + (flies ? kAskAgain : kTellAgain);
    }
  }
  return true;
}

void GroundRoutes::on_timeout(const Fleet& fleet, Instant now) {
  if (!stands()) return;
  decide(now);
  if (given_->over) {
    next_ = Instant::max();
    return;
  }
  if (now < tell_at_) {  // an answer came
    next_ = tell_at_;
    return;
  }
  const bool all = tell(fleet, now);
  if (!all) tell_at_ = now + kToldEvery;
  next_ = all ? now + kTellAgain : tell_at_;
}

void GroundRoutes::report(EventBody body, Instant now) {
  events_.push({kGroundStation, now, {}, {}, std::move(body)});
}

}  // namespace skein::mission
