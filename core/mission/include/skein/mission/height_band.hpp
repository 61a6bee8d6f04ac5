// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

namespace skein::mission {

/// Heights above the mission's origin, from `low_m` to `high_m`; without limits to begin with.
struct HeightBand {
  double low_m = -std::numeric_limits<double>::infinity();
  double high_m = std::numeric_limits<double>::infinity();
};

}  // namespace skein::mission
