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
/// `linear_decay` is what is left of it where the rate is never at its limit.
double error_after(double error_rad, double gain_per_s, double rate_max, double seconds,
                   double linear_decay) {
  const double linear_below = rate_max / gain_per_s;
  const double saturated_s = std::max(0.0, (std::abs(error_rad) - linear_below) / rate_max);
  if (saturated_s >= seconds) return error_rad - std::copysign(rate_max * seconds, error_rad);
  const double at_bend = std::min(std::abs(error_rad), linear_below);
  const double decay =
      saturated_s > 0.0 ? std::exp(-gain_per_s * (seconds - saturated_s)) : linear_decay;
  return std::copysign(at_bend * decay, error_rad);
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

void HeadingDynamics::decay_over(double seconds) {
  if (decays_.seconds == seconds) return;
  const auto at = [&](double s) {
    return Decay{s, from_seconds(s), std::exp(-s / kAirspeedTime_s),
                 std::exp(-vehicle_.heading_gain_per_s * s)};
  };
  decays_ = {seconds,
             at(0.0),
             at(seconds / 2.0),
             at(seconds),
             -std::expm1(-seconds / kAirspeedTime_s),
             std::exp(-seconds / kHeightTime_s)};
}

Vec2 HeadingDynamics::step(double seconds) {
  decay_over(seconds);
  const double target_mps =
      std::clamp(setpoint_.airspeed_mps, vehicle_.speed_min_mps, vehicle_.speed_max_mps);
  const double lag_mps = state_.airspeed_mps - target_mps;
  const auto airspeed_after = [&](const Decay& d) { return target_mps + lag_mps * d.airspeed; };
  const double end_mps = airspeed_after(decays_.end);
  // The mean over the step, so that a turn at the limit is exact while the airspeed changes.
  const double mean_mps =
      target_mps + lag_mps * decays_.airspeed_made * (kAirspeedTime_s / seconds);
  const double rate_max = mean_mps / vehicle_.turn_radius_m;
  const double error = wrap_pi(setpoint_.heading_rad - state_.heading_rad);
  const auto heading_after = [&](const Decay& d) {
    return state_.heading_rad + error -
           error_after(error, vehicle_.heading_gain_per_s, rate_max, d.seconds, d.heading);
  };
  const double end_heading = heading_after(decays_.end);
  const auto velocity_after = [&](const Decay& d, double heading) -> Vec2 {
    return airspeed_after(d) * unit_vector(heading) + wind_.velocity_at(state_.time + d.time);
  };
  const Vec2 first = velocity_after(decays_.begin, heading_after(decays_.begin));
  const Vec2 middle = velocity_after(decays_.middle, heading_after(decays_.middle));
  Vec2 last = velocity_after(decays_.end, end_heading);
  const Vec2 moved = (first + 4.0 * middle + last) * (seconds / 6.0);
  state_.x_m += moved.x();
  state_.y_m += moved.y();
  state_.distance_flown_m += (first.norm() + 4.0 * middle.norm() + last.norm()) * (seconds / 6.0);
  state_.heading_rad = wrap_pi(end_heading);
  state_.airspeed_mps = end_mps;
  state_.z_m = setpoint_.height_m + (state_.z_m - setpoint_.height_m) * decays_.height;
  return last;
}

void HeadingDynamics::report_velocity(const Vec2& over_ground) {
  state_.groundspeed_mps = over_ground.norm();
  state_.course_rad = std::atan2(over_ground.y(), over_ground.x());
}

}  // namespace skein::models
