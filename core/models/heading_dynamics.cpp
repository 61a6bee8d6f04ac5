// SPDX-License-Identifier: Apache-2.0
#include "skein/models/heading_dynamics.hpp"

#include <algorithm>
#include <cmath>

#include "skein/base/angles.hpp"
#include "skein/base/assert.hpp"

namespace skein::models {
namespace {

constexpr Duration kStepMax = std::chrono::milliseconds{10};
constexpr double kAirspeedTime_s = 1.0;
constexpr double kHeightTime_s = 3.0;

/// The heading error after `seconds` of d error/dt = -gain * error with |rate| <= rate_max.
double error_after(double error_rad, double gain_per_s, double rate_max, double seconds) {
  const double linear_below = rate_max / gain_per_s;
  const double saturated_s = std::max(0.0, (std::abs(error_rad) - linear_below) / rate_max);
  if (saturated_s >= seconds) return error_rad - std::copysign(rate_max * seconds, error_rad);
  const double at_bend = std::min(std::abs(error_rad), linear_below);
  return std::copysign(at_bend * std::exp(-gain_per_s * (seconds - saturated_s)), error_rad);
}

}  // namespace

HeadingDynamics::HeadingDynamics(const VehicleSpec& vehicle, const Wind& wind, const Pose2& pose,
                                 Instant start)
    : vehicle_{vehicle},
      wind_{wind},
      setpoint_{.heading_rad = pose.heading_rad,
                .airspeed_mps = vehicle.cruise_speed_mps,
                .height_m = vehicle.height_m} {
  SKEIN_ASSERT(vehicle.turn_radius_m > 0.0);
  SKEIN_ASSERT(vehicle.heading_gain_per_s > 0.0);
  SKEIN_ASSERT(vehicle.speed_min_mps > 0.0 && vehicle.speed_min_mps <= vehicle.speed_max_mps);
  state_.time = start;
  state_.x_m = pose.x_m;
  state_.y_m = pose.y_m;
  state_.z_m = vehicle.height_m;
  state_.heading_rad = wrap_pi(pose.heading_rad);
  state_.airspeed_mps =
      std::clamp(vehicle.cruise_speed_mps, vehicle.speed_min_mps, vehicle.speed_max_mps);
  report_velocity(state_.airspeed_mps * unit_vector(state_.heading_rad) + wind_.velocity_at(start));
}

void HeadingDynamics::command(const Setpoint& setpoint) {
  if (!std::isfinite(setpoint.heading_rad) || !std::isfinite(setpoint.airspeed_mps) ||
      !std::isfinite(setpoint.height_m)) {
    return;
  }
  setpoint_ = setpoint;
}

void HeadingDynamics::advance_to(Instant t) {
  SKEIN_ASSERT(t >= state_.time);
  Vec2 over_ground{0.0, 0.0};
  const bool moves = state_.time < t;
  while (state_.time < t) {
    const Duration dt = std::min(kStepMax, t - state_.time);
    over_ground = step(to_seconds(dt));
    state_.time += dt;
  }
  if (moves) report_velocity(over_ground);
}

Vec2 HeadingDynamics::step(double seconds) {
  const double target_mps =
      std::clamp(setpoint_.airspeed_mps, vehicle_.speed_min_mps, vehicle_.speed_max_mps);
  const double lag_mps = state_.airspeed_mps - target_mps;
  const auto airspeed_after = [&](double s) {
    return target_mps + lag_mps * std::exp(-s / kAirspeedTime_s);
  };
  const double end_mps = airspeed_after(seconds);
  // The mean over the step, so that a turn at the limit is exact while the airspeed changes.
  const double mean_mps =
      target_mps + lag_mps * -std::expm1(-seconds / kAirspeedTime_s) * (kAirspeedTime_s / seconds);
  const double rate_max = mean_mps / vehicle_.turn_radius_m;
  const double error = wrap_pi(setpoint_.heading_rad - state_.heading_rad);
  const auto heading_after = [&](double s) {
    return state_.heading_rad + error -
           error_after(error, vehicle_.heading_gain_per_s, rate_max, s);
  };
  const auto velocity_after = [&](double s) -> Vec2 {
    return airspeed_after(s) * unit_vector(heading_after(s)) +
           wind_.velocity_at(state_.time + from_seconds(s));
  };
  const Vec2 first = velocity_after(0.0);
  const Vec2 middle = velocity_after(seconds / 2.0);
  const Vec2 last = velocity_after(seconds);
  const Vec2 moved = (first + 4.0 * middle + last) * (seconds / 6.0);
  state_.x_m += moved.x();
  state_.y_m += moved.y();
  state_.distance_flown_m += (first.norm() + 4.0 * middle.norm() + last.norm()) * (seconds / 6.0);
  state_.heading_rad = wrap_pi(heading_after(seconds));
  state_.airspeed_mps = end_mps;
  state_.z_m =
      setpoint_.height_m + (state_.z_m - setpoint_.height_m) * std::exp(-seconds / kHeightTime_s);
  return last;
}

void HeadingDynamics::report_velocity(const Vec2& over_ground) {
  state_.groundspeed_mps = over_ground.norm();
  state_.course_rad = std::atan2(over_ground.y(), over_ground.x());
}

}  // namespace skein::models
