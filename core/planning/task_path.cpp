// SPDX-License-Identifier: Apache-2.0
#include "skein/planning/task_path.hpp"

#include "skein/base/angles.hpp"
#include "skein/base/assert.hpp"

namespace skein::planning {

TaskPath delivery_path(const Site& site, const DeliveryRequirement& delivery,
                       double final_approach_m) {
  SKEIN_ASSERT(final_approach_m >= 0.0);
  const Vec2 entry = site.position - final_approach_m * unit_vector(delivery.bearing_rad);
  return {{entry.x(), entry.y(), wrap_pi(delivery.bearing_rad)}, {0.0, final_approach_m}};
}

TaskPath arc_path(const Site& site, double start_angle_rad, Duration dwell, double radius_m,
                  double speed_mps, int turn, double margin) {
  SKEIN_ASSERT(radius_m > 0.0 && speed_mps > 0.0 && margin >= 1.0);
  SKEIN_ASSERT(turn == 1 || turn == -1);
  const Vec2 entry = site.position + radius_m * unit_vector(start_angle_rad);
  const double heading = wrap_pi(start_angle_rad + turn * kPi / 2.0);
  return {{entry.x(), entry.y(), heading},
          {turn / radius_m, to_seconds(dwell) * speed_mps * margin}};
}

}  // namespace skein::planning
