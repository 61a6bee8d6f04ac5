// SPDX-License-Identifier: Apache-2.0
#include "skein/planning/dubins.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "skein/base/angles.hpp"
#include "skein/base/random.hpp"

namespace skein::planning {
namespace {

constexpr std::array<DubinsWord, 6> kWords = {DubinsWord::LSL, DubinsWord::LSR, DubinsWord::RSL,
                                              DubinsWord::RSR, DubinsWord::RLR, DubinsWord::LRL};

Pose2 random_pose(Random& random, double size_m) {
  return {random.uniform(-size_m, size_m), random.uniform(-size_m, size_m),
          random.uniform(-kPi, kPi)};
}

void expect_reaches(const Path& path, const Pose2& goal) {
  const Pose2 end = path.end();
  EXPECT_NEAR(end.x_m, goal.x_m, 1e-9);
  EXPECT_NEAR(end.y_m, goal.y_m, 1e-9);
  EXPECT_NEAR(wrap_pi(end.heading_rad - goal.heading_rad), 0.0, 1e-10);
}

/// Shkel and Lumelsky (2001), normalised: an independent formulation with the classic middle arc.
double reference_length(const Pose2& from, const Pose2& to, double r) {
  const double dx = to.x_m - from.x_m;
  const double dy = to.y_m - from.y_m;
  const double d = std::hypot(dx, dy) / r;
  const double theta = std::atan2(dy, dx);
  const double a = wrap_two_pi(from.heading_rad - theta);
  const double b = wrap_two_pi(to.heading_rad - theta);
  const double sa = std::sin(a);
  const double sb = std::sin(b);
  const double ca = std::cos(a);
  const double cb = std::cos(b);
  const double cab = std::cos(a - b);
  double best = INFINITY;
  const auto take = [&](double t, double p, double q) {
    best = std::min(best, wrap_two_pi(t) + p + wrap_two_pi(q));
  };
  if (const double p2 = 2 + d * d - 2 * cab + 2 * d * (sa - sb); p2 >= 0) {
    const double t = std::atan2(cb - ca, d + sa - sb);
    take(-a + t, std::sqrt(p2), b - t);
  }
  if (const double p2 = 2 + d * d - 2 * cab + 2 * d * (sb - sa); p2 >= 0) {
    const double t = std::atan2(ca - cb, d - sa + sb);
    take(a - t, std::sqrt(p2), -b + t);
  }
  if (const double p2 = -2 + d * d + 2 * cab + 2 * d * (sa + sb); p2 >= 0) {
    const double p = std::sqrt(p2);
    const double t = std::atan2(-ca - cb, d + sa + sb) - std::atan2(-2.0, p);
    take(-a + t, p, -b + t);
  }
  if (const double p2 = -2 + d * d + 2 * cab - 2 * d * (sa + sb); p2 >= 0) {
    const double p = std::sqrt(p2);
    const double t = std::atan2(ca + cb, d - sa - sb) - std::atan2(2.0, p);
    take(a - t, p, b - t);
  }
  if (const double c = (6 - d * d + 2 * cab + 2 * d * (sa - sb)) / 8; std::abs(c) <= 1) {
    const double p = kTwoPi - std::acos(c);
    const double t = a - std::atan2(ca - cb, d - sa + sb) + p / 2;
    take(t, p, a - b - t + p);
  }
  if (const double c = (6 - d * d + 2 * cab + 2 * d * (sb - sa)) / 8; std::abs(c) <= 1) {
    const double p = kTwoPi - std::acos(c);
    const double t = -a + std::atan2(-ca + cb, d + sa - sb) + p / 2;
    take(t, p, b - a - t + p);
  }
  return best * r;
}

TEST(Dubins, EveryWordReachesItsGoal) {
  Random random{1};
  std::array<int, 6> found{};
  for (int i = 0; i < 20000; ++i) {
    const double size_m = i % 2 == 0 ? 300.0 : 3000.0;
    const Pose2 from = random_pose(random, size_m);
    const Pose2 to = random_pose(random, size_m);
    const double r = random.uniform(50.0, 250.0);
    const DubinsPath best = shortest_dubins(from, to, r);
    expect_reaches(best.to_path(), to);
    for (std::size_t w = 0; w < kWords.size(); ++w) {
      const auto path = dubins_word(kWords[w], from, to, r, r);
      if (!path) continue;
      ++found[w];
      for (const double length : path->lengths_m) EXPECT_GE(length, 0.0);
      expect_reaches(path->to_path(), to);
      EXPECT_LE(best.length_m(), path->length_m());
    }
    if (HasFailure()) FAIL() << "query " << i;
  }
  for (const int count : found) EXPECT_GT(count, 1000);
}

TEST(Dubins, BothPathsOfACccWordReachTheGoal) {
  Random random{2};
  for (int i = 0; i < 5000; ++i) {
    const Pose2 from = random_pose(random, 150.0);
    const Pose2 to = random_pose(random, 150.0);
    for (const DubinsWord word : {DubinsWord::RLR, DubinsWord::LRL}) {
      for (const bool major : {false, true}) {
        const auto path = dubins_ccc(word, from, to, 100.0, major);
        if (!path) continue;
        expect_reaches(path->to_path(), to);
        EXPECT_EQ(path->lengths_m[1] > kPi * 100.0, major);
      }
    }
  }
}

TEST(Dubins, AgreesWithTheClassicFormulation) {
  Random random{3};
  for (int i = 0; i < 50000; ++i) {
    const Pose2 from = random_pose(random, i % 2 == 0 ? 200.0 : 2000.0);
    const Pose2 to = random_pose(random, i % 2 == 0 ? 200.0 : 2000.0);
    EXPECT_NEAR(shortest_dubins_length(from, to, 100.0), reference_length(from, to, 100.0), 1e-7);
  }
}

TEST(Dubins, BackwardsIsAsLong) {
  Random random{4};
  for (int i = 0; i < 5000; ++i) {
    const Pose2 from = random_pose(random, 500.0);
    const Pose2 to = random_pose(random, 500.0);
    const Pose2 back_from{to.x_m, to.y_m, wrap_pi(to.heading_rad + kPi)};
    const Pose2 back_to{from.x_m, from.y_m, wrap_pi(from.heading_rad + kPi)};
    EXPECT_NEAR(shortest_dubins_length(from, to, 120.0),
                shortest_dubins_length(back_from, back_to, 120.0), 1e-8);
  }
}

TEST(Dubins, UnequalRadii) {
  Random random{5};
  int found = 0;
  for (int i = 0; i < 5000; ++i) {
    const Pose2 from = random_pose(random, 1000.0);
    const Pose2 to = random_pose(random, 1000.0);
    const double r1 = random.uniform(50.0, 200.0);
    const double r2 = random.uniform(50.0, 200.0);
    const auto best = shortest_dubins(from, to, r1, r2);
    for (const DubinsWord word : kWords) {
      const auto path = dubins_word(word, from, to, r1, r2);
      if (word == DubinsWord::RLR || word == DubinsWord::LRL) {
        EXPECT_FALSE(path.has_value());
        continue;
      }
      if (!path) continue;
      ++found;
      expect_reaches(path->to_path(), to);
      EXPECT_LE(best->length_m(), path->length_m());
    }
  }
  EXPECT_GT(found, 15000);
}

TEST(Dubins, DegenerateInputs) {
  Random random{6};
  for (int i = 0; i < 2000; ++i) {
    const Pose2 from = random_pose(random, 10000.0);
    const double r = 165.0;
    EXPECT_NEAR(shortest_dubins_length(from, from, r), 0.0, 1e-9);
    const Pose2 turned{from.x_m, from.y_m, from.heading_rad + kTwoPi};
    EXPECT_NEAR(shortest_dubins_length(from, turned, r), 0.0, 1e-9);
    for (const double d : {1e-6, 1e-3, 1.0, 4.0 * r, 5000.0}) {
      EXPECT_NEAR(shortest_dubins_length(from, advance(from, 0.0, d), r), d, 1e-5) << d;
    }
    for (const double d : {1e-3, 1.0, r * kPi / 2.0, r * kPi}) {
      for (const double sense : {1.0, -1.0}) {
        EXPECT_NEAR(shortest_dubins_length(from, advance(from, sense / r, d), r), d, 1e-5) << d;
      }
    }
    // An S of two arcs: the line between them has no length.
    const Pose2 s = advance(advance(from, 1.0 / r, r), -1.0 / r, r);
    EXPECT_NEAR(shortest_dubins_length(from, s, r), 2.0 * r, 1e-4);
    // Centres just within and beyond 4 r.
    for (const double d : {-1e-9, 0.0, 1e-9}) {
      const Pose2 opposite{from.x_m, from.y_m, from.heading_rad};
      const Pose2 beside = advance(opposite, 0.0, 4.0 * r + d);
      expect_reaches(shortest_dubins(from, beside, r).to_path(), beside);
      for (const DubinsWord word : {DubinsWord::RLR, DubinsWord::LRL}) {
        if (const auto path = dubins_word(word, from, beside, r, r)) {
          EXPECT_NEAR((path->to_path().end().position() - beside.position()).norm(), 0.0, 1e-8);
        }
      }
    }
  }
}

/// A path of an arc, a line and an arc, whose end is off by what rounding may do.
TEST(Dubins, RoundingFliesNoLoops) {
  Random random{8};
  for (int i = 0; i < 100'000; ++i) {
    const double r = std::pow(10.0, random.uniform(-0.5, 3.5));
    const Pose2 from = random_pose(random, 20.0 * r);
    const auto length = [&](double most) {
      return random.chance(0.3) ? 0.0 : r * most * std::pow(10.0, random.uniform(-12.0, 0.0));
    };
    const double first = random.chance(0.5) ? 1.0 : -1.0;
    const double last = random.chance(0.5) ? 1.0 : -1.0;
    const std::array<double, 3> lengths{length(3.0), length(30.0), length(3.0)};
    Pose2 to = advance(advance(advance(from, first / r, lengths[0]), 0.0, lengths[1]), last / r,
                       lengths[2]);
    const double flown = lengths[0] + lengths[1] + lengths[2];
    const double off = 1e-10;
    to.x_m += r * random.uniform(-off, off);
    to.y_m += r * random.uniform(-off, off);
    to.heading_rad += random.uniform(-off, off);
    // Beside a path by e, a path bends over sqrt(e).
    EXPECT_LT(shortest_dubins_length(from, to, r), flown + 1e-4 * r) << i;
    const Path path = shortest_dubins(from, to, r).to_path();
    EXPECT_LT(path.length_m(), flown + 1e-4 * r) << i;
    EXPECT_LT((path.end().position() - to.position()).norm(), 5e-9 * r) << i;
    EXPECT_LT(std::abs(wrap_pi(path.end().heading_rad - to.heading_rad)), 5e-9) << i;
  }
}

TEST(Dubins, ToAPoint) {
  Random random{7};
  int inside = 0;
  for (int i = 0; i < 1000; ++i) {
    const Pose2 from = random_pose(random, 300.0);
    const Vec2 goal = random_pose(random, 300.0).position();
    const double r = 100.0;
    const Path path = shortest_to_point(from, goal, r);
    EXPECT_NEAR((path.end().position() - goal).norm(), 0.0, 1e-8);
    // It gets there, and no final heading gets there sooner.
    double best = INFINITY;
    for (int k = 0; k < 720; ++k) {
      best = std::min(
          best, shortest_dubins_length(from, {goal.x(), goal.y(), k * kTwoPi / 720.0 - kPi}, r));
    }
    EXPECT_LE(path.length_m(), best + 1e-9);
    const Vec2 left = left_of(unit_vector(from.heading_rad));
    for (const double side : {1.0, -1.0}) {
      inside += (goal - from.position() - side * r * left).norm() < r ? 1 : 0;
    }
  }
  EXPECT_GT(inside, 50);
}

TEST(Dubins, ToAPointAheadOrHere) {
  const Pose2 from{10.0, 20.0, 0.5};
  EXPECT_NEAR(shortest_to_point(from, from.position(), 50.0).length_m(), 0.0, 1e-9);
  EXPECT_NEAR(shortest_to_point(from, advance(from, 0.0, 300.0).position(), 50.0).length_m(), 300.0,
              1e-9);
}

}  // namespace
}  // namespace skein::planning
