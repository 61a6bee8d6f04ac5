// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "outbox.hpp"
#include "ownship.hpp"

namespace skein::mission {

/// What else of a vehicle decides whether it flies a route.
struct RouteStanding {
  bool orders_unknown = false;  ///< it answers nothing yet
  bool setup_differs = false;
  bool obeys_others = false;  ///< held, sent home, or its range is spent
  bool has_task = false;
};

/// The route that the ground station gives this vehicle. Offered, it is judged by what the vehicle
/// itself is, knows and does, whatever it was planned with; told to fly, the vehicle leaves what it
/// flies so that it is on the route in time, and without a plan yet begins with it. A vehicle that
/// starts anew is told again, and goes on where it is near the route. Tasks, hazards and the
/// operator's orders come before a route, and end it.
class RouteFlyer {
 public:
  RouteFlyer(Ownship& ownship, Outbox& outbox) : ownship_{ownship}, outbox_{outbox} {}

  /// To this vehicle or another one.
  void on_route(const Route& message, const RouteStanding& standing, Instant now);
  /// With every state: what became of the route.
  void step(const RouteStanding& standing, Instant now);
  /// It is told to fly a route, and does or is about to.
  [[nodiscard]] bool flies() const { return state_ == RouteState::flies; }
  /// Something is to become of the route: step() looks.
  [[nodiscard]] bool awaits() const { return flies() || state_ == RouteState::taken; }

 private:
  void take(const Route& message);
  void offered(const RouteStanding& standing, Instant now);
  void told_to_fly(const RouteStanding& standing, Instant now);
  void called_off(const RouteStanding& standing, Instant now);
  /// Why it does not fly it from `at` on; `nothing` where it does.
  [[nodiscard]] RouteObstacle obstacle(const RouteStanding& standing, Instant at,
                                       Instant now) const;
  [[nodiscard]] RouteObstacle fault_of_route() const;
  [[nodiscard]] std::optional<TimedPath> way(Instant at, Instant now) const;
  [[nodiscard]] RouteObstacle why_left(const RouteStanding& standing) const;
  void answer(RouteState state, RouteObstacle why, Instant now);
  void say();

  Ownship& ownship_;
  Outbox& outbox_;
  std::uint32_t plan_ = 0;
  std::optional<TimedPath> route_;   ///< with how it goes on beyond; none where it is no route
  std::optional<RouteState> state_;  ///< none before its answer
  RouteObstacle why_ = RouteObstacle::nothing;
  bool begins_ = false;  ///< told to fly before the vehicle had a plan
};

}  // namespace skein::mission
