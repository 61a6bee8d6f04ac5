// SPDX-License-Identifier: Apache-2.0
#include "skein/autopilot/estimate.hpp"

#include <cmath>

namespace skein::autopilot {

double Estimate::course_rad() const { return std::atan2(velocity_mps.y(), velocity_mps.x()); }

}  // namespace skein::autopilot
