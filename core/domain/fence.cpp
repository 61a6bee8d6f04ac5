// SPDX-License-Identifier: Apache-2.0
#include "skein/domain/fence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "skein/base/assert.hpp"

namespace skein {
namespace {

/// At least, from one point of a path to the next that is looked at.
constexpr double kFenceStep_m = 0.5;

/// Of which side of the line from a to b: 1, -1, or 0 on it.
int side(const Vec2& a, const Vec2& b, const Vec2& point) {
  const double turn = cross(b - a, point - a);
  return turn > 0.0 ? 1 : turn < 0.0 ? -1 : 0;
}

bool meet(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const bool crosses = side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0;
  const auto lies_on = [](const Vec2& point, const Vec2& from, const Vec2& to) {
    return distance_to_segment(point, from, to) == 0.0;
  };
  return crosses || lies_on(c, a, b) || lies_on(d, a, b) || lies_on(a, c, d) || lies_on(b, c, d);
}

/// FNV-1a, 32 bits.
void mix(std::uint32_t& hash, double metres) {
  auto bits = static_cast<std::uint64_t>(std::llround(metres * 1000.0));
  for (int i = 0; i < 8; ++i, bits >>= 8U) {
    hash = (hash ^ static_cast<std::uint32_t>(bits & 0xFFU)) * 16'777'619U;
  }
}

}  // namespace

double Fence::inside_m(const Vec2& point) const {
  SKEIN_ASSERT(exists());
  double nearest_m = std::numeric_limits<double>::infinity();
  bool inside = false;
  Vec2 a = corners.back();
  for (const Vec2& b : corners) {
    nearest_m = std::min(nearest_m, distance_to_segment(point, a, b));
    // A ray to the east crosses the edges around an inner point an odd number of times.
    if ((a.y() > point.y()) != (b.y() > point.y())) {
      const double east = a.x() + (point.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
      if (point.x() < east) inside = !inside;
    }
    a = b;
  }
  return inside ? nearest_m : -nearest_m;
}

bool Fence::holds(const Path& path) const {
  if (!exists()) return true;
  const double length_m = path.length_m();
  double at_m = 0.0;
  while (true) {
    const double inside = inside_m(path.pose_at(at_m).position());
    if (inside < 0.0) return false;
    if (at_m >= length_m) return true;
    // Nothing leaves sooner than straight on to the nearest edge.
    at_m = std::min(at_m + std::max(inside, kFenceStep_m), length_m);
  }
}

std::uint32_t digest_of(const Fence& fence) {
  if (!fence.exists()) return 0;
  std::uint32_t hash = 2'166'136'261U;
  for (const Vec2& corner : fence.corners) {
    mix(hash, corner.x());
    mix(hash, corner.y());
  }
  mix(hash, fence.height_max_m);
  return std::max(hash, 1U);
}

std::optional<std::string> why_no_fence(const Fence& fence) {
  constexpr double kMost_m = 1e6;
  if (fence.corners.size() < 3 || fence.corners.size() > Fence::kCornersMax) {
    return "a fence has 3 to " + std::to_string(Fence::kCornersMax) + " corners";
  }
  const bool is_near = std::ranges::all_of(fence.corners, [](const Vec2& corner) {
    return corner.allFinite() && std::abs(corner.x()) <= kMost_m && std::abs(corner.y()) <= kMost_m;
  });
  if (!is_near) return "a corner is more than 1000 km from the origin";
  if (!is_simple_polygon(fence.corners)) return "its edges cross or touch each other";
  if (!(fence.height_max_m > 0.0) || fence.height_max_m > kMost_m) {
    return "its height is to be above 0 m";
  }
  return std::nullopt;
}

bool is_simple_polygon(const std::vector<Vec2>& corners) {
  const std::size_t n = corners.size();
  SKEIN_ASSERT(n >= 3);
  const auto corner = [&](std::size_t i) -> const Vec2& { return corners[i % n]; };
  for (std::size_t i = 0; i < n; ++i) {
    if (corner(i) == corner(i + 1)) return false;
    // A spike comes back on its own edge.
    const Vec2 in = corner(i + 1) - corner(i);
    const Vec2 out = corner(i + 2) - corner(i + 1);
    if (cross(in, out) == 0.0 && in.dot(out) < 0.0) return false;
    for (std::size_t j = i + 2; j < n; ++j) {
      const bool neighbours = i == 0 && j + 1 == n;
      if (!neighbours && meet(corner(i), corner(i + 1), corner(j), corner(j + 1))) return false;
    }
  }
  return true;
}

}  // namespace skein
