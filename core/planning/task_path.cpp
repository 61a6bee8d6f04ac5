// SPDX-License-Identifier: Apache-2.0
#include "skein/planning/task_path.hpp"

#include "skein/base/angles.hpp"

namespace skein::planning {

TaskPath delivery_path(const Site& site, const DeliveryRequirement& delivery,
                       double final_approach_m) {
  const Vec2 gate = site.position - final_approach_m * unit_vector(delivery.bearing_rad);
  return {{gate.x(), gate.y(), delivery.bearing_rad}, {0.0, final_approach_m}};
}

TaskPath arc_path(const Site& site, double start_angle_rad, Duration dwell, double radius_m,
                  double speed_mps, int turn, double margin) {
  const Vec2 entry = site.position + radius_m * unit_vector(start_angle_rad);
  return {{entry.x(), entry.y(), wrap_pi(start_angle_rad + turn * kPi / 2.0)},
          {turn / radius_m, speed_mps * to_seconds(dwell) * margin}};
}

}  // namespace skein::planning
