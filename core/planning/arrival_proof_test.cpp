// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "skein/base/angles.hpp"
#include "skein/base/random.hpp"
#include "skein/planning/arrival.hpp"
#include "skein/planning/dubins.hpp"

namespace skein::planning {
namespace {

constexpr double kRadius_m = 165.0;

/// What the equations of motion x' = cos h, y' = sin h, h' = curvature make of a path, by the
/// classic Runge-Kutta method; nothing is taken from the path but curvatures and lengths.
struct Flown {
  double x_m = 0.0;
  double y_m = 0.0;
  double heading_rad = 0.0;
  double length_m = 0.0;
  double curvature_per_m = 0.0;  ///< the largest
  double clearance_m = INFINITY;
};

Flown integrate(const Path& path, std::span<const Hazard> hazards) {
  constexpr double kStep_m = 3.0;
  Flown f{.x_m = path.start.x_m, .y_m = path.start.y_m, .heading_rad = path.start.heading_rad};
  const auto look = [&] {
    for (const Hazard& h : hazards) {
      const double d = std::hypot(f.x_m - h.centre.x(), f.y_m - h.centre.y()) - h.radius_m;
      f.clearance_m = std::min(f.clearance_m, d);
    }
  };
  look();
  for (const Segment& piece : path.segments) {
    EXPECT_GE(piece.length_m, 0.0);
    const double k = piece.curvature_per_m;
    f.curvature_per_m = std::max(f.curvature_per_m, std::abs(k));
    f.length_m += piece.length_m;
    const int steps = static_cast<int>(std::ceil(piece.length_m / kStep_m));
    const double ds = steps > 0 ? piece.length_m / steps : 0.0;
    for (int i = 0; i < steps; ++i) {
      // The heading grows evenly, so the two middle slopes are one.
      const double half = f.heading_rad + k * ds / 2.0;
      const double end = f.heading_rad + k * ds;
      f.x_m += ds / 6.0 * (std::cos(f.heading_rad) + 4.0 * std::cos(half) + std::cos(end));
      f.y_m += ds / 6.0 * (std::sin(f.heading_rad) + 4.0 * std::sin(half) + std::sin(end));
      f.heading_rad = end;
      look();
    }
  }
  return f;
}

/// An accepted answer, flown.
void expect_true(const Path& path, const Transit& transit, double wanted_m) {
  const Flown f = integrate(path, transit.hazards);
  EXPECT_EQ(path.start.x_m, transit.from.x_m);
  EXPECT_EQ(path.start.y_m, transit.from.y_m);
  EXPECT_EQ(path.start.heading_rad, transit.from.heading_rad);
  EXPECT_NEAR(f.x_m, transit.to.x_m, 1e-5);
  EXPECT_NEAR(f.y_m, transit.to.y_m, 1e-5);
  EXPECT_NEAR(wrap_pi(f.heading_rad - transit.to.heading_rad), 0.0, 1e-7);
  EXPECT_NEAR(f.length_m, wanted_m, 1e-6);
  EXPECT_LE(f.curvature_per_m, (1.0 + 1e-12) / transit.radius_m);
  EXPECT_LE(f.length_m, transit.length_max_m + 1e-6);
  EXPECT_GE(f.clearance_m, -1e-5);
}

Pose2 random_pose(Random& random, double size_m) {
  const double x_m = random.uniform(-size_m, size_m);
  const double y_m = random.uniform(-size_m, size_m);
  return {x_m, y_m, random.uniform(-kPi, kPi)};
}

/// Lengths of paths without hazards that nobody looked for: some pieces at random, then a word,
/// tight or wide. None of them may lie between a refused length and the next longer one.
bool any_between(Random& random, const Transit& transit, double low_m, double high_m, int tries) {
  for (int i = 0; i < tries; ++i) {
    Pose2 at = transit.from;
    double flown_m = 0.0;
    const auto pieces = random.index(3);
    for (std::uint64_t p = 0; p < pieces; ++p) {
      constexpr std::array<double, 5> kParts = {0.0, 1.0, -1.0, 0.5, -0.5};
      const double part = kParts[random.index(kParts.size())];
      const double piece_m = random.uniform() * random.uniform() * high_m;
      at = advance(at, part / transit.radius_m, piece_m);
      flown_m += piece_m;
    }
    const double radius_m =
        transit.radius_m * (random.chance(0.5) ? 1.0 : random.uniform(1.0, 3.0));
    const auto between = [&](const std::optional<DubinsPath>& word) {
      if (!word) return false;
      const double length_m = flown_m + word->length_m();
      return length_m > low_m && length_m < high_m;
    };
    for (const DubinsWord word :
         {DubinsWord::LSL, DubinsWord::LSR, DubinsWord::RSL, DubinsWord::RSR}) {
      if (between(dubins_word(word, at, transit.to, radius_m, radius_m))) return true;
    }
    for (const DubinsWord word : {DubinsWord::LRL, DubinsWord::RLR}) {
      for (const bool major : {false, true}) {
        if (between(dubins_ccc(word, at, transit.to, radius_m, major))) return true;
      }
    }
  }
  return false;
}

struct Count {
  int accepted = 0;
  int below = 0;
  int beyond = 0;  ///< the range
  int gaps = 0;
  int barred = 0;
};

Count prove(std::uint64_t seed, int requests, int tries) {
  Random random{seed};
  Count count;
  for (int i = 0; i < requests; ++i) {
    const double size_m = std::array{150.0, 400.0, 1000.0, 4000.0}[random.index(4)];
    const Pose2 from = random_pose(random, size_m);
    const Pose2 to = random_pose(random, size_m);
    std::vector<Hazard> hazards;
    const auto wanted_hazards = random.chance(0.5) ? random.index(4) : 0;
    while (hazards.size() < wanted_hazards) {
      const Vec2 centre = random_pose(random, size_m + 300.0).position();
      const double radius_m = random.uniform(20.0, 400.0);
      if ((centre - from.position()).norm() < radius_m) continue;
      hazards.push_back({HazardId{static_cast<std::uint16_t>(hazards.size())}, centre, radius_m});
    }
    const double shortest_m = shortest_dubins_length(from, to, kRadius_m);
    const double range_m = shortest_m + random.uniform(0.0, 20000.0);
    const Transit transit{from, to, kRadius_m, range_m, hazards};
    const double loop_m = kTwoPi * kRadius_m;
    const double wanted_m = i % 16 == 0  ? shortest_m
                            : i % 2 == 0 ? shortest_m + random.uniform(0.0, 1.2 * loop_m)
                                         : shortest_m * random.uniform(0.5, 4.0);
    const auto path = path_of_length({}, transit, wanted_m);
    if (path) {
      ++count.accepted;
      expect_true(*path, transit, wanted_m);
      const auto least = least_length_from({}, transit, wanted_m);
      EXPECT_TRUE(least.ok() && std::abs(*least - wanted_m) < 1e-6);
    } else if (wanted_m < shortest_m) {
      ++count.below;
    } else if (wanted_m > range_m) {
      ++count.beyond;
    } else if (!hazards.empty()) {
      ++count.barred;
    } else {
      ++count.gaps;
      const auto next = least_length_from({}, transit, wanted_m);
      const double next_m = next ? *next : range_m;
      EXPECT_GT(next_m, wanted_m);
      if (next) {
        const auto there = path_of_length({}, transit, *next);
        EXPECT_TRUE(there.ok());
        if (there) expect_true(*there, transit, *next);
      }
      if (any_between(random, transit, wanted_m + 0.01, next_m - 0.01, tries)) {
        ADD_FAILURE() << "between " << wanted_m << " and " << next_m << " m";
      }
    }
    if (testing::Test::HasFailure()) {
      ADD_FAILURE() << "request " << i;
      break;
    }
  }
  return count;
}

TEST(ArrivalProof, WhatIsAcceptedIsFlownAndWhatIsRefusedIsNot) {
  const Count count = prove(61, 2000, 300);
  EXPECT_GT(count.accepted, 1200);
}

TEST(ArrivalProof, DISABLED_ManyRequests) {
  const Count count = prove(62, 100'000, 2000);
  std::printf("accepted %d, below the shortest %d, beyond the range %d, gaps %d, barred %d\n",
              count.accepted, count.below, count.beyond, count.gaps, count.barred);
  EXPECT_GT(count.accepted, 60'000);
}

}  // namespace
}  // namespace skein::planning
