// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "skein/base/geometry.hpp"
#include "skein/domain/path.hpp"
#include "skein/domain/site.hpp"
#include "skein/domain/vehicle.hpp"

namespace skein::planning {

/// How a task is flown: reach `entry`, then `run`. A delivery is timed at the end of its run (over
/// the site), an arc at its start.
struct TaskPath {
  Pose2 entry;
  Segment run;
};

/// The straight final approach of length L^s that ends over the site on the bearing.
[[nodiscard]] TaskPath delivery_path(const Site& site, const DeliveryRequirement& delivery,
                                     double final_approach_m);

/// The arc of `radius_m` around the site from `start_angle_rad`, counter-clockwise when `turn` is
/// +1 and clockwise when -1, long enough for the dwell at `speed_mps` (Wang 2022, eq. 16).
/// `margin` >= 1 lengthens it, so that a dwell is met in flight too.
[[nodiscard]] TaskPath arc_path(const Site& site, double start_angle_rad, Duration dwell,
                                double radius_m, double speed_mps, int turn, double margin = 1.05);

}  // namespace skein::planning
