// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "skein/formation/limits.hpp"

namespace skein::formation {

/// From rest to rest over a length, as fast as speed, acceleration and jerk allow: seven phases of
/// constant jerk, symmetric in time (the "S-curve"; Biagiotti and Melchiorri, "Trajectory Planning
/// for Automatic Machines and Robots", 2008, sec. 3.4).
class MotionProfile {
 public:
  MotionProfile() = default;
  /// Precondition: length_m >= 0, all limits > 0.
  MotionProfile(double length_m, const MotionLimits& limits);

  struct Point {
    double distance_m = 0.0;
    double speed_mps = 0.0;
    double acceleration_mps2 = 0.0;
  };
  /// Before the begin and after the end it rests there.
  [[nodiscard]] Point at(double seconds) const;
  [[nodiscard]] double duration_s() const { return 2.0 * rise_s_ + cruise_s_; }
  [[nodiscard]] double length_m() const { return length_m_; }
  [[nodiscard]] double speed_max_mps() const { return peak_mps_; }

 private:
  [[nodiscard]] Point rising(double seconds) const;

  double length_m_ = 0.0;
  double peak_mps_ = 0.0;
  double rise_s_ = 0.0;  ///< from rest to the peak
  double ease_s_ = 0.0;  ///< of it at constant jerk, at its begin and at its end
  double jerk_mps3_ = 0.0;
  double cruise_s_ = 0.0;
};

}  // namespace skein::formation
