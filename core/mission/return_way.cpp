// SPDX-License-Identifier: Apache-2.0
#include "return_way.hpp"

#include <cmath>

#include "skein/base/angles.hpp"

namespace skein::mission {
namespace {

/// It begins where the plan has the vehicle that it follows, to this.
constexpr double kSamePlace_m = 1.0;
constexpr double kSameHeading_rad = 0.05;
/// Orbits beside each other may be so far from home.
constexpr double kHomeWithin_m = 2'000.0;
constexpr double kLengthMax_m = 1e7;
constexpr double kSlack = 1e-9;  ///< of a radius that was sent
/// A new way begins this far ahead, as those of Flight.
constexpr Duration kHandover = std::chrono::milliseconds{200};

bool is_flyable(const TimedPath& way, const VehicleSpec& vehicle) {
  const double tightest = (1.0 + kSlack) / vehicle.planning_radius_m();
  const double tail = std::abs(way.tail_curvature_per_m);
  return way.speed_mps >= vehicle.speed_min_mps && way.speed_mps <= vehicle.speed_max_mps &&
         tail * kLengthMax_m > 1.0 && tail <= tightest && way.paces.empty() &&
         way.on_time_m == 0.0 && way.path.curvature_max_per_m() <= tightest &&
         way.path.length_m() <= kLengthMax_m;
}

}  // namespace

bool is_way_home(const TimedPath& way, const VehicleSpec& vehicle, const Flight& flight,
                 const std::vector<Hazard>& hazards, double range_m, Instant now) {
  if (!flight.started() || !flight.homing() || !is_flyable(way, vehicle)) return false;
  if (way.start_time < now + kHandover) return false;
  const Pose2 there = flight.pose_at(way.start_time);
  const Pose2& begin = way.path.start;
  if ((there.position() - begin.position()).norm() > kSamePlace_m ||
      std::abs(wrap_pi(there.heading_rad - begin.heading_rad)) > kSameHeading_rad) {
    return false;
  }
  const double length_m = way.path.length_m();
  const auto all = way.piece(0.0, length_m + kTwoPi / std::abs(way.tail_curvature_per_m));
  const double until_then_m = to_seconds(way.start_time - now) * vehicle.cruise_speed_mps;
  return all && flight.keeps_off(*all, hazards) && until_then_m + length_m <= range_m &&
         (way.path.end().position() - flight.home()).norm() <= kHomeWithin_m;
}

}  // namespace skein::mission
