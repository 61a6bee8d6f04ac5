// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "skein/base/geometry.hpp"
#include "skein/base/ids.hpp"

namespace skein {

/// A circle that no path may enter (Wang 2022, eq. 13 and 17). Mission frame, metres.
struct Hazard {
  HazardId id;
  Vec2 centre{0.0, 0.0};
  double radius_m = 0.0;
};

}  // namespace skein
