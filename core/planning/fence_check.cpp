// SPDX-License-Identifier: Apache-2.0
#include "skein/planning/fence_check.hpp"

#include <algorithm>
#include <cmath>

#include "skein/base/angles.hpp"

namespace skein::planning {
namespace {

/// At least, from one point that is looked at to the next.
constexpr double kStep_m = 0.5;
constexpr int kDirections = 360;

Vec2 aside(int direction, double radius_m) {
  return radius_m * unit_vector(direction * kTwoPi / kDirections);
}

template <class PlaceAt>
std::optional<Vec2> first_outside(const Fence& fence, double length_m, const PlaceAt& place_at) {
  if (!fence.exists()) return std::nullopt;
  bool was_inside = false;
  for (double at_m = 0.0;;) {
    Vec2 place = place_at(at_m);
    const double inside_m = fence.inside_m(place);
    if (inside_m < 0.0 && was_inside) return place;
    was_inside = was_inside || inside_m >= 0.0;
    if (at_m >= length_m) return was_inside ? std::nullopt : std::optional{place};
    // Nothing is at the edge sooner than straight on.
    at_m = std::min(at_m + std::max(std::abs(inside_m), kStep_m), length_m);
  }
}

}  // namespace

std::optional<Vec2> first_outside(const Fence& fence, const Path& path) {
  return first_outside(fence, path.length_m(),
                       [&path](double at_m) { return path.pose_at(at_m).position(); });
}

std::optional<Vec2> first_outside(const Fence& fence, const Vec2& from, const Vec2& to) {
  const double length_m = (to - from).norm();
  return first_outside(fence, length_m, [&](double at_m) -> Vec2 {
    return length_m > 0.0 ? from + at_m / length_m * (to - from) : from;
  });
}

std::optional<Vec2> first_outside(const Fence& fence, const TimedPath& timed) {
  const double curvature = std::abs(timed.tail_curvature_per_m);
  const double lap_m = curvature > 0.0 ? kTwoPi / curvature : 0.0;
  return first_outside(fence, timed.path.length_m() + lap_m,
                       [&timed](double at_m) { return timed.pose_at_distance(at_m).position(); });
}

bool orbit_leads_over(const Fence& fence, const Vec2& place, double radius_m) {
  if (!fence.exists()) return true;
  constexpr double kBetween = 0.01;  // of the radius, that a circle between two of these has more
  for (int i = 0; i < kDirections; ++i) {
    if (fence.inside_m(place + aside(i, radius_m)) >= (1.0 - kBetween) * radius_m) return true;
  }
  return false;
}

bool can_be_flown_over(const Fence& fence, const Vec2& place, double radius_m) {
  if (orbit_leads_over(fence, place, radius_m)) return true;
  for (int i = 0; i < kDirections / 2; ++i) {
    const Vec2 there = aside(i, radius_m);
    if (!first_outside(fence, place, place + there) &&
        !first_outside(fence, place, place - there)) {
      return true;
    }
  }
  return false;
}

std::string place_text(const Vec2& place) {
  return "[" + std::to_string(std::lround(place.x())) + ", " +
         std::to_string(std::lround(place.y())) + "]";
}

}  // namespace skein::planning
