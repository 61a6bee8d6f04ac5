// SPDX-License-Identifier: Apache-2.0
#include "skein/base/attitude.hpp"

#include <algorithm>
#include <cmath>

namespace skein {

EulerAngles euler_angles(const Eigen::Quaterniond& attitude) {
  const Eigen::Matrix3d to_ned = attitude.toRotationMatrix();
  return {.roll_rad = std::atan2(to_ned(2, 1), to_ned(2, 2)),
          .pitch_rad = std::asin(std::clamp(-to_ned(2, 0), -1.0, 1.0)),
          .yaw_rad = std::atan2(to_ned(1, 0), to_ned(0, 0))};
}

Eigen::Quaterniond attitude_from(const EulerAngles& angles) {
  using Eigen::AngleAxisd;
  return Eigen::Quaterniond{AngleAxisd{angles.yaw_rad, Vec3::UnitZ()} *
                            AngleAxisd{angles.pitch_rad, Vec3::UnitY()} *
                            AngleAxisd{angles.roll_rad, Vec3::UnitX()}};
}

}  // namespace skein
