// SPDX-License-Identifier: Apache-2.0
#include "skein/planning/avoidance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "skein/base/angles.hpp"
#include "skein/base/random.hpp"
#include "skein/planning/dubins.hpp"

namespace skein::planning {
namespace {

constexpr double kRadius_m = 165.0;

Hazard circle(double x_m, double y_m, double radius_m, std::uint16_t id = 1) {
  return {HazardId{id}, {x_m, y_m}, radius_m};
}

/// By walking the path in small steps.
double clearance(const Path& path, std::span<const Hazard> hazards) {
  double least = INFINITY;
  const int steps = static_cast<int>(path.length_m() / 0.5);
  for (int i = 0; i <= steps; ++i) {
    const double s = 0.5 * i;
    for (const Hazard& h : hazards) {
      least = std::min(least, (path.pose_at(s).position() - h.centre).norm() - h.radius_m);
    }
  }
  return least;
}

void expect_flies(const Path& path, const Pose2& from, const Pose2& to,
                  std::span<const Hazard> hazards) {
  EXPECT_NEAR((path.start.position() - from.position()).norm(), 0.0, 1e-12);
  EXPECT_NEAR((path.end().position() - to.position()).norm(), 0.0, 1e-6);
  EXPECT_NEAR(wrap_pi(path.end().heading_rad - to.heading_rad), 0.0, 1e-8);
  EXPECT_LE(path.curvature_max_per_m(), 1.0 / kRadius_m + 1e-12);
  EXPECT_TRUE(is_clear(path, hazards));
  EXPECT_GE(clearance(path, hazards), -1e-6);
}

TEST(IsClear, IsExactAndTouchingIsOutside) {
  Path line{.start = {0, 0, 0}, .segments = {}};
  ASSERT_TRUE(line.append(Segment{0.0, 1000.0}));
  EXPECT_TRUE(is_clear(line, std::vector{circle(500, 100, 100)}));
  EXPECT_FALSE(is_clear(line, std::vector{circle(500, 100, 100.001)}));
  EXPECT_TRUE(is_clear(line, std::vector{circle(1100, 0, 99.9)}));
  EXPECT_FALSE(is_clear(line, std::vector{circle(-100, 0, 100.1)}));
  Path half{.start = {0, 0, 0}, .segments = {}};  // to the left, around (0, 200)
  ASSERT_TRUE(half.append(Segment{1.0 / 200.0, 200.0 * kPi}));
  EXPECT_TRUE(is_clear(half, std::vector{circle(0, 200, 200)}));
  EXPECT_TRUE(is_clear(half, std::vector{circle(-200, 200, 199)}));
  EXPECT_FALSE(is_clear(half, std::vector{circle(250, 200, 50.001)}));
  EXPECT_FALSE(is_clear(Path{.start = {0, 0, 0}, .segments = {}}, std::vector{circle(0, 0, 1)}));
}

TEST(ClearPath, IsTheDubinsPathWhereNothingIsInTheWay) {
  const Pose2 from{0, 0, 0.3};
  const Pose2 to{2000, 500, 1.0};
  const std::vector<Hazard> hazards{circle(1000, 3000, 300)};
  const auto path = shortest_clear_path({}, from, to, kRadius_m, hazards);
  ASSERT_TRUE(path.ok());
  EXPECT_DOUBLE_EQ(path->length_m(), shortest_dubins_length(from, to, kRadius_m));
}

TEST(ClearPath, AroundOneHazardIsTheTautString) {
  // From afar, symmetric: two tangents to the safety circle and the arc between them.
  const double safety_m = 1.1 * 400.0;
  const double far_m = 4000.0;
  const double tangent_m = std::sqrt(far_m * far_m - safety_m * safety_m);
  const double angle = std::asin(safety_m / far_m);
  const std::vector<Hazard> hazards{circle(0, 0, 400)};
  const auto path =
      shortest_clear_path({}, {-far_m, 0, angle}, {far_m, 0, -angle}, kRadius_m, hazards);
  ASSERT_TRUE(path.ok()) << path.error().message;
  EXPECT_NEAR(path->length_m(), 2.0 * tangent_m + 2.0 * angle * safety_m, 1e-6);
}

TEST(ClearPath, PassesASmallHazardClosely) {
  const std::vector<Hazard> hazards{circle(1500, 0, 40)};
  const Pose2 from{0, 0, 0};
  const Pose2 to{3000, 0, 0};
  const auto path = shortest_clear_path({}, from, to, kRadius_m, hazards);
  ASSERT_TRUE(path.ok()) << path.error().message;
  expect_flies(*path, from, to, hazards);
  EXPECT_LT(path->length_m(), 3010.0);
}

TEST(ClearPath, OverlappingHazardsAndChains) {
  const Pose2 from{0, 0, 0};
  const Pose2 to{4000, 0, 0};
  const std::vector<Hazard> wall{circle(1500, -300, 250, 1), circle(1500, 0, 250, 2),
                                 circle(1500, 300, 250, 3), circle(2600, 500, 300, 4),
                                 circle(2600, -600, 300, 5)};
  const auto path = shortest_clear_path({}, from, to, kRadius_m, wall);
  ASSERT_TRUE(path.ok()) << path.error().message;
  expect_flies(*path, from, to, wall);
  EXPECT_LT(path->length_m(), 4600.0);
}

TEST(ClearPath, StartAndGoalInsideASafetyCircle) {
  const std::vector<Hazard> hazards{circle(0, 0, 500)};
  const Pose2 from{-520, 0, kPi / 2.0};
  const Pose2 to{520, 0, -kPi / 2.0};
  const auto path = shortest_clear_path({}, from, to, kRadius_m, hazards);
  ASSERT_TRUE(path.ok()) << path.error().message;
  expect_flies(*path, from, to, hazards);
}

TEST(ClearPath, KeepsTheWholeMarginWhereBothEndsAllowIt) {
  Random random{32};
  int kept = 0;
  for (int i = 0; i < 50; ++i) {
    std::vector<Hazard> hazards;
    for (std::uint16_t h = 0; h < 4; ++h) {
      const double x_m = random.uniform(1200.0, 3800.0);
      const double y_m = random.uniform(0.0, 4000.0);
      hazards.push_back(circle(x_m, y_m, random.uniform(50.0, 500.0), h));
    }
    const Pose2 from{0.0, random.uniform(0.0, 4000.0), 0.0};
    const Pose2 to{5000.0, random.uniform(0.0, 4000.0), 0.0};
    const auto path = shortest_clear_path({}, from, to, kRadius_m, hazards);
    ASSERT_TRUE(path.ok()) << path.error().message;
    std::vector<Hazard> safety = hazards;
    for (Hazard& h : safety) h.radius_m *= 1.1;
    EXPECT_TRUE(is_clear(*path, safety));
    expect_flies(*path, from, to, safety);
    kept += path->length_m() > shortest_dubins_length(from, to, kRadius_m) + 1e-6 ? 1 : 0;
  }
  EXPECT_GT(kept, 15);
}

TEST(ClearPath, AnEndWithinASafetyCircleKeepsWhatItHas) {
  const std::vector<Hazard> hazards{circle(0, 0, 500)};
  const Pose2 beyond{2000.0, 0.0, 0.0};
  for (const double at_m : {501.0, 510.0, 530.0, 549.0}) {
    for (const double heading : {kPi / 2.0, 2.0, 3.0, -2.0, -kPi / 2.0}) {  // along or away
      const Pose2 near{-at_m, 0.0, heading};
      const auto out = shortest_clear_path({}, near, beyond, kRadius_m, hazards);
      ASSERT_TRUE(out.ok()) << out.error().message;
      expect_flies(*out, near, beyond, hazards);
      EXPECT_GE(clearance(*out, hazards), at_m - 500.0 - 1e-4);
      const Pose2 back{-at_m, 0.0, wrap_pi(heading + kPi)};
      const Pose2 far{2000.0, 0.0, kPi};
      const auto in = shortest_clear_path({}, far, back, kRadius_m, hazards);
      ASSERT_TRUE(in.ok()) << in.error().message;
      expect_flies(*in, far, back, hazards);
      EXPECT_NEAR(in->length_m(), out->length_m(), 1e-3);
    }
  }
}

TEST(ClearPath, AStartHeadedForAHazardTurnsAwayAsFarAsItCan) {
  const std::vector<Hazard> hazards{circle(0, 0, 500, 7)};
  // The tightest turn passes the centre of the hazard at |(d, r)| - r.
  for (const double wanted_m : {1.0, 20.0, 49.0}) {
    const double d = std::sqrt((500.0 + wanted_m + kRadius_m) * (500.0 + wanted_m + kRadius_m) -
                               kRadius_m * kRadius_m);
    const Pose2 from{-d, 0.0, 0.0};
    const Pose2 to{2000.0, 0.0, 0.0};
    const auto path = shortest_clear_path({}, from, to, kRadius_m, hazards);
    ASSERT_TRUE(path.ok()) << path.error().message;
    expect_flies(*path, from, to, hazards);
    EXPECT_NEAR(clearance(*path, hazards), wanted_m, 0.01);
  }
  const auto late = shortest_clear_path({}, {-510.0, 0, 0}, {3000, 0, 0}, kRadius_m, hazards);
  ASSERT_FALSE(late.ok());
  EXPECT_NE(late.error().message.find("no turn of 165 m is tight enough to miss hazard 7"),
            std::string::npos)
      << late.error().message;
}

TEST(ClearPath, RefusesAGoalThatAHazardBars) {
  const std::vector<Hazard> hazards{circle(0, 0, 500, 7)};
  const auto inside = shortest_clear_path({}, {3000, 0, 0}, {100, 0, 0}, kRadius_m, hazards);
  ASSERT_FALSE(inside.ok());
  EXPECT_NE(inside.error().message.find("lies inside hazard 7"), std::string::npos);
  // The final approach would have to lead through it.
  const auto behind = shortest_clear_path({}, {-3000, 0, 0}, {510, 0, 0}, kRadius_m, hazards);
  ASSERT_FALSE(behind.ok());
  EXPECT_NE(behind.error().message.find("cannot be approached on its heading: hazard 7"),
            std::string::npos)
      << behind.error().message;
  Path run{.start = {-1000, 0, 0}, .segments = {}};
  ASSERT_TRUE(run.append(Segment{0.0, 600.0}));
  const std::vector<Hazard> two{circle(0, 3000, 500, 6), hazards[0]};
  ASSERT_NE(first_entered(run, two), nullptr);
  EXPECT_EQ(first_entered(run, two)->id, HazardId{7});
}

/// The least length of a path of up to three tightest arcs and lines that ends outside.
double searched_way_out(const Pose2& from, const Hazard& hazard) {
  constexpr int kSteps = 60;
  double best = INFINITY;
  const auto outside = [&](const Pose2& p) {
    return (p.position() - hazard.centre).norm() >= hazard.radius_m;
  };
  for (const double first : {1.0, -1.0}) {
    for (int i = 0; i < kSteps; ++i) {
      const double turn_m = i * kPi * kRadius_m / kSteps;
      const Pose2 turned = advance(from, first / kRadius_m, turn_m);
      for (const double second : {0.0, 1.0, -1.0}) {
        for (int k = 0; k < 400; ++k) {
          const double then_m = 3.0 * k;
          if (turn_m + then_m >= best) break;
          if (outside(advance(turned, second / kRadius_m, then_m))) best = turn_m + then_m;
        }
      }
    }
  }
  return best;
}

TEST(ClearPath, LeavesAHazardThatHasJustAppearedByTheShortestWay) {
  Random random{33};
  const Pose2 to{3000.0, 500.0, 1.0};
  for (int i = 0; i < 60; ++i) {
    const std::vector<Hazard> hazards{circle(0, 0, random.uniform(50.0, 600.0)),
                                      circle(1500, 0, 300, 2)};
    const double spoke = random.uniform(0.0, 0.98) * hazards[0].radius_m;
    const Vec2 at = spoke * unit_vector(random.uniform(-kPi, kPi));
    const Pose2 from{at.x(), at.y(), random.uniform(-kPi, kPi)};
    const auto path = shortest_clear_path({}, from, to, kRadius_m, hazards);
    ASSERT_TRUE(path.ok()) << path.error().message;
    EXPECT_NEAR((path->end().position() - to.position()).norm(), 0.0, 1e-6);
    EXPECT_LE(path->curvature_max_per_m(), 1.0 / kRadius_m + 1e-12);
    double left_m = 0.0;  // where it is inside for the last time
    for (int k = 0; k * 0.25 < path->length_m(); ++k) {
      const Vec2 p = path->pose_at(0.25 * k).position();
      if (p.norm() < hazards[0].radius_m - 1e-5) left_m = 0.25 * k;
      EXPECT_GE((p - hazards[1].centre).norm(), 300.0 - 1e-5);
    }
    EXPECT_LE(left_m, searched_way_out(from, hazards[0]) + 0.01) << i;
  }
}

TEST(ClearPath, RandomWorlds) {
  Random random{31};
  int asked = 0;
  int found = 0;
  int direct = 0;
  for (int i = 0; i < 150; ++i) {
    std::vector<Hazard> hazards;
    for (std::uint16_t h = 0; h < 6; ++h) {
      hazards.push_back(
          circle(random.uniform(0, 5000), random.uniform(0, 5000), random.uniform(30.0, 500.0), h));
    }
    const auto pose = [&] {
      return Pose2{random.uniform(0, 5000), random.uniform(0, 5000), random.uniform(-kPi, kPi)};
    };
    const auto away = [&](const Pose2& p) {  // room for a turn
      return clearance(Path{.start = p, .segments = {}}, hazards) > 2.0 * kRadius_m;
    };
    const Pose2 from = pose();
    const Pose2 to = pose();
    if (!away(from) || !away(to)) continue;
    ++asked;
    const auto path = shortest_clear_path({}, from, to, kRadius_m, hazards);
    if (!path) continue;
    ++found;
    expect_flies(*path, from, to, hazards);
    const double least_m = shortest_dubins_length(from, to, kRadius_m);
    EXPECT_GE(path->length_m(), least_m - 1e-6);
    direct += path->length_m() < least_m + 1e-6 ? 1 : 0;
  }
  EXPECT_GT(asked, 30);
  EXPECT_EQ(found, asked);
  EXPECT_LT(direct, found);
}

}  // namespace
}  // namespace skein::planning
