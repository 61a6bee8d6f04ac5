// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "skein/base/attitude.hpp"
#include "skein/base/frames.hpp"

namespace skein::hil {

/// Latitude and longitude in 1e-7 degrees, height in m above the ellipsoid.
struct GlobalPosition {
  std::int32_t latitude_e7 = 0;
  std::int32_t longitude_e7 = 0;
  double height_m = 0.0;
};

/// The earth as a flight controller has it: north and east are those of the mission's tangent
/// plane, but down counts from the ellipsoid, so that level flight keeps its altitude.
class Earth {
 public:
  explicit Earth(const MissionOrigin& origin) : origin_{origin} {}

  [[nodiscard]] GlobalPosition global(const Vec3& ned_m) const;
  /// Nothing for what is no place on earth.
  [[nodiscard]] std::optional<Vec3> ned(const GlobalPosition& place) const;
  [[nodiscard]] double origin_height_m() const { return origin_.origin().height_m; }

 private:
  MissionOrigin origin_;
};

}  // namespace skein::hil
