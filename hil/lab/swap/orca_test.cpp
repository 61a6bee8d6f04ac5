// SPDX-License-Identifier: Apache-2.0
#include "orca.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "skein/base/angles.hpp"
#include "skein/base/random.hpp"

namespace skein::swap {
namespace {

Vec2 random_vector(Random& random, double size) {
  return {random.uniform(-size, size), random.uniform(-size, size)};
}

/// Whether two that keep that relative velocity come nearer than r within the horizon.
bool collide(const Vec2& apart, const Vec2& relative, double r, double horizon_s) {
  const double speed2 = relative.squaredNorm();
  const double when = speed2 > 0.0 ? std::clamp(apart.dot(relative) / speed2, 0.0, horizon_s) : 0.0;
  return (apart - when * relative).norm() < r;
}

TEST(OrcaHalfPlane, HalfOfTheLeastChangeThatLeavesTheObstacle) {
  Random random{5};
  const OrcaParams params{.horizon_s = 3.0, .period_s = 0.1, .distance_m = 2.0, .speed_mps = 5.0};
  int colliding = 0;
  for (int i = 0; i < 5000; ++i) {
    const OrcaBody self{Vec2::Zero(), random_vector(random, 3.0)};
    const OrcaBody other{random_vector(random, 10.0), random_vector(random, 3.0)};
    if (other.position_m.norm() < params.distance_m + 0.01) continue;
    const HalfPlane plane = orca_half_plane(params, self, other);
    EXPECT_NEAR(plane.normal.norm(), 1.0, 1e-12);
    const Vec2 relative = self.velocity_mps - other.velocity_mps;
    const bool before = collide(other.position_m, relative, params.distance_m, params.horizon_s);
    EXPECT_EQ(before, plane.depth(self.velocity_mps) < 0.0);
    if (!before) continue;
    ++colliding;
    // Both change by u / 2: out of the obstacle, and no shorter change does it.
    const Vec2 u = 2.0 * (plane.point - self.velocity_mps);
    EXPECT_FALSE(collide(other.position_m, relative + 1.0001 * u, params.distance_m - 1e-6,
                         params.horizon_s));
    for (int k = 0; k < 16; ++k) {
      const Vec2 shorter = 0.99 * u.norm() * unit_vector(kTwoPi * k / 16.0);
      EXPECT_TRUE(
          collide(other.position_m, relative + shorter, params.distance_m, params.horizon_s));
    }
  }
  EXPECT_GT(colliding, 300);
}

TEST(OrcaHalfPlane, ThoseTooNearPartWithinAPeriod) {
  const OrcaParams params{.horizon_s = 3.0, .period_s = 0.1, .distance_m = 2.0, .speed_mps = 50.0};
  const OrcaBody self{{0.0, 0.0}, {0.0, 0.0}};
  const OrcaBody other{{1.5, 0.0}, {0.0, 0.0}};
  const Vec2 mine = orca_half_plane(params, self, other).point;
  const Vec2 theirs = orca_half_plane(params, other, self).point;
  const Vec2 apart = other.position_m + theirs * params.period_s - mine * params.period_s;
  EXPECT_NEAR(apart.norm(), params.distance_m, 1e-9);
}

/// By trying a fine grid of the disc.
Vec2 by_grid(const std::vector<HalfPlane>& planes, double speed, const Vec2& preferred,
             double& best_depth) {
  Vec2 best = Vec2::Zero();
  double nearest = 1e18;
  best_depth = -1e18;
  constexpr int kSteps = 200;
  for (int x = -kSteps; x <= kSteps; ++x) {
    for (int y = -kSteps; y <= kSteps; ++y) {
      const Vec2 v = Vec2(x, y) * (speed / kSteps);
      if (v.norm() > speed) continue;
      double depth = 1e18;
      for (const HalfPlane& plane : planes) depth = std::min(depth, plane.depth(v));
      best_depth = std::max(best_depth, depth);
      if (depth >= 0.0 && (v - preferred).norm() < nearest) {
        nearest = (v - preferred).norm();
        best = v;
      }
    }
  }
  return best;
}

TEST(OrcaVelocity, IsTheNearestAllowedOneAndElseBreaksTheWorstPlaneLeast) {
  Random random{9};
  constexpr double kSpeed = 2.0;
  constexpr double kGrid = 2.0 * kSpeed / 200.0;
  int feasible = 0;
  int infeasible = 0;
  for (int i = 0; i < 150; ++i) {
    std::vector<HalfPlane> planes(1 + random.index(8));
    for (HalfPlane& plane : planes) {
      plane.normal = unit_vector(random.uniform(0.0, kTwoPi));
      plane.point = random_vector(random, 1.2);
    }
    const Vec2 preferred = random_vector(random, 2.5);
    double grid_depth = 0.0;
    const Vec2 grid = by_grid(planes, kSpeed, preferred, grid_depth);
    const Vec2 found = orca_velocity(planes, kSpeed, preferred);
    EXPECT_LE(found.norm(), kSpeed + 1e-9);
    double depth = 1e18;
    for (const HalfPlane& plane : planes) depth = std::min(depth, plane.depth(found));
    if (grid_depth >= 0.0) {
      ++feasible;
      EXPECT_GE(depth, -1e-9);
      EXPECT_LE((found - preferred).norm(), (grid - preferred).norm() + 1e-9);
    } else if (grid_depth < -kGrid) {
      ++infeasible;
      EXPECT_GE(depth, grid_depth - 1e-9);
      EXPECT_LE(depth, grid_depth + kGrid);
    }
  }
  EXPECT_GT(feasible, 30);
  EXPECT_GT(infeasible, 30);
}

TEST(Orca, TwoHeadOnPassWithTheirDistance) {
  const OrcaParams params{.horizon_s = 5.0, .period_s = 0.02, .distance_m = 3.0, .speed_mps = 5.0};
  OrcaBody a{{-20.0, 0.05}, {0.0, 0.0}};
  OrcaBody b{{20.0, 0.0}, {0.0, 0.0}};
  const Vec2 goal_a{20.0, 0.0};
  const Vec2 goal_b{-20.0, 0.0};
  const auto preferred = [&](const OrcaBody& body, const Vec2& goal) -> Vec2 {
    const Vec2 way = goal - body.position_m;
    return way * std::min(1.0 / params.period_s, params.speed_mps / way.norm());
  };
  double least = 1e9;
  for (int i = 0; i < 1000; ++i) {
    const std::vector<HalfPlane> of_a{orca_half_plane(params, a, b)};
    const std::vector<HalfPlane> of_b{orca_half_plane(params, b, a)};
    a.velocity_mps = orca_velocity(of_a, params.speed_mps, preferred(a, goal_a));
    b.velocity_mps = orca_velocity(of_b, params.speed_mps, preferred(b, goal_b));
    EXPECT_GE(of_a.front().depth(a.velocity_mps), -1e-9);
    EXPECT_GE(of_b.front().depth(b.velocity_mps), -1e-9);
    a.position_m += a.velocity_mps * params.period_s;
    b.position_m += b.velocity_mps * params.period_s;
    least = std::min(least, (a.position_m - b.position_m).norm());
  }
  EXPECT_GE(least, params.distance_m - 1e-6);
  EXPECT_LT((a.position_m - goal_a).norm(), 0.01);
  EXPECT_LT((b.position_m - goal_b).norm(), 0.01);
}

}  // namespace
}  // namespace skein::swap
