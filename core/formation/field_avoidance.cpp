// SPDX-License-Identifier: Apache-2.0
#include "skein/formation/field_avoidance.hpp"

#include <algorithm>
#include <cmath>

#include "skein/base/shortened.hpp"

namespace skein::formation {
namespace {

constexpr double kNearest = 0.01;  // the force has no direction nearer than that

/// As fast as the limits let it stop in, with half of the deceleration kept for the push.
Vec3 attraction(const FieldParams& params, const MotionLimits& limits, const FieldSelf& self,
                double period_s) {
  const Vec3 way = self.goal_m - self.position_m;
  const double distance = way.norm();
  if (distance <= 0.0) return Vec3::Zero();
  const double speed =
      std::min({self.arrival_share * std::min(params.speed_mps, limits.speed_mps),
                std::sqrt(limits.acceleration_mps2 * distance), 0.5 * distance / period_s});
  return way * (speed / distance);
}

}  // namespace

double field_potential(const FieldParams& params, const Vec3& position_m, const Vec3& goal_m,
                       const Vec3& neighbour_m) {
  const double rho = std::max((position_m - neighbour_m).norm(), kNearest);
  if (rho >= params.range_m) return 0.0;
  const double closeness = 1.0 / rho - 1.0 / params.range_m;
  return 0.5 * params.gain * closeness * closeness *
         std::pow((position_m - goal_m).norm(), params.goal_power);
}

Vec3 field_force(const FieldParams& params, const Vec3& position_m, const Vec3& goal_m,
                 const Vec3& neighbour_m) {
  const Vec3 away = position_m - neighbour_m;
  const double rho = std::max(away.norm(), kNearest);
  const Vec3 to_goal = goal_m - position_m;
  const double distance = to_goal.norm();
  if (rho >= params.range_m || distance <= 0.0) return Vec3::Zero();
  const double closeness = 1.0 / rho - 1.0 / params.range_m;
  const double power = std::pow(distance, params.goal_power);
  const double push = params.gain * closeness / (rho * rho) * power;
  const double pull =
      0.5 * params.goal_power * params.gain * closeness * closeness * power / distance;
  return push / rho * away + pull / distance * to_goal;
}

Vec3 field_velocity(const FieldParams& params, const MotionLimits& limits, const FieldSelf& self,
                    std::span<const FieldNeighbour> neighbours, double period_s) {
  Vec3 wanted = attraction(params, limits, self, period_s);
  for (const FieldNeighbour& other : neighbours) {
    if (!other.at_goal && other.id < self.id) continue;
    const Vec3 now = other.position_m + other.age_s * other.velocity_mps;
    wanted += field_force(params, self.position_m, self.goal_m, now);
  }
  const Vec3 change = shortened(wanted, limits.speed_mps) - self.velocity_mps;
  return self.velocity_mps + shortened(change, limits.acceleration_mps2 * period_s);
}

}  // namespace skein::formation
