// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "skein/base/attitude.hpp"

namespace skein::autopilot {

/// What the navigation filter knows, and all that the loops go by.
struct Estimate {
  Vec3 position_m = Vec3::Zero();                                ///< NED
  Vec3 velocity_mps = Vec3::Zero();                              ///< NED, over the ground
  Eigen::Quaterniond attitude = Eigen::Quaterniond::Identity();  ///< body to NED
  Vec3 rates_radps = Vec3::Zero();                               ///< body axes
  Vec3 specific_force_mps2 = Vec3::Zero();  ///< of the accelerometers, body axes
  double airspeed_mps = 0.0;

  [[nodiscard]] double height_m() const { return -position_m.z(); }
  [[nodiscard]] double climb_mps() const { return -velocity_mps.z(); }
  [[nodiscard]] double groundspeed_mps() const { return velocity_mps.head<2>().norm(); }
  /// Direction of motion over the ground, from north, clockwise.
  [[nodiscard]] double course_rad() const;
};

}  // namespace skein::autopilot
