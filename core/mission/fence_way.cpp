// SPDX-License-Identifier: Apache-2.0
#include "fence_way.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "skein/base/angles.hpp"
#include "skein/planning/dubins.hpp"

namespace skein::mission {
namespace {

constexpr double kLook_m = 1.0;  ///< along a path
/// That are tried at the end of a way.
constexpr int kHeadings = 16;
constexpr double kRounding_m = 1e-6;

Pose2 turned(const Pose2& pose, int heading) {
  return {pose.x_m, pose.y_m, wrap_pi(pose.heading_rad + heading * kTwoPi / kHeadings)};
}

/// All of them, shortest first.
std::vector<planning::DubinsPath> dubins_ways(const Pose2& from, const Pose2& to, double radius_m) {
  std::vector<planning::DubinsPath> ways;
  for (int heading = 0; heading < kHeadings; ++heading) {
    for (int word = 0; word < static_cast<int>(planning::DubinsWord::count); ++word) {
      const auto way = planning::dubins_word(static_cast<planning::DubinsWord>(word), from,
                                             turned(to, heading), radius_m, radius_m);
      if (way) ways.push_back(*way);
    }
  }
  std::ranges::stable_sort(ways, {}, &planning::DubinsPath::length_m);
  return ways;
}

/// A place beside each corner that points into the fence, as far from it as a way keeps where there
/// is room.
std::vector<Vec2> beside_corners(const Fence& fence) {
  const std::size_t n = fence.corners.size();
  std::vector<Vec2> places;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2& corner = fence.corners[i];
    const Vec2 back = (fence.corners[(i + n - 1) % n] - corner).normalized();
    const Vec2 on = (fence.corners[(i + 1) % n] - corner).normalized();
    const Vec2 middle = back + on;
    if (middle.norm() < kRounding_m) continue;
    const Vec2 away = corner - kFenceRoom_m * middle.normalized();
    if (fence.inside_m(away) > 0.0) places.push_back(away);
  }
  return places;
}

bool is_straight_within(const Fence& fence, const Vec2& from, const Vec2& to) {
  const Vec2 way = to - from;
  Path line{{from.x(), from.y(), std::atan2(way.y(), way.x())}, {}};
  (void)line.append(Segment{0.0, way.norm()});
  return fence_room_m(fence, line) >= 0.0;
}

}  // namespace

double fence_room_m(const Fence& fence, const Path& path) {
  if (!fence.exists()) return kFenceRoom_m;
  const double length_m = path.length_m();
  double least_m = kFenceRoom_m;
  for (double at_m = 0.0;;) {
    const double inside_m = fence.inside_m(path.pose_at(at_m).position());
    least_m = std::min(least_m, inside_m);
    if (at_m >= length_m) return least_m;
    // Nothing is nearer to the edge by more than was flown.
    at_m = std::min(at_m + std::max(inside_m - least_m, kLook_m), length_m);
  }
}

/// A fence has no holes: a circle within it encloses nothing that is outside.
double fence_room_m(const Fence& fence, const Vec2& centre, double radius_m) {
  if (!fence.exists()) return kFenceRoom_m;
  return std::min(kFenceRoom_m, fence.inside_m(centre) - radius_m);
}

double fence_room_m(const Fence& fence, const Pose2& at, double radius_m) {
  const Vec2 left = radius_m * left_of(unit_vector(at.heading_rad));
  return std::max(fence_room_m(fence, at.position() + left, radius_m),
                  fence_room_m(fence, at.position() - left, radius_m));
}

std::optional<FenceWay> way_within(const Fence& fence, const WayRules& rules, const Pose2& from,
                                   const Pose2& to, const std::vector<Hazard>& hazards) {
  const double radius_m = rules.radius_m;
  const auto direct = planning::shortest_clear_path(rules.avoidance, from, to, radius_m, hazards);
  if (!fence.exists()) {
    return direct ? std::optional{FenceWay{*direct, to, kFenceRoom_m}} : std::nullopt;
  }
  const double ends_m = std::min(fence.inside_m(from.position()), fence.inside_m(to.position()));
  const double wanted_m = std::min(kFenceRoom_m, ends_m) - kRounding_m;
  std::optional<FenceWay> best;
  const auto suits = [&](const Path& path) {
    const Pose2 end = path.end();
    const double end_m = fence_room_m(fence, end, radius_m);
    if (best && end_m <= best->room_m) return false;
    const double room_m = std::min(end_m, fence_room_m(fence, path));
    if (!best || room_m > best->room_m) best = FenceWay{path, end, room_m};
    return room_m >= wanted_m;
  };
  if (direct && suits(*direct)) return FenceWay{*direct, to, best->room_m};
  std::vector<Hazard> circles = hazards;
  for (Hazard& circle : circles) circle.radius_m = rules.avoidance.safety_radius_m(circle);
  for (const planning::DubinsPath& way : dubins_ways(from, to, radius_m)) {
    const Path path = way.to_path();
    if (planning::is_clear(path, circles) && suits(path)) return best;
  }
  for (int heading = 1; heading < kHeadings && !hazards.empty(); ++heading) {
    const auto around = planning::shortest_clear_path(rules.avoidance, from, turned(to, heading),
                                                      radius_m, hazards);
    if (around && suits(*around)) return best;
  }
  return best;
}

std::vector<Vec2> corners_between(const Fence& fence, const Vec2& from, const Vec2& to) {
  if (!fence.exists() || is_straight_within(fence, from, to)) return {};
  std::vector<Vec2> places = beside_corners(fence);
  places.push_back(to);
  // Dijkstra: a polygon has few corners.
  constexpr double kNever = std::numeric_limits<double>::infinity();
  constexpr std::size_t kStart = std::numeric_limits<std::size_t>::max();
  struct Reached {
    double length_m = kNever;
    std::size_t before = kStart;
    bool done = false;
  };
  std::vector<Reached> reached(places.size());
  for (std::size_t at = kStart;;) {
    const Vec2& here = at == kStart ? from : places[at];
    const double until_here_m = at == kStart ? 0.0 : reached[at].length_m;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double length_m = until_here_m + (places[i] - here).norm();
      if (reached[i].done || length_m >= reached[i].length_m) continue;
      if (is_straight_within(fence, here, places[i])) reached[i] = {length_m, at, false};
    }
    const auto next = std::ranges::min_element(
        reached, {}, [](const Reached& place) { return place.done ? kNever : place.length_m; });
    if (next->done || next->length_m == kNever) return {};
    next->done = true;
    at = static_cast<std::size_t>(next - reached.begin());
    if (at + 1 == places.size()) break;
  }
  std::vector<Vec2> corners;
  for (std::size_t at = reached.back().before; at != kStart; at = reached[at].before) {
    corners.push_back(places[at]);
  }
  std::ranges::reverse(corners);
  return corners;
}

}  // namespace skein::mission
