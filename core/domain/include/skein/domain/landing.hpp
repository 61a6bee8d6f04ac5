// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "skein/base/geometry.hpp"
#include "skein/idl/domain.hpp"

namespace skein {

/// Where the final approach begins, mission frame.
[[nodiscard]] inline Vec2 approach_begin(const Landing& landing) {
  return Vec2{landing.x_m, landing.y_m} - landing.approach_m * unit_vector(landing.heading_rad);
}

/// The centre of the circle, flown to the left, on which a plane comes down to the height of its
/// final approach, and which it leaves along that.
[[nodiscard]] inline Vec2 descent_centre(const Landing& landing) {
  return approach_begin(landing) + landing.radius_m * left_of(unit_vector(landing.heading_rad));
}

}  // namespace skein
