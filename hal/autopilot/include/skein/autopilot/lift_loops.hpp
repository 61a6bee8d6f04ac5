// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "skein/autopilot/estimate.hpp"
#include "skein/base/geometry.hpp"

namespace skein::autopilot {

/// What the loops know about an airframe that rotors carry, however many. The defaults fly
/// models::firefly().
struct LiftTuning {
  double mass_kg = 1.56779;
  Vec3 inertia_kgm2{0.0347563, 0.0458929, 0.0977};

  Vec3 rate_gain_per_s{18.0, 18.0, 6.0};       ///< rate error to angular acceleration
  Vec3 rate_integral_per_s2{20.0, 20.0, 4.0};  ///< and its integral
  Vec3 angle_gain_per_s{7.0, 7.0, 2.5};        ///< angle error to rate
  double tilt_rate_max_radps = 4.0;
  double yaw_rate_max_radps = 1.5;
  double tilt_max_rad = 0.6;

  double velocity_gain_per_s = 2.5;       ///< velocity error to acceleration
  double velocity_integral_per_s2 = 0.8;  ///< and its integral
  double position_gain_per_s = 1.2;       ///< position error to velocity
  double speed_max_mps = 10.0;            ///< horizontal
  double climb_max_mps = 3.0;
  double sink_max_mps = 2.0;
  double acceleration_max_mps2 = 4.0;  ///< horizontal
};

/// A motion to follow: positions where given, else the velocities alone. All NED.
struct MotionDemand {
  std::optional<Vec2> horizontal_m{};  ///< north, east
  std::optional<double> down_m{};
  Vec3 velocity_mps = Vec3::Zero();       ///< of the point to follow
  Vec3 acceleration_mps2 = Vec3::Zero();  ///< of it, too
  double yaw_rad = 0.0;
  double yaw_rate_radps = 0.0;            ///< of yaw_rad
  std::optional<double> speed_max_mps{};  ///< towards horizontal_m; the tuning's where none
};

/// What the rotors are to do together: thrust along the body's up axis, and moments about its axes.
struct LiftDemand {
  double thrust_n = 0.0;
  Vec3 moment_nm = Vec3::Zero();
};

/// The cascaded loops of whatever rotors carry: position, velocity, thrust vector and attitude
/// (Lee, Leok and McClamroch 2010; tilt before yaw as Brescianini and D'Andrea 2018), body rates.
/// Pure: the time step is an argument.
class LiftLoops {
 public:
  explicit LiftLoops(const LiftTuning& tuning) : tuning_{tuning} {}

  /// Forgets the integrals.
  void reset() { *this = LiftLoops{tuning_}; }

  /// Precondition for all: seconds > 0.
  LiftDemand fly(const Estimate& estimate, const MotionDemand& demand, double seconds);
  /// Roll and pitch as given (within tilt_max), turning at a rate.
  LiftDemand hold_attitude(const Estimate& estimate, double roll_rad, double pitch_rad,
                           double yaw_rad, double yaw_rate_radps, double thrust_n, double seconds);

  [[nodiscard]] const LiftTuning& tuning() const { return tuning_; }

 private:
  LiftDemand turn_to(const Estimate& estimate, const Eigen::Quaterniond& wanted,
                     double yaw_rate_radps, double thrust_n, double seconds);

  LiftTuning tuning_;
  Vec3 velocity_integral_ = Vec3::Zero();  ///< acceleration, NED
  Vec3 rate_integral_ = Vec3::Zero();      ///< angular acceleration, body axes
};

}  // namespace skein::autopilot
