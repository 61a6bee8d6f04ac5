// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <map>
#include <queue>
#include <tuple>
#include <vector>

#include "avoidance_margin.hpp"
#include "skein/base/angles.hpp"
#include "skein/base/random.hpp"
#include "skein/planning/avoidance.hpp"
#include "skein/planning/dubins.hpp"

namespace skein::planning {
namespace {

constexpr double kRadius_m = 165.0;

bool is_clear_piece(const Pose2& from, double curvature_per_m, double length_m,
                    std::span<const Hazard> circles) {
  return std::all_of(circles.begin(), circles.end(), [&](const Hazard& h) {
    return distance_to_piece(h.centre, from, curvature_per_m, length_m) >= h.radius_m - 1e-7;
  });
}

/// A search that knows nothing of tangents: short arcs and lines from where it is, the most
/// promising first, and from everywhere a Dubins path to the goal. Every length that it gives is
/// that of a clear path, if seldom of the shortest one. Infinite where it finds none.
double searched_length(const Pose2& from, const Pose2& to, std::span<const Hazard> circles,
                       int expansions) {
  struct Node {
    double bound_m;
    double length_m;
    Pose2 pose;
    bool operator>(const Node& other) const { return bound_m > other.bound_m; }
  };
  constexpr double kCell_m = 25.0;
  constexpr double kStep_m = 30.0;
  constexpr std::array<double, 5> kCurvatures = {0.0, 1.0, -1.0, 0.5, -0.5};
  std::priority_queue<Node, std::vector<Node>, std::greater<>> open;
  std::map<std::tuple<int, int, int>, double> reached;
  open.push({0.0, 0.0, from});
  double best_m = INFINITY;
  while (!open.empty() && expansions-- > 0) {
    const Node node = open.top();
    open.pop();
    if (node.bound_m >= best_m) break;
    for (std::uint8_t w = 0; w < 6; ++w) {
      const auto word = dubins_word(DubinsWord{w}, node.pose, to, kRadius_m, kRadius_m);
      if (!word || node.length_m + word->length_m() >= best_m) continue;
      if (is_clear(word->to_path(), circles)) best_m = node.length_m + word->length_m();
    }
    for (const double part : kCurvatures) {
      const double curvature = part / kRadius_m;
      if (!is_clear_piece(node.pose, curvature, kStep_m, circles)) continue;
      const Pose2 next = advance(node.pose, curvature, kStep_m);
      const double length_m = node.length_m + kStep_m;
      const auto cell = std::tuple{static_cast<int>(std::floor(next.x_m / kCell_m)),
                                   static_cast<int>(std::floor(next.y_m / kCell_m)),
                                   static_cast<int>(std::floor(next.heading_rad * 36.0 / kTwoPi))};
      const auto [known, fresh] = reached.try_emplace(cell, length_m);
      if (!fresh && known->second <= length_m) continue;
      known->second = length_m;
      const double bound_m = length_m + shortest_dubins_length(next, to, kRadius_m);
      if (bound_m < best_m) open.push({bound_m, length_m, next});
    }
  }
  return best_m;
}

struct Comparison {
  int found = 0;
  int longer = 0;  ///< than the path that the search finds
  int missed = 0;  ///< refused, though the search finds a path
};

Hazard random_hazard(Random& random, std::size_t id, double least_m, double largest_m) {
  const double x_m = random.uniform(0.0, 2000.0);
  const double y_m = random.uniform(0.0, 2000.0);
  return {HazardId{static_cast<std::uint16_t>(id)}, {x_m, y_m}, random.uniform(least_m, largest_m)};
}

/// In worlds where the Dubins path is barred: is our path ever longer than what the search finds
/// outside the same circles?
Comparison compare(std::uint64_t seed, int worlds, std::size_t hazard_count, double least_m,
                   double largest_m) {
  constexpr int kExpansions = 8000;
  Random random{seed};
  Comparison result;
  while (worlds > 0) {
    const auto pose = [&](double low_m, double high_m) {
      const double x_m = random.uniform(low_m, high_m);
      const double y_m = random.uniform(0.0, 2000.0);
      return Pose2{x_m, y_m, random.uniform(-kPi, kPi)};
    };
    const Pose2 from = pose(0.0, 1000.0);
    const Pose2 to = pose(1000.0, 2000.0);
    std::vector<Hazard> hazards;
    while (hazards.size() < hazard_count) {
      const Hazard h = random_hazard(random, hazards.size(), least_m, largest_m);
      const double room_m =
          std::min((h.centre - from.position()).norm(), (h.centre - to.position()).norm());
      if (room_m > h.radius_m) hazards.push_back(h);
    }
    if (is_clear(shortest_dubins(from, to, kRadius_m).to_path(), hazards)) continue;
    --worlds;
    const auto ours = find_clear_path({}, from, to, kRadius_m, hazards);
    if (!ours) {
      result.missed += searched_length(from, to, hazards, kExpansions) < INFINITY ? 1 : 0;
      continue;
    }
    ++result.found;
    EXPECT_TRUE(is_clear(ours->path, ours->circles));
    EXPECT_NEAR((ours->path.end().position() - to.position()).norm(), 0.0, 1e-6);
    const double searched_m = searched_length(from, to, ours->circles, kExpansions);
    result.longer += ours->path.length_m() > searched_m + 1e-3 ? 1 : 0;
  }
  return result;
}

TEST(AvoidanceSearch, NothingIsShorterThanTheTangentsOfLargeHazards) {
  const Comparison result = compare(1, 12, 4, 170.0, 400.0);
  EXPECT_GE(result.found, 8);
  EXPECT_EQ(result.longer, 0);
  EXPECT_EQ(result.missed, 0);
}

TEST(AvoidanceSearch, HardlyAnythingIsShorterAmongSmallHazards) {
  const Comparison result = compare(2, 12, 8, 30.0, 160.0);
  EXPECT_GE(result.found, 8);
  EXPECT_LE(result.longer, 1);
  EXPECT_EQ(result.missed, 0);
}

TEST(AvoidanceSearch, DISABLED_ManyWorlds) {
  const Comparison large = compare(3, 1000, 4, 170.0, 400.0);
  EXPECT_GE(large.found, 800);
  EXPECT_LE(large.longer, 8);
  EXPECT_EQ(large.missed, 0);
  const Comparison small = compare(4, 1000, 8, 30.0, 160.0);
  EXPECT_GE(small.found, 850);
  EXPECT_LE(small.longer, 12);
  EXPECT_EQ(small.missed, 0);
  std::printf("longer: %d of %d, %d of %d; missed: %d, %d\n", large.longer, large.found,
              small.longer, small.found, large.missed, small.missed);
}

}  // namespace
}  // namespace skein::planning
