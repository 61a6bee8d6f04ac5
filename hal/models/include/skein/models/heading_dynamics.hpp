// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "skein/base/geometry.hpp"
#include "skein/base/time.hpp"
#include "skein/domain/vehicle.hpp"
#include "skein/models/wind.hpp"

namespace skein::models {

/// The planar vehicle with an autopilot of Wang 2022, eq. (2):
///   d heading/dt = W wrap(commanded - heading), held to |rate| <= airspeed / turn radius;
///   airspeed follows its command with 1 s, height with 3 s (both first order), airspeed within the
///   vehicle's limits; velocity over the ground = velocity through the air + wind.
/// Heading, airspeed and height are advanced in closed form, the position by Simpson's rule over
/// steps of at most 10 ms, so the result does not depend on how often it is asked (to
/// less than a millimetre a minute). Deterministic; allocates nothing after construction.
class HeadingDynamics {
 public:
  /// At `pose` and the vehicle's height, at cruise speed, from `start` on.
  HeadingDynamics(const VehicleSpec& vehicle, const Wind& wind, const Pose2& pose, Instant start);

  /// Holds from the state's time on, until the next. A setpoint with a number that is not finite is
  /// ignored, as a flight controller would.
  void command(const Setpoint& setpoint);

  /// Precondition: `t` is not before state().time.
  void advance_to(Instant t);

  [[nodiscard]] const VehicleState& state() const { return state_; }

 private:
  /// What is left of a first-order lag after a part of a step; 1 at its begin.
  struct Decay {
    double seconds = 0.0;
    Duration time{};  ///< the same
    double airspeed = 1.0;
    double heading = 1.0;
  };
  /// Of a step of some length. Nearly all have the same.
  struct Decays {
    double seconds = 0.0;
    Decay begin;
    Decay middle;
    Decay end;
    double airspeed_made = 0.0;  ///< share of the lag that the step makes good
    double height = 1.0;
  };
  void decay_over(double seconds);
  /// Returns the velocity over the ground at its end.
  Vec2 step(double seconds);
  void report_velocity(const Vec2& over_ground);

  VehicleSpec vehicle_;
  Wind wind_;
  Setpoint setpoint_;
  VehicleState state_;
  Decays decays_;
};

}  // namespace skein::models
