// SPDX-License-Identifier: Apache-2.0
#include "skein/formation/change_planner.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "skein/base/angles.hpp"
#include "skein/base/random.hpp"

namespace skein::formation {
namespace {

constexpr MotionLimits kLimits{.speed_mps = 3.0, .acceleration_mps2 = 2.0, .jerk_mps3 = 4.0};

/// Least distance, by looking so often that nothing can happen in between: never above the truth.
double least_by_sampling(const Change& change) {
  const ChangeMotion motion{change};
  const double end = to_seconds(motion.duration());
  const double factor = height_factor(change.separation);
  constexpr double kStep_s = 0.02;
  double least = std::numeric_limits<double>::infinity();
  std::vector<Vec3> before;
  const auto steps = static_cast<int>(std::ceil(end / kStep_s));
  for (int step = 0; step <= steps; ++step) {
    const double t = step * kStep_s;
    std::vector<Vec3> at;
    for (std::size_t i = 0; i < motion.movers(); ++i) {
      at.push_back(motion.position(i, from_seconds(t)));
      at.back().z() *= factor;
    }
    for (std::size_t i = 0; i < at.size() && !before.empty(); ++i) {
      for (std::size_t j = i + 1; j < at.size(); ++j) {
        // The chord between two moments.
        const Vec3 begin = before[i] - before[j];
        const Vec3 way = at[i] - at[j] - begin;
        const double squared = way.squaredNorm();
        const double share = squared > 0 ? std::clamp(-begin.dot(way) / squared, 0.0, 1.0) : 0.0;
        least = std::min(least, (begin + share * way).norm());
      }
    }
    before = at;
  }
  return least;
}

std::vector<Vec3> spread(std::size_t n, double apart_m, double width_m, Random& random) {
  std::vector<Vec3> points;
  while (points.size() < n) {
    const Vec3 p{random.uniform(0.0, width_m), random.uniform(0.0, width_m),
                 random.uniform(10.0, 20.0)};
    if (std::all_of(points.begin(), points.end(), [&](const Vec3& other) {
          return Vec2{p.x() - other.x(), p.y() - other.y()}.norm() >= apart_m;
        })) {
      points.push_back(p);
    }
  }
  return points;
}

TEST(PlanChange, WhatItSaysOfSeparationIsTrue) {
  Random random{7};
  std::array<int, 3> ways{};
  for (int i = 0; i < 150; ++i) {
    const std::size_t n = 2 + random.index(19);
    const double width = 12.0 * std::sqrt(static_cast<double>(n));
    ChangeRequest request;
    request.limits = kLimits;
    request.separation = {3.0, random.uniform(2.0, 6.0)};
    request.reserve_m = 1.0;
    request.ceiling_m = 1000.0;
    const auto from = spread(n, 4.1, width, random);
    const auto to = spread(n, 4.1, width, random);  // anybody anywhere: most paths meet
    for (std::size_t k = 0; k < n; ++k) {
      request.transfers.push_back({{static_cast<std::uint16_t>(k + 1)}, from[k], to[k]});
    }
    const auto planned = plan_change(request);
    ASSERT_TRUE(planned.ok()) << planned.error().message;
    ++ways.at(static_cast<std::size_t>(planned->way));
    EXPECT_GE(planned->least_separation_m, 4.0);
    const double sampled = least_by_sampling(planned->change);
    EXPECT_LE(planned->least_separation_m, sampled + 1e-3);
    EXPECT_NEAR(planned->least_separation_m, sampled, 0.02);
    const ChangeMotion motion{planned->change};
    for (std::size_t k = 0; k < n; ++k) {
      EXPECT_LT((motion.position(k, Duration{}) - from[k]).norm(), 1e-9);
      EXPECT_LT((motion.position(k, motion.duration()) - to[k]).norm(), 1e-6);
    }
  }
  for (const int count : ways) EXPECT_GT(count, 0);
}

/// All to the opposite side of a circle.
ChangeRequest swap(std::size_t n, double radius_m, double height_m) {
  Random random{3};
  ChangeRequest request;
  request.limits = kLimits;
  for (std::size_t i = 0; i < n; ++i) {
    const double turn = 2.0 * kPi * static_cast<double>(i) / static_cast<double>(n);
    const double aside_m = random.uniform(-0.1, 0.1);
    const Vec2 at = radius_m * unit_vector(turn + aside_m / radius_m);
    request.transfers.push_back({{static_cast<std::uint16_t>(i + 1)},
                                 {at.x(), at.y(), 20.0},
                                 {-at.x(), -at.y(), height_m}});
  }
  return request;
}

int levels_of(const Change& change) {
  int levels = 0;
  for (const Mover& mover : change.movers) levels = std::max<int>(levels, mover.level);
  return levels;
}

TEST(PlanChange, PointsAreDerivativesOfEachOther) {
  for (const std::size_t n : {6U, 32U}) {
    const ChangeRequest request = swap(n, n == 6 ? 20.0 : 40.0, 25.0);
    const auto planned = plan_change(request);
    ASSERT_TRUE(planned.ok());
    ASSERT_EQ(planned->way, Way::roundabout);
    EXPECT_EQ(levels_of(planned->change), n == 6 ? 1 : 2);
    const ChangeMotion motion{planned->change};
    constexpr double kH = 1e-4;
    constexpr double kStep_s = 0.0503;
    for (int step = 1; step * kStep_s < to_seconds(motion.duration()); ++step) {
      const double t = step * kStep_s;
      for (std::size_t i = 0; i < 6; ++i) {
        const auto before = motion.at(i, from_seconds(t - kH));
        const auto now = motion.at(i, from_seconds(t));
        const auto after = motion.at(i, from_seconds(t + kH));
        EXPECT_LT(((after.position_m - before.position_m) / (2 * kH) - now.velocity_mps).norm(),
                  1e-3);
        EXPECT_LT(((after.velocity_mps - before.velocity_mps) / (2 * kH)).norm(),
                  2.0 * std::sqrt(2.0));
        EXPECT_LT(now.velocity_mps.norm(), 3.0 * 1.001);
        EXPECT_LT(now.acceleration_mps2.norm(), 2.0 * std::sqrt(2.0));
        EXPECT_LT(now.velocity_mps.norm(), motion.speed_max_mps(i) + 1e-9);
        EXPECT_NEAR(now.acceleration_mps2.z(),
                    (after.velocity_mps.z() - before.velocity_mps.z()) / (2 * kH), 0.05);
      }
    }
  }
}

TEST(PlanChange, ManyTurnOnTwoLevelsWhereThatSparesMuch) {
  ChangeRequest request = swap(32, 40.0, 20.0);
  const double ideal_s = MotionProfile{80.0, kLimits}.duration_s();
  const auto planned = plan_change(request);
  ASSERT_TRUE(planned.ok());
  ASSERT_EQ(planned->way, Way::roundabout);
  EXPECT_EQ(levels_of(planned->change), 2);
  EXPECT_LT(to_seconds(planned->duration), 1.05 * ideal_s);
  EXPECT_GE(planned->least_separation_m, 4.0);
  const double sampled = least_by_sampling(planned->change);
  EXPECT_LE(planned->least_separation_m, sampled + 1e-3);
  EXPECT_NEAR(planned->least_separation_m, sampled, 0.02);

  request.ceiling_m = 23.9;  // a level would be 4 m higher
  const auto below = plan_change(request);
  ASSERT_TRUE(below.ok());
  EXPECT_EQ(below->way, Way::roundabout);
  EXPECT_EQ(levels_of(below->change), 1);
  EXPECT_GT(to_seconds(below->duration), 1.1 * ideal_s);

  // Stretched heights: a level is as high as vehicles are to be apart there.
  request.ceiling_m = 120.0;
  request.separation.vertical_m = 4.5;
  const auto higher = plan_change(request);
  ASSERT_TRUE(higher.ok());
  EXPECT_EQ(levels_of(higher->change), 2);
  EXPECT_NEAR(higher->change.roundabout->level_m, 6.0, 1e-9);
  EXPECT_NEAR(higher->least_separation_m, least_by_sampling(higher->change), 0.02);
}

TEST(PlanChange, NoLevelIsReachedMoreSteeplyThanAtOneToOne) {
  Change change = plan_change(swap(32, 40.0, 20.0)).value().change;
  ASSERT_TRUE(valid(change));
  const Roundabout good = *change.roundabout;
  change.roundabout->climb_m = 0.9 * good.level_m;
  EXPECT_FALSE(valid(change));
  change.roundabout = good;
  change.roundabout->level_m = 50.0;  // the rim is 39 m from the starts
  change.roundabout->climb_m = 100.0;
  EXPECT_FALSE(valid(change));
  change.roundabout = good;
  change.roundabout->level_m = change.roundabout->climb_m = 1e-12;  // it would take for ever
  EXPECT_FALSE(valid(change));
  change.roundabout = good;
  change.roundabout->level_m = -1.0;
  EXPECT_FALSE(valid(change));
}

TEST(PlanChange, RefusesWithTheTwoThatAreTooNear) {
  ChangeRequest request;
  request.limits = kLimits;
  request.transfers = {{{3}, {0, 0, 10}, {0, 10, 10}}, {{8}, {1, 0, 10}, {20, 10, 10}}};
  const auto planned = plan_change(request);
  ASSERT_FALSE(planned.ok());
  EXPECT_NE(planned.error().message.find("vehicle 3 and vehicle 8 would come within 1.00 m"),
            std::string::npos)
      << planned.error().message;
}

TEST(PlanChange, SaysWhatIsWrongWithARequest) {
  ChangeRequest request;
  request.limits = {.speed_mps = 8.0, .acceleration_mps2 = 1.0, .jerk_mps3 = 2.0};
  request.transfers = {{{3}, {0, 0, 10}, {0, 10, 10}}, {{3}, {9, 0, 10}, {9, 10, 10}}};
  EXPECT_EQ(plan_change(request).error().message,
            "8.00 m/s cannot be braked in time by 1.00 m/s2; fly at 6.00 m/s at most");
  request.limits = kLimits;
  EXPECT_EQ(plan_change(request).error().message, "vehicle 3 is named twice");
  request.limits.jerk_mps3 = 0.0;
  EXPECT_EQ(plan_change(request).error().message,
            "speed, acceleration, jerk and separation are to be numbers above 0");
}

TEST(PlanChange, MovesAsManyAsAChangeCanTellAndSaysWhereThereAreMore) {
  ChangeRequest request;
  request.limits = kLimits;
  for (std::uint16_t i = 0; i < kMoversMax; ++i) {
    const int row = i / 32;
    const Vec3 from{10.0 * (i % 32), 10.0 * row, 10.0};
    request.transfers.push_back({{static_cast<std::uint16_t>(i + 1)}, from, from + Vec3{0, 50, 0}});
  }
  const auto planned = plan_change(request);
  ASSERT_TRUE(planned.ok()) << planned.error().message;
  EXPECT_EQ(planned->change.movers.size(), kMoversMax);
  EXPECT_NEAR(planned->least_separation_m, 10.0, 1e-6);
  request.transfers.push_back({{2000}, {-50, 0, 10}, {-50, 50, 10}});
  const auto more = plan_change(request);
  ASSERT_FALSE(more.ok());
  EXPECT_EQ(more.error().message,
            "1025 vehicles are to move, and 1024 are the most that a change can tell; fly them as "
            "several teams");
}

TEST(PlanChange, RefusesWhatWouldTakeTooMuchHeight) {
  // Nobody can turn: the starts lie in each other's way within any disc.
  ChangeRequest request;
  request.limits = kLimits;
  request.ceiling_m = 15.0;
  request.transfers = {{{1}, {0, 0, 14}, {4.5, 0, 14}}, {{2}, {4.5, 0, 14}, {0, 0, 14}}};
  const auto low = plan_change(request);
  request.ceiling_m = 30.0;
  const auto high = plan_change(request);
  ASSERT_TRUE(high.ok());
  if (high->way == Way::layers) {
    ASSERT_FALSE(low.ok());
    EXPECT_NE(low.error().message.find("the ceiling is 15.00 m"), std::string::npos);
  } else {
    EXPECT_TRUE(low.ok());
  }
}

TEST(PlanChange, KeepsAwayFromWhoIsSilent) {
  ChangeRequest request;
  request.limits = kLimits;
  request.transfers = {{{1}, {0, 0, 14}, {40, 0, 14}}, {{2}, {0, 10, 14}, {40, 10, 14}}};
  request.keep_outs = {{{9}, {20, -5, 14}, {20, 4, 14}}};
  const auto planned = plan_change(request);
  ASSERT_TRUE(planned.ok()) << planned.error().message;
  EXPECT_EQ(planned->way, Way::layers);
  const ChangeMotion motion{planned->change};
  constexpr double kStep_s = 0.05;
  for (int step = 0; step * kStep_s < to_seconds(motion.duration()); ++step) {
    const Vec3 at = motion.position(0, from_seconds(step * kStep_s));
    const double y = std::clamp(at.y(), -5.0, 4.0);
    EXPECT_GE((at - Vec3{20.0, y, 14.0}).norm(), 3.0 - 1e-6);
  }
}

TEST(PlanChange, LetsGoWhoIsNearSomebodySilentAlready) {
  ChangeRequest request;
  request.limits = kLimits;
  request.transfers = {{{1}, {0, 0, 14}, {40, 0, 14}}};
  request.keep_outs = {{{9}, {-1, -5, 14}, {-1, 5, 14}}};  // 1 m from where it starts
  EXPECT_TRUE(plan_change(request).ok());
  request.transfers[0].to = {-40, 0, 14};  // through it: over it, straight up first
  const auto over = plan_change(request);
  ASSERT_TRUE(over.ok()) << over.error().message;
  EXPECT_EQ(over->way, Way::layers);
}

// --- who rests too near to be led ---

bool anywhere(const Transfer& /*way*/) { return true; }

ChangeRequest request_of(const std::vector<Vec3>& places) {
  ChangeRequest request;
  request.limits = kLimits;
  request.separation = {3.0, 3.0};
  for (const Vec3& place : places) {
    const VehicleId id{static_cast<std::uint16_t>(request.transfers.size() + 1)};
    request.transfers.push_back({id, place, place + Vec3{30.0, 0.0, 0.0}});
  }
  return request;
}

TEST(MakeRoom, IsForThoseOnlyThatRestTooNear) {
  EXPECT_FALSE(make_room(request_of({{0, 0, 20}, {4, 0, 20}}), anywhere));
  const auto near = request_of({{0, 0, 20}, {3, 0, 20}});
  EXPECT_FALSE(plan_change(near).ok());
  EXPECT_TRUE(make_room(near, anywhere));
}

TEST(MakeRoom, LeadsOneOutAndNobodyNearer) {
  Random random{7};
  for (int round = 0; round < 200; ++round) {
    // A crowd in which the last rests beside the first.
    auto places = spread(6, 4.0, 16.0, random);
    const Vec2 beside = random.uniform(2.2, 3.2) * unit_vector(random.uniform(-3.0, 3.0));
    places.push_back(places.front() + Vec3{beside.x(), beside.y(), 0.0});
    ChangeRequest request = request_of(places);
    const auto near = [&] {
      return (request.transfers.front().from - request.transfers.back().from).norm() < 3.3;
    };
    for (int made = 0; near(); ++made) {
      ASSERT_LT(made, 2);
      const auto room = make_room(request, anywhere);
      ASSERT_TRUE(room) << "round " << round;
      ASSERT_TRUE(valid(room->change));
      int moved = 0;
      const ChangeMotion motion{room->change};
      for (std::size_t i = 0; i < places.size(); ++i) {
        const Mover& mover = room->change.movers[i];
        moved += mover.points.front() == mover.points.back() ? 0 : 1;
        for (std::size_t j = i + 1; j < places.size(); ++j) {
          const double before = (request.transfers[i].from - request.transfers[j].from).norm();
          EXPECT_GE(motion.least_distance_m(i, j, 1.0), std::min(4.0, before) - 6e-3);
        }
        request.transfers[i].from = mover.points.back();
      }
      EXPECT_EQ(moved, 1);
    }
  }
}

/// Between the air below one that is lost and the way that another may have flown: the only way out
/// crosses below the first, and not nearer to where that is.
TEST(MakeRoom, LeadsOutFromBelowByTheShortestWay) {
  ChangeRequest request = request_of({{0, 0.3, 15}});
  request.keep_outs.push_back({{8}, {0, 0, 17.8}, {0, 0, 17.8}});
  request.keep_outs.push_back({{8}, {0, 0, 17.8}, {0, 0, 0}});
  for (double x = -20.0; x <= 20.0; x += 0.5) {
    request.keep_outs.push_back({{9}, {x, 2, 15}, {x, 2, 15}});
    request.keep_outs.push_back({{9}, {x, 2, 15}, {x, 2, 0}});
  }
  const auto room = make_room(request, anywhere);
  ASSERT_TRUE(room);
  const Vec3 to = room->change.movers[0].points.back();
  EXPECT_GE(to.head<2>().norm(), 3.0 - 2e-3);
  EXPECT_LE(to.y(), -1.0 + 2e-3);
  const ChangeMotion motion{room->change};
  for (Duration t{}; t <= motion.duration(); t += std::chrono::milliseconds{20}) {
    EXPECT_GE(distance_m(motion.position(0, t), request.keep_outs.front(), 1.0), 0.9 * 2.81);
  }
}

TEST(MakeRoom, TakesOnlyWaysThatAreAllowed) {
  const auto near = request_of({{0, 0, 20}, {3, 0, 20}});
  EXPECT_FALSE(make_room(near, [](const Transfer& /*way*/) { return false; }));
  const auto room = make_room(
      near, [](const Transfer& way) { return way.vehicle.value == 2 && way.to.y() < -1.0; });
  ASSERT_TRUE(room);
  EXPECT_LT(room->change.movers[1].points.back().y(), -1.0);
}

TEST(MakeRoom, KeepsOutOfWhereASilentOneMayBe) {
  ChangeRequest near = request_of({{0, 0, 20}, {3, 0, 20}});
  near.ceiling_m = 20.0;
  near.keep_outs = {{{9}, {6.5, 0, 20}, {6.5, 0, 0}}, {{10}, {-3.5, 0, 20}, {-3.5, 0, 0}}};
  const auto room = make_room(near, anywhere);
  ASSERT_TRUE(room);
  const ChangeMotion motion{room->change};
  for (const KeepOut& keep_out : near.keep_outs) {
    for (Duration t{}; t <= motion.duration(); t += std::chrono::milliseconds{20}) {
      EXPECT_GE(distance_m(motion.position(0, t), keep_out, 1.0), 3.0);
      EXPECT_GE(distance_m(motion.position(1, t), keep_out, 1.0), 3.0);
    }
  }
}

TEST(MakeRoom, LeadsOutFromBelowASilentOne) {
  ChangeRequest below = request_of({{0, 0, 15}, {20, 0, 15}});
  below.keep_outs = {{{9}, {1.5, 0, 20}, {1.5, 0, 0}}};
  const auto room = make_room(below, anywhere);
  ASSERT_TRUE(room);
  const Vec3& end = room->change.movers[0].points.back();
  EXPECT_GE(distance_m(end, below.keep_outs[0], 1.0), 3.0);
  EXPECT_LT(end.x(), 0.0) << "straight away from it";
}

}  // namespace
}  // namespace skein::formation
