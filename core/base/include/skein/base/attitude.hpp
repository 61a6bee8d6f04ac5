// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace skein {

/// A vector of three components. With attitudes two frames occur: NED (north, east, down from the
/// mission's origin) and body (forward, right, down); every name says which.
using Vec3 = Eigen::Vector3d;

inline constexpr double kGravity_mps2 = 9.81;

/// Roll, pitch and yaw (aerospace order), rad.
struct EulerAngles {
  double roll_rad = 0.0;
  double pitch_rad = 0.0;
  double yaw_rad = 0.0;  ///< from north, clockwise, in (-pi, pi]
};
/// Of an attitude that turns body axes to NED.
[[nodiscard]] EulerAngles euler_angles(const Eigen::Quaterniond& attitude);
[[nodiscard]] Eigen::Quaterniond attitude_from(const EulerAngles& angles);

}  // namespace skein
