// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "return_track.hpp"
#include "skein/planning/collective_return.hpp"

namespace skein::planning {

/// Where a vehicle holds, and how it comes there.
struct ReturnHold {
  Ring ring;
  double curvature_per_m = 0.0;
  std::optional<Pose2> entry;  ///< none: anywhere on the ring
  double off_home_m = 0.0;
};
/// Where a way from that pose comes onto the ring: at its entry, or along the tangent.
[[nodiscard]] Pose2 entry_of(const ReturnHold& hold, const Pose2& from);

/// The pose on the ring of that heading.
[[nodiscard]] Pose2 entry_at(const ReturnHold& hold, double heading_rad);

/// Do heights alone keep them apart?
[[nodiscard]] bool apart_in_height(const ReturnParams& params, const ReturningVehicle& a,
                                   const ReturningVehicle& b);

/// The orbits of all, any two of one height apart by the separation, and clear of hazards: of each
/// its own home where that leaves room, else the nearest place to it. Nothing where there is none
/// within reach. Only vehicles that `wanted` has take part.
[[nodiscard]] std::vector<std::optional<ReturnHold>> assign_holds(
    const ReturnParams& params, std::span<const ReturningVehicle> vehicles,
    std::span<const Hazard> hazards, const std::vector<bool>& wanted);

}  // namespace skein::planning
