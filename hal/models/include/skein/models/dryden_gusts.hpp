// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "skein/base/random.hpp"
#include "skein/models/rigid_body.hpp"

namespace skein::models {

/// Length scales and intensities of MIL-F-8785C, 3.7.2-3.7.3.4, for a wind at 20 ft (6 m) above
/// ground of `wind_at_6m_mps`: the low-altitude forms up to 1000 ft, 1750 ft and the vertical
/// intensity on all axes from 2000 ft, linear between.
struct GustScales {
  double length_along_m = 0.0;     ///< L_u, and L_v
  double length_vertical_m = 0.0;  ///< L_w
  double along_mps = 0.0;          ///< sigma_u, and sigma_v
  double vertical_mps = 0.0;       ///< sigma_w
};
/// Heights below 10 ft count as 10 ft, as the specification has it.
[[nodiscard]] GustScales gust_scales(double height_above_ground_m, double wind_at_6m_mps);

/// Gusts of the Dryden spectra of MIL-F-8785C along the vehicle's path (frozen turbulence):
///   Phi_u(w) = 2 sigma^2 T / pi / (1 + (T w)^2),
///   Phi_v,w(w) = sigma^2 T / pi (1 + 3 (T w)^2) / (1 + (T w)^2)^2,  T = L / airspeed.
/// White noise through the linear filter of each, in coordinates whose stationary covariance is
/// the identity, advanced by its exact discretisation: the variance does not depend on the step,
/// nor is there a settling time. The rotary gusts of the specification are left out.
class DrydenGusts {
 public:
  DrydenGusts(double wind_at_6m_mps, std::uint64_t seed);

  /// Advances by one step. Airspeeds below 1 m/s count as 1 m/s: a hovering vehicle meets gusts
  /// that drift past. Returns the gust along path (u), to its right (v) and down (w), m/s.
  Vec3 step(double seconds, double airspeed_mps, double height_above_ground_m);

  /// The last gust along the axes of `yaw_rad`, turned to NED.
  [[nodiscard]] Vec3 velocity_ned_mps(double yaw_rad) const;

 private:
  double wind_at_6m_mps_;
  Random random_;
  double along_ = 0.0;
  /// Of v and w: the filter's output and its scaled integral.
  Eigen::Vector2d across_ = Eigen::Vector2d::Zero();
  Eigen::Vector2d vertical_ = Eigen::Vector2d::Zero();
  Vec3 gust_mps_ = Vec3::Zero();
};

}  // namespace skein::models
