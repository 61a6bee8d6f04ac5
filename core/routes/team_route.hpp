// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/domain/hazard.hpp"
#include "skein/domain/path.hpp"
#include "skein/routes/optimiser.hpp"
#include "skein/routes/route_problem.hpp"

namespace skein::routes {

/// A flyable route of a vehicle along a corridor, as short as it can be.
struct BaseRoute {
  std::vector<Vec2> waypoints;
  double length_m = 0.0;
};

/// The closed hazards as circles, with their clearance.
[[nodiscard]] std::vector<Hazard> closed_circles(const RouteProblem& problem);

/// What the climb alone asks for.
[[nodiscard]] double climb_length_m(const RouteProblem& problem, const RouteVehicle& vehicle);

/// No route of the vehicle is shorter. Infinite where there is none.
[[nodiscard]] double length_bound_m(const RouteProblem& problem, const RouteVehicle& vehicle);

/// Shortest first; last legs of several lengths.
[[nodiscard]] std::vector<BaseRoute> base_routes(const RouteProblem& problem,
                                                 const RouteVehicle& vehicle,
                                                 std::size_t corridors);

/// Two detours of a base route, as an optimiser's numbers, each: which leg, where along it, how
/// much of it, which side and how lopsided; and how the missing length is shared.
class Extension {
 public:
  Extension(const BaseRoute& base, double turn_radius_m, double target_m)
      : base_{base}, turn_radius_m_{turn_radius_m}, target_m_{target_m} {}

  [[nodiscard]] static Box box();
  /// The route of exactly the target's length; false where none was found. `fresh`, by waypoint:
  /// what was not in the base route.
  bool apply(std::span<const double> point, std::vector<Vec2>& waypoints,
             std::vector<char>& fresh) const;

 private:
  struct Detour;
  [[nodiscard]] Detour detour(std::span<const double> numbers) const;
  void build(const Detour* first, const Detour* second, std::vector<Vec2>& waypoints,
             std::vector<char>& fresh) const;

  const BaseRoute& base_;
  double turn_radius_m_;
  double target_m_;
};

/// A route in time, from 0 to its end, and its positions at every `step_s`, which is the same for
/// all routes that are compared.
class TimedRoute {
 public:
  TimedRoute(const Path& path, const RouteVehicle& vehicle, const RouteRules& rules, double step_s);

  [[nodiscard]] double end_s() const { return times_s_.back(); }
  /// When its last straight leg begins.
  [[nodiscard]] double last_leg_s() const { return times_s_[times_s_.size() - 2]; }
  [[nodiscard]] double speed_mps() const { return speed_mps_; }
  [[nodiscard]] double height_m(double t) const {
    return t >= level_s_ ? arrival_height_m_ : start_height_m_ + climb_mps_ * t;
  }
  [[nodiscard]] double climb_mps() const { return climb_mps_; }
  /// `piece`: where to look first; for times that only grow.
  [[nodiscard]] Vec2 at(double t, std::size_t& piece) const;

  [[nodiscard]] double step_s() const { return step_s_; }
  [[nodiscard]] const std::vector<Vec2>& track() const { return track_; }

 private:
  std::vector<Pose2> poses_;  ///< at the beginning of every piece
  std::vector<Vec2> directions_;
  std::vector<double> curvatures_;
  std::vector<double> times_s_;  ///< of the beginnings, and the end
  std::vector<Vec2> track_;      ///< at 0, step_s_, ..., before the end
  double step_s_;
  double speed_mps_;
  double start_height_m_;
  double arrival_height_m_;
  double level_s_;
  double climb_mps_;
};

/// By how much two routes come too near, metres; 0: not at all.
[[nodiscard]] double separation_deficit_m(const TimedRoute& a, const TimedRoute& b,
                                          const RouteRules& rules);

/// Spacing cost of two routes (Wu 2022, eq. 35): mean over their tracks' common time of
/// (1 - tanh((d - d_s) / d_s)) / 2 + (1 + tanh((d - d_c) / d_s)) / 2.
[[nodiscard]] double spacing_cost(const TimedRoute& a, const TimedRoute& b,
                                  const RouteRules& rules);

/// Costs of a route (eq. 26), exposure over equal distances flown.
[[nodiscard]] RouteCosts route_costs(const RouteProblem& problem, std::span<const Vec2> waypoints,
                                     const Path& path);

/// Judges candidates for one vehicle, given the routes of others.
class RouteJudge {
 public:
  RouteJudge(const RouteProblem& problem, const RouteVehicle& vehicle,
             std::span<const Hazard> circles, std::span<const TimedRoute> others, double step_s)
      : problem_{problem}, vehicle_{vehicle}, circles_{circles}, others_{others}, step_s_{step_s} {}

  /// Below kInfeasible: keeps to every rule, the value is its cost. Above: comes too near to
  /// others; from kUnflyable on: breaks other rules. The more, the more. Pieces between waypoints
  /// that are not fresh are taken to be clear of hazards.
  [[nodiscard]] double judge(std::span<const Vec2> waypoints, std::span<const char> fresh) const;

  static constexpr double kInfeasible = 1e3;
  static constexpr double kUnflyable = 3e3;

 private:
  [[nodiscard]] double rules_broken(std::span<const Vec2> waypoints) const;
  [[nodiscard]] double hazards_entered(std::span<const Vec2> waypoints,
                                       std::span<const char> fresh) const;

  const RouteProblem& problem_;
  const RouteVehicle& vehicle_;
  std::span<const Hazard> circles_;
  std::span<const TimedRoute> others_;
  double step_s_;
};

}  // namespace skein::routes
