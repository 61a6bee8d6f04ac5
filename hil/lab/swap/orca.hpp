// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "skein/base/geometry.hpp"

/// Optimal reciprocal collision avoidance, written from van den Berg, Guy, Lin and Manocha,
/// "Reciprocal n-body collision avoidance" (2011): a peer to compare with, in the plane.
namespace skein::swap {

/// The velocities v with (v - point) . normal >= 0. The normal has length 1.
struct HalfPlane {
  Vec2 point = Vec2::Zero();
  Vec2 normal = Vec2::UnitX();

  [[nodiscard]] double depth(const Vec2& v) const { return (v - point).dot(normal); }
};

struct OrcaParams {
  double horizon_s = 5.0;   ///< tau: no collision within it; > 0
  double period_s = 0.02;   ///< within which those that are too near must part; > 0
  double distance_m = 3.0;  ///< sum of the two radii; > 0
  double speed_mps = 5.0;   ///< limit; > 0
};

struct OrcaBody {
  Vec2 position_m = Vec2::Zero();
  Vec2 velocity_mps = Vec2::Zero();
};

/// What `self` may fly so that, if the other does as much, they keep distance_m for horizon_s: half
/// of the least change u of the relative velocity that leaves the velocity obstacle (section 4).
[[nodiscard]] HalfPlane orca_half_plane(const OrcaParams& params, const OrcaBody& self,
                                        const OrcaBody& other);

/// The allowed velocity nearest to `preferred` of at most `speed` (section 4, the incremental
/// linear program of de Berg et al.). Where the half planes leave none, the one that breaks the
/// worst of them least (section 5.3, the linear program in three dimensions). Expected O(planes)
/// for planes in random order, O(planes^2) for those of the other order.
[[nodiscard]] Vec2 orca_velocity(std::span<const HalfPlane> planes, double speed_mps,
                                 const Vec2& preferred);

}  // namespace skein::swap
