// SPDX-License-Identifier: Apache-2.0
#include "skein/routes/corridors.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "skein/base/random.hpp"
#include "skein/paper_routes/paper_world.hpp"
#include "skein/routes/fly_by.hpp"

namespace skein::routes {
namespace {

TEST(Corridors, OneDiscIsPassedOnBothSides) {
  // Tangents of length sqrt(100^2 - 60^2), and the arc between.
  const std::vector<Disc> discs = {{{100, 0}, 60}};
  const auto found = shortest_corridors({.start = {0, 0}, .goal = {200, 0}}, discs, 5);
  ASSERT_EQ(found.size(), 2U);
  for (const Corridor& corridor : found) {
    EXPECT_NEAR(corridor.length_m, 160.0 + 60.0 * 2.0 * std::asin(0.6), 1e-9);
    ASSERT_EQ(corridor.bends.size(), 1U);
  }
  EXPECT_NE(found[0].bends[0].sense, found[1].bends[0].sense);
}

TEST(Corridors, ThePapersThreeVehiclesHaveTheBoundsOfTheTangentGraph) {
  std::vector<Disc> all;
  std::vector<Disc> without_detections;
  for (const RouteHazard& h : paper_hazards()) {
    all.push_back({h.centre, h.radius_m});
    if (h.kind != HazardKind::detection) without_detections.push_back({h.centre, h.radius_m});
  }
  const RouteProblem team = paper_team();
  const auto longest = [&](const std::vector<Disc>& discs) {
    double most = 0.0;
    for (const RouteVehicle& v : team.vehicles) {
      const Vec2 goal = team.site - 100.0 * unit_vector(v.approach_heading_rad);
      const auto found = shortest_corridors({.start = v.start, .goal = goal}, discs, 1);
      most = std::max(most, found.at(0).length_m + 100.0);
    }
    return most;
  };
  EXPECT_NEAR(longest(all), 1745.0, 0.05);
  EXPECT_NEAR(longest(without_detections), 1480.6, 0.05);
}

TEST(Corridors, AreFlyableClearAndInOrder) {
  Random random{5};
  int seen = 0;
  for (int k = 0; k < 40; ++k) {
    std::vector<Disc> discs;
    for (int i = 0; i < 12; ++i) {
      discs.push_back(
          {{random.uniform(100, 900), random.uniform(100, 900)}, random.uniform(20, 120)});
    }
    const CorridorEnds ends{.start = {0, 0},
                            .start_heading_rad = random.uniform(-kPi, kPi),
                            .start_cone_rad = 0.5,
                            .goal = {1000, 1000},
                            .goal_heading_rad = random.uniform(-kPi, kPi),
                            .turn_radius_m = 15};
    const auto found = shortest_corridors(ends, discs, 6);
    double before = 0.0;
    for (const Corridor& corridor : found) {
      EXPECT_GE(corridor.length_m, before);
      before = corridor.length_m;
      std::vector<Vec2> way = corners_of(corridor, 0.4);
      way.insert(way.begin(), ends.start);
      way.push_back(ends.goal + 10.0 * unit_vector(*ends.goal_heading_rad));
      if (way.size() > kWaypointsMax) continue;
      const auto path = fly_by_path(way, 15.0);
      ASSERT_TRUE(path.ok()) << path.error().message;
      ++seen;
      const Vec2 first = way[1] - way[0];
      EXPECT_LE(std::abs(wrap_pi(std::atan2(first.y(), first.x()) - ends.start_heading_rad)),
                0.5 + 1e-9);
      EXPECT_NEAR(wrap_pi(path->end().heading_rad - *ends.goal_heading_rad), 0.0, 1e-9);
      // Corners cut outside of a circle are a little longer than its arc.
      EXPECT_GE(path->length_m(), corridor.length_m + 10.0 - 1e-6);
      EXPECT_LE(path->length_m(), 1.01 * (corridor.length_m + 10.0));
      for (const Disc& disc : discs) {
        Pose2 at = path->start;
        for (const Segment& piece : path->segments) {
          EXPECT_GE(distance_to_piece(disc.centre, at, piece.curvature_per_m, piece.length_m),
                    disc.radius_m - 1e-5);
          at = advance(at, piece.curvature_per_m, piece.length_m);
        }
      }
    }
  }
  EXPECT_GT(seen, 100);
}

TEST(Corridors, ThereIsNoneThroughAWall) {
  std::vector<Disc> ring;
  for (int i = 0; i < 12; ++i) {
    ring.push_back({300.0 * unit_vector(i * kPi / 6.0), 90});
  }
  EXPECT_TRUE(shortest_corridors({.start = {0, 0}, .goal = {600, 0}}, ring, 3).empty());
}

}  // namespace
}  // namespace skein::routes
