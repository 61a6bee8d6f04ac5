// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/formation/change.hpp"

namespace skein::formation {

/// Where a vehicle rests now and where it is to rest then.
struct Transfer {
  VehicleId vehicle;
  Vec3 from{0.0, 0.0, 0.0};
  Vec3 to{0.0, 0.0, 0.0};
};

/// A stretch of air to keep away from for the whole change: where a vehicle may be that no longer
/// says where it is. With equal ends, a point.
struct KeepOut {
  VehicleId vehicle;
  Vec3 from{0.0, 0.0, 0.0};
  Vec3 to{0.0, 0.0, 0.0};
};

/// Metres, heights stretched.
[[nodiscard]] double distance_m(const Vec3& position, const KeepOut& keep_out,
                                double height_factor);

/// Of any of them, nearer than that.
[[nodiscard]] bool is_near_any(const Vec3& position, const std::vector<KeepOut>& keep_outs,
                               double within_m, double height_factor);

struct ChangeRequest {
  std::vector<Transfer> transfers;
  std::vector<KeepOut> keep_outs;
  MotionLimits limits;
  Separation separation;     ///< that the references keep whatever happens: Change::separation
  double reserve_m = 1.0;    ///< planned beyond it, for vehicles that are late
  double ceiling_m = 120.0;  ///< nobody is led above it to pass over others
};

/// How a change keeps vehicles apart; the first that does is taken.
enum class Way : std::uint8_t {
  straight,    ///< straight lines under common timing
  roundabout,  ///< who would come too near goes around a disc, all the same way round; many on
               ///< levels
  layers,      ///< who would come too near crosses at a height of its own
  track,       ///< planes: places that move along a track
  count
};
[[nodiscard]] std::string_view to_string(Way way);

struct PlannedChange {
  Change change;  ///< without number and start
  Way way = Way::straight;
  double least_separation_m = 0.0;  ///< of any two, in continuous time, heights stretched
  Duration duration{};
};

/// A change in which no two vehicles come nearer than separation and reserve, and none to a
/// keep-out than separation; checked in continuous time. Who starts nearer than that, as vehicles
/// do that had to wait for each other, comes no nearer than there: two vehicles never below the
/// separation. Straight lines under common timing suffice for every assignment of least squares
/// whose starts and places are 2 sqrt(2) R apart, R half the separation (Turpin, Mohta, Michael and
/// Kumar 2014, theorem 3.3, "CAPT"). The disc of a roundabout is the least on whose rim N vehicles
/// evenly spread are apart, d / (2 sin(pi / N)), or as much larger as it takes; N is of one level,
/// and there are more where each spares a twentieth of the duration. Layers need N heights at most.
/// Fails, with the two that come nearest, where the starts or the places
/// themselves are too near, or the ceiling too low. Cost: of n^2 pairs.
[[nodiscard]] Result<PlannedChange> plan_change(const ChangeRequest& request);

/// A change after which fewer vehicles rest nearer to each other than plan_change() can begin from,
/// as who waited for each other may, or in a keep-out: one of them is led out, straight, to where
/// nobody is nearer than separation and reserve and no keep-out is; the others stay. On its way it
/// comes nearer to nobody, and to keep-outs that it is in by a tenth at most; from right below one
/// that may come down it takes the shortest way.
/// The shortest such way of the least that `allowed` lets be flown. None where nobody rests so
/// near, or no way out is free.
[[nodiscard]] std::optional<PlannedChange> make_room(
    const ChangeRequest& request, const std::function<bool(const Transfer&)>& allowed);

}  // namespace skein::formation
