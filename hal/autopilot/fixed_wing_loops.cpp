// SPDX-License-Identifier: Apache-2.0
#include "skein/autopilot/fixed_wing_loops.hpp"

#include <algorithm>
#include <cmath>

#include "skein/base/assert.hpp"

namespace skein::autopilot {
namespace {

double within(double value, double limit) { return std::clamp(value, -limit, limit); }

}  // namespace

FixedWingTuning froude_scaled(const FixedWingTuning& tuning, double scale) {
  SKEIN_ASSERT(scale > 0.0);
  const double root = std::sqrt(scale);
  FixedWingTuning t = tuning;
  for (double* const speed : {&t.airspeed_min_mps, &t.airspeed_cruise_mps, &t.airspeed_max_mps,
                              &t.reference_airspeed_mps, &t.climb_max_mps, &t.sink_max_mps}) {
    *speed *= root;
  }
  for (double* const time :
       {&t.roll.feedforward_s, &t.roll.proportional_s, &t.pitch.feedforward_s,
        &t.pitch.proportional_s, &t.yaw_gain_s, &t.height_time_s, &t.airspeed_time_s}) {
    *time *= root;
  }
  // Per time, per speed, or per specific power (a speed times an acceleration).
  for (double* const rate :
       {&t.roll_gain_per_s, &t.pitch_gain_per_s, &t.roll_rate_max_radps, &t.pitch_rate_max_radps,
        &t.sideslip_gain_s_per_m, &t.throttle_per_mps, &t.throttle_per_power, &t.power_gain,
        &t.balance_integral_per_s, &t.heading_gain_per_s}) {
    *rate /= root;
  }
  t.power_integral_per_s /= scale;
  return t;
}

FixedWingLoops::FixedWingLoops(const FixedWingTuning& tuning) : tuning_{tuning} {
  if (tuning_.slow_energy) energy_loop_.emplace(*tuning_.slow_energy);
}

double FixedWingLoops::bank_for(double lateral_mps2) const {
  return within(std::atan(lateral_mps2 / kGravity_mps2), tuning_.roll_max_rad);
}

SurfaceCommand FixedWingLoops::fly(const Estimate& estimate, const FlightDemand& demand,
                                   double seconds) {
  return hold_roll(estimate, bank_for(demand.lateral_mps2), demand.height_m, demand.airspeed_mps,
                   seconds);
}

SurfaceCommand FixedWingLoops::hold_roll(const Estimate& estimate, double roll_rad, double height_m,
                                         double airspeed_mps, double seconds) {
  const PitchAndThrottle wanted = energy_loop_
                                      ? slow_energy(estimate, height_m, airspeed_mps, seconds)
                                      : energy(estimate, height_m, airspeed_mps, seconds);
  return attitude(estimate, roll_rad, wanted.pitch_rad, wanted.throttle, seconds);
}

PitchAndThrottle FixedWingLoops::slow_energy(const Estimate& estimate, double height_m,
                                             double airspeed_mps, double seconds) {
  const FixedWingTuning& t = tuning_;
  const double target = std::clamp(airspeed_mps, t.airspeed_min_mps, t.airspeed_max_mps);
  return energy_loop_->step(estimate, height_m, target,
                            {.throttle_level = t.throttle_level,
                             .throttle_max = t.throttle_max,
                             .pitch_trim_rad = t.alpha_zero_lift_rad + t.alpha_per_load_rad,
                             .pitch_min_rad = t.pitch_min_rad,
                             .pitch_max_rad = t.pitch_max_rad,
                             .airspeed_least_mps = 0.5 * t.airspeed_min_mps},
                            seconds);
}

PitchAndThrottle FixedWingLoops::energy(const Estimate& estimate, double height_m,
                                        double airspeed_wanted_mps, double seconds) {
  SKEIN_ASSERT(seconds > 0.0);
  const FixedWingTuning& t = tuning_;
  const double airspeed = std::max(estimate.airspeed_mps, 0.5 * t.airspeed_min_mps);
  const double target = std::clamp(airspeed_wanted_mps, t.airspeed_min_mps, t.airspeed_max_mps);
  const double climb_wanted = std::clamp((height_m - estimate.height_m()) / t.height_time_s,
                                         -t.sink_max_mps, t.climb_max_mps);
  const double acceleration_wanted =
      within((target - estimate.airspeed_mps) / t.airspeed_time_s, t.acceleration_max_mps2);
  // The accelerometer, less gravity: smoother than the derivative of the airspeed.
  const EulerAngles angles = euler_angles(estimate.attitude);
  const double acceleration =
      estimate.specific_force_mps2.x() - kGravity_mps2 * std::sin(angles.pitch_rad);

  // Specific powers, m^2/s^3. Throttle makes the sum, pitch shares it out.
  const double height_power = kGravity_mps2 * estimate.climb_mps();
  const double speed_power = airspeed * acceleration;
  const double height_power_wanted = kGravity_mps2 * climb_wanted;
  const double speed_power_wanted = airspeed * acceleration_wanted;

  const double power_wanted = height_power_wanted + speed_power_wanted;
  const double power_error = power_wanted - (height_power + speed_power);
  const double throttle_wanted =
      t.throttle_level + t.throttle_per_mps * (target - t.reference_airspeed_mps) +
      t.throttle_per_power * power_wanted + t.power_gain * power_error + throttle_integral_;
  const double throttle = std::clamp(throttle_wanted, 0.0, t.throttle_max);
  // Not further in the direction in which the throttle is at its stop.
  if ((throttle_wanted - throttle) * power_error <= 0.0) {
    throttle_integral_ =
        within(throttle_integral_ + t.power_integral_per_s * power_error * seconds, 0.5);
  }

  // Without power to spare, or slow, airspeed comes before height.
  const bool slow = estimate.airspeed_mps < t.airspeed_min_mps;
  const double height_weight = slow ? 0.0 : 1.0;
  const double speed_weight = slow ? 2.0 : 1.0;
  const double balance_wanted =
      height_weight * height_power_wanted - speed_weight * speed_power_wanted;
  const double balance = height_weight * height_power - speed_weight * speed_power;
  const double angle_error = (balance_wanted - balance) / (kGravity_mps2 * airspeed);
  // Load factor and attitude of a level turn at this bank; beyond 70 degrees none is level.
  const double cos_roll = std::max(std::cos(angles.roll_rad), 0.34);
  const double slower = t.reference_airspeed_mps / airspeed;
  const double alpha = t.alpha_zero_lift_rad + t.alpha_per_load_rad * slower * slower / cos_roll;
  const double pitch_wanted = alpha * cos_roll + height_weight * climb_wanted / airspeed +
                              t.balance_gain * angle_error + balance_integral_;
  const double pitch = std::clamp(pitch_wanted, t.pitch_min_rad, t.pitch_max_rad);
  if ((pitch_wanted - pitch) * angle_error <= 0.0) {
    balance_integral_ =
        within(balance_integral_ + t.balance_integral_per_s * angle_error * seconds, 0.15);
  }
  return {.pitch_rad = pitch, .throttle = throttle};
}

double FixedWingLoops::surface(const RateGains& gains, double wanted, double rate,
                               double airspeed_mps, double& integral, double seconds) const {
  // Moments of a surface go with the square of the airspeed, the damping of a rate with it.
  const double slower =
      tuning_.reference_airspeed_mps / std::max(airspeed_mps, 0.5 * tuning_.airspeed_min_mps);
  const double error = wanted - rate;
  const double output = gains.feedforward_s * slower * wanted +
                        slower * slower * gains.proportional_s * error + integral;
  const double limited = within(output, tuning_.surface_max_rad);
  if ((output - limited) * error <= 0.0) {
    integral = within(integral + slower * slower * gains.integral * error * seconds,
                      0.7 * tuning_.surface_max_rad);
  }
  return limited;
}

SurfaceCommand FixedWingLoops::hold_attitude(const Estimate& estimate, double roll_rad,
                                             double pitch_rad, double throttle, double seconds) {
  // Height and airspeed are another's for now: the loop begins anew with what they are then.
  if (tuning_.slow_energy) energy_loop_.emplace(*tuning_.slow_energy);
  return attitude(estimate, roll_rad, pitch_rad, throttle, seconds);
}

SurfaceCommand FixedWingLoops::attitude(const Estimate& estimate, double roll_rad, double pitch_rad,
                                        double throttle, double seconds) {
  SKEIN_ASSERT(seconds > 0.0);
  const FixedWingTuning& t = tuning_;
  roll_demand_ = within(roll_rad, t.roll_max_rad);
  pitch_demand_ = std::clamp(pitch_rad, t.pitch_min_rad, t.pitch_max_rad);
  const EulerAngles angles = euler_angles(estimate.attitude);
  const double airspeed = std::max(estimate.airspeed_mps, 0.5 * t.airspeed_min_mps);
  // The rates of a coordinated turn at this bank (Beard and McLain, eq. 9.14, in body axes).
  const double bank = within(angles.roll_rad, t.roll_max_rad);
  const double turn = kGravity_mps2 / airspeed * std::sin(bank) * std::cos(angles.pitch_rad);
  const double roll_rate =
      within(t.roll_gain_per_s * (roll_demand_ - angles.roll_rad), t.roll_rate_max_radps);
  const double pitch_rate =
      within(t.pitch_gain_per_s * (pitch_demand_ - angles.pitch_rad), t.pitch_rate_max_radps) +
      turn * std::tan(bank);
  const double yaw_rate = turn - t.sideslip_gain_s_per_m * estimate.specific_force_mps2.y();
  const double slower = t.reference_airspeed_mps / airspeed;
  const double aileron =
      surface(t.roll, roll_rate, estimate.rates_radps.x(), airspeed, roll_integral_, seconds);
  return {
      .elevator_rad = -surface(t.pitch, pitch_rate, estimate.rates_radps.y(), airspeed,
                               pitch_integral_, seconds),
      .aileron_rad = aileron,
      .rudder_rad = within(slower * slower * t.yaw_gain_s * (estimate.rates_radps.z() - yaw_rate),
                           t.surface_max_rad),
      .throttle = std::clamp(throttle, 0.0, t.throttle_max),
  };
}

}  // namespace skein::autopilot
