// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "skein/base/geometry.hpp"
#include "skein/base/ids.hpp"
#include "skein/base/time.hpp"
#include "skein/domain/hazard.hpp"
#include "skein/domain/path.hpp"
#include "skein/planning/avoidance.hpp"

namespace skein::planning {

/// A vehicle on its way home, or there: mission frame, SI units.
struct ReturningVehicle {
  VehicleId id;
  Pose2 start;
  Instant start_time{};    ///< when it is there
  double height_m = 0.0;   ///< that it keeps
  double speed_mps = 0.0;  ///< over the ground, in a wind through the air; it flies no faster
  /// It may fly the whole way at less, down to this; in a wind it does not.
  double speed_min_mps = 0.0;
  Vec2 wind_mps{0.0, 0.0};     ///< that its times count with
  double turn_radius_m = 0.0;  ///< of its paths, and of its orbit at home
  double range_left_m = 0.0;   ///< from the start: its way home and one lap there
  Vec2 home{0.0, 0.0};         ///< its orbit passes here, or as near as others leave room for
  std::optional<double> arrival_heading_rad = {};  ///< over home; none: any
  /// It keeps to that, and the others keep clear of it. Of one speed (over the ground, or in a wind
  /// from its begin on), to an orbit. Nothing is
  /// planned for it, and of the rest its id, height and home alone are read.
  std::optional<TimedPath> flies = {};
};

struct ReturnParams {
  /// Two vehicles nearer than both of these at once are in conflict.
  double separation_horizontal_m = 30.0;
  double separation_vertical_m = 5.0;
  /// Between any two arrivals where homes are not further from each other than `runway_m`.
  Duration arrival_spacing{};
  double runway_m = 300.0;
  double hold_within_m =
      1500.0;  ///< of home an orbit may pass, where homes are too near each other
  Duration delay_max = std::chrono::minutes{15};  ///< of an arrival, for others
  AvoidanceParams avoidance{};
  std::size_t orders = 12;          ///< of priority that are tried
  std::size_t tries = 5'000;        ///< ways of one vehicle that are looked at, in one order
  std::size_t tries_all = 300'000;  ///< of all in all orders: then no other order is tried
};

struct ReturnFlight {
  VehicleId vehicle;
  TimedPath timed;          ///< to its orbit; the tail is the orbit
  double off_home_m = 0.0;  ///< of the orbit, at its nearest
};

enum class ReturnObstacle : std::uint8_t {
  bad_request,      ///< numbers without sense, an id that is there twice, or no such way
  no_way,           ///< clear of hazards
  no_room_to_hold,  ///< near home, clear of hazards and of others that hold there
  out_of_range,     ///< by `short_m`, on the shortest way
  others,           ///< `other` is in the way for as long as its range or ReturnParams let it wait
  count
};

/// A vehicle that has been given no way, and why. The others' ways know nothing of where it flies.
struct ReturnFailure {
  VehicleId vehicle;
  ReturnObstacle why = ReturnObstacle::bad_request;
  VehicleId other{};     ///< of `others`: who was in the way most often
  double short_m = 0.0;  ///< of `out_of_range`
};
/// Why, and what to do: the sentence after the vehicle's name.
[[nodiscard]] std::string reason_of(const ReturnFailure& failure);

struct CollectiveReturn {
  std::vector<ReturnFlight> flights;    ///< in order of the request, without who flies already
  std::vector<ReturnFailure> failures;  ///< in order of the request
  Instant last_arrival{};               ///< at an orbit; of no flights: the epoch
  double length_m = 0.0;                ///< of all ways
};

/// Ways home of all vehicles together: any two are apart by the separation from the moment at which
/// both have started, for good, orbits included; no way turns tighter than its vehicle, enters a
/// hazard, or takes more than the range that is left. Arrivals at one runway keep their spacing.
///
/// First every vehicle is given its orbit: at home, or where homes leave no room for two orbits at
/// one height, on a lattice around. Then prioritised planning (Erdmann & Lozano-Perez 1987, doi
/// 10.1007/BF01840371): one after another, each takes the earliest way clear of those before it.
/// Its ways are the shortest around hazards, the shortest around the orbits of all others besides,
/// and some detours; each also later, by flying it slower, or by laps on the way, as wide as the
/// delay asks for. As in the revised algorithm (Cap et al. 2015, doi 10.1109/TASE.2015.2445780) it
/// leaves alone where those after it can wait in laps, as long as it can.
/// Two ways are compared by conservative advancement (Mirtich 1996): steps that cannot leap over a
/// conflict, so there is no sampling to be too coarse. A vehicle in its orbit is anywhere on it, so
/// that being late or early there does not matter.
/// Orders of priority: first come first, least range first, furthest first; then who has failed
/// goes to the front (Bennewitz et al. 2002, doi 10.1016/S0921-8890(02)00256-7). The best by fewest
/// failures, last arrival, length is taken. All of that is deterministic. Prioritised planning is
/// not complete: who fails might have a way that none of these orders finds.
/// What it takes: ./dev bench collective_return.
[[nodiscard]] CollectiveReturn plan_return(const ReturnParams& params,
                                           std::span<const ReturningVehicle> vehicles,
                                           std::span<const Hazard> hazards);

/// The same in one order of priority. Precondition: `order` is a permutation of the indices.
[[nodiscard]] CollectiveReturn plan_return_in_order(const ReturnParams& params,
                                                    std::span<const ReturningVehicle> vehicles,
                                                    std::span<const Hazard> hazards,
                                                    std::span<const std::size_t> order);

}  // namespace skein::planning
