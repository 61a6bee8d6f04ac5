// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "skein/domain/fence.hpp"
#include "skein/domain/hazard.hpp"
#include "skein/domain/path.hpp"
#include "skein/planning/avoidance.hpp"

namespace skein::mission {

/// Of which nobody asks for more to the fence.
inline constexpr double kFenceRoom_m = 20.0;
/// That an aircraft in wind is flown off its path: with less nothing is taken up that need not be.
inline constexpr double kFlownOff_m = 5.0;

/// How far inside of the fence all of it is, to kFenceRoom_m at most; negative: how far it leads
/// out. Paths are looked at every metre, orbits are exact. kFenceRoom_m where there is no fence.
[[nodiscard]] double fence_room_m(const Fence& fence, const Path& path);
[[nodiscard]] double fence_room_m(const Fence& fence, const Vec2& centre, double radius_m);
/// Of the better of the two orbits that begin at that pose.
[[nodiscard]] double fence_room_m(const Fence& fence, const Pose2& at, double radius_m);

struct FenceWay {
  Path path;
  Pose2 end;
  double room_m = 0.0;  ///< of the path and of an orbit at its end
};

/// How ways are planned.
struct WayRules {
  planning::AvoidanceParams avoidance;
  double radius_m = 0.0;
};

/// The shortest way between two poses, clear of hazards, that keeps kFenceRoom_m of the fence, or
/// as much as its ends have, and ends where an orbit does: by another turn or with another heading
/// at its end, where it must. Where none does, the one with the most room; so who is outside comes
/// in without going further out. None where hazards leave no way.
/// Cost: as shortest_clear_path(), and where that way leads out some hundred Dubins paths.
[[nodiscard]] std::optional<FenceWay> way_within(const Fence& fence, const WayRules& rules,
                                                 const Pose2& from, const Pose2& to,
                                                 const std::vector<Hazard>& hazards);

/// The places on the shortest straight legs within the fence between two points, without these:
/// beside the corners around which the legs turn. None where the straight line stays inside, or
/// nothing does.
[[nodiscard]] std::vector<Vec2> corners_between(const Fence& fence, const Vec2& from,
                                                const Vec2& to);

}  // namespace skein::mission
