// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "skein/autopilot/estimate.hpp"
#include "skein/base/random.hpp"
#include "skein/hil/emulator_config.hpp"
#include "skein/models/dryden_gusts.hpp"
#include "skein/models/sensors.hpp"

namespace skein::hil {

/// The air that the aircraft flies through: steady wind and Dryden gusts.
class Air {
 public:
  explicit Air(const EmulatorConfig& config);

  void step(const models::RigidBodyState& state, double seconds);
  [[nodiscard]] const Vec3& wind_ned_mps() const { return wind_; }
  [[nodiscard]] double airspeed_mps(const models::RigidBodyState& state) const;
  /// As a navigation filter finds it: gusts smoothed away.
  [[nodiscard]] const Vec3& estimated_ned_mps() const { return estimated_; }

 private:
  Vec3 steady_;
  models::DrydenGusts gusts_;
  bool gusty_;
  double short_deviation_mps_;
  Random random_;  ///< of the short gusts
  Vec3 short_mps_ = Vec3::Zero();
  Vec3 wind_;
  Vec3 estimated_;
};

/// What the navigation filter makes of noisy sensors.
class Senses {
 public:
  explicit Senses(const EmulatorConfig& config);

  autopilot::Estimate estimate(const models::RigidBodyState& state, const Vec3& specific_force_mps2,
                               double airspeed_mps, double seconds);

 private:
  /// How far off it believes to be, a period later.
  const Vec3& drift(double seconds);

  bool noise_;
  models::Imu imu_;
  Random random_;
  Airframe airframe_;
  Random drift_random_;
  Vec3 drift_m_ = Vec3::Zero();
};

}  // namespace skein::hil
