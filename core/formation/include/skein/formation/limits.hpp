// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace skein::formation {

/// What a multirotor's reference may do along its path.
struct MotionLimits {
  double speed_mps = 5.0;          ///< > 0
  double acceleration_mps2 = 2.0;  ///< > 0; also towards the centre of a turn
  double jerk_mps3 = 4.0;          ///< > 0
};

/// How near two vehicles may come: their distance counts with heights stretched by
/// horizontal_m / vertical_m, since a rotor's wake reaches further down than to the side.
struct Separation {
  double horizontal_m = 3.0;  ///< > 0
  double vertical_m = 3.0;    ///< > 0

  [[nodiscard]] double height_factor() const { return horizontal_m / vertical_m; }
};

}  // namespace skein::formation
