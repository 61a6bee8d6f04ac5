// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "skein/base/attitude.hpp"
#include "skein/base/time.hpp"

namespace skein {

/// Where a multirotor's reference is to be from now on, if nothing newer is decided: points at
/// equal times that end at rest. Mission frame. Trivially copyable.
struct MotionTrack {
  static constexpr std::size_t kPointsMax = 128;
  static constexpr Duration kStep = std::chrono::milliseconds{50};

  struct Point {
    std::array<double, 3> position_m{};
    std::array<double, 3> velocity_mps{};
  };
  struct Moment {
    Vec3 position_m = Vec3::Zero();
    Vec3 velocity_mps = Vec3::Zero();
    Vec3 acceleration_mps2 = Vec3::Zero();
  };

  std::uint32_t number = 0;  ///< of what it is a part of
  Instant start{};           ///< of the first point
  double yaw_rad = 0.0;      ///< of the nose, from east, counter-clockwise
  std::uint16_t count = 0;   ///< of the points; at least one
  std::array<Point, kPointsMax> points{};

  /// At rest there.
  [[nodiscard]] static MotionTrack standing_at(const Vec3& place, Instant since);

  /// Cubic between two points; before the first and after the last at rest there. Precondition:
  /// count > 0.
  [[nodiscard]] Moment at(Instant t) const;
};

}  // namespace skein
