// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace skein::autopilot {

/// Sticks of a pilot: full right, nose up, clockwise are +1; throttle in [0, 1].
struct Sticks {
  double roll = 0.0;
  double pitch = 0.0;
  double yaw = 0.0;
  double throttle = 0.0;
};

}  // namespace skein::autopilot
