// SPDX-License-Identifier: Apache-2.0
#include "skein/tours/tour.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "skein/base/angles.hpp"
#include "skein/planning/dubins.hpp"

namespace skein::planning {
namespace {

constexpr double kRadius_m = 40.0;

/// Its length by its poses; fails where it is no tour of the problem.
double judged_m(const TourProblem& problem, const Tour& tour) {
  std::vector<std::size_t> seen;
  double length_m = 0.0;
  const std::size_t n = tour.visits.size();
  for (std::size_t i = 0; i < n; ++i) {
    const TourVisit& visit = tour.visits[i];
    seen.push_back(visit.stop);
    const TourStop& stop = problem.stops.at(visit.stop);
    EXPECT_LE((visit.at.position() - stop.centre).norm(), stop.radius_m + 1e-9);
    if (problem.start && i + 1 == n) break;
    length_m +=
        shortest_dubins_length(visit.at, tour.visits[(i + 1) % n].at, problem.turn_radius_m);
  }
  if (problem.start && n > 0) {
    length_m +=
        shortest_dubins_length(*problem.start, tour.visits.front().at, problem.turn_radius_m);
  }
  std::ranges::sort(seen);
  for (std::size_t i = 0; i < problem.stops.size(); ++i) EXPECT_EQ(seen.at(i), i);
  EXPECT_NEAR(length_m, tour.length_m, 1e-6);
  return length_m;
}

TourProblem draw(Random& random, std::size_t stops, double side_m) {
  TourProblem problem;
  problem.turn_radius_m = kRadius_m;
  for (std::size_t i = 0; i < stops; ++i) {
    problem.stops.push_back(
        {{random.uniform(0.0, side_m), random.uniform(0.0, side_m)}, random.uniform(0.0, 60.0)});
  }
  return problem;
}

Tour plan(const TourProblem& problem, std::uint64_t steps, std::uint64_t seed = 1) {
  Random random{seed};
  const auto tour = plan_tour(problem, random, {steps, {}});
  EXPECT_TRUE(tour.ok());
  return *tour;
}

TEST(Tour, MeetsEveryStopOnceAndItsLengthIsThatOfItsPoses) {
  Random random{5};
  for (const std::size_t stops : {1U, 2U, 3U, 7U, 20U}) {
    for (int i = 0; i < 5; ++i) {
      TourProblem problem = draw(random, stops, 800.0);
      judged_m(problem, plan(problem, 200));
      problem.start = Pose2{random.uniform(-500.0, 0.0), 0.0, random.uniform(-kPi, kPi)};
      judged_m(problem, plan(problem, 200));
    }
  }
}

TEST(Tour, WhatLiesOnALineIsFlownStraight) {
  TourProblem problem;
  problem.turn_radius_m = kRadius_m;
  problem.start = Pose2{0.0, 0.0, 0.0};
  for (const double x : {900.0, 300.0, 600.0, 1200.0}) problem.stops.push_back({{x, 0.0}, 50.0});
  const Tour tour = plan(problem, 300);
  EXPECT_NEAR(judged_m(problem, tour), 1150.0, 1e-3) << "to the edge of the last";
}

TEST(Tour, CirclesOnACircleAreFlownAlongIt) {
  TourProblem problem;
  problem.turn_radius_m = kRadius_m;
  constexpr double kRing_m = 500.0;
  for (int i = 0; i < 12; ++i) {
    problem.stops.push_back({kRing_m * unit_vector(kTwoPi * i / 12.0), 0.0});
  }
  const double ring_m = kTwoPi * kRing_m;
  const double length_m = judged_m(problem, plan(problem, 2000));
  EXPECT_LT(length_m, ring_m);
  EXPECT_GT(length_m, 24.0 * kRing_m * std::sin(kPi / 12.0)) << "the polygon";
}

/// Of points, in every order, with every heading of a grid.
double best_of_grid_m(const TourProblem& problem, int headings) {
  const std::size_t n = problem.stops.size();
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  double best_m = std::numeric_limits<double>::infinity();
  const auto pose = [&](std::size_t stop, int heading) {
    const Vec2& at = problem.stops[stop].centre;
    return Pose2{at.x(), at.y(), kTwoPi * heading / headings};
  };
  do {
    for (int first = 0; first < headings; ++first) {
      std::vector<double> reach_m(static_cast<std::size_t>(headings),
                                  std::numeric_limits<double>::infinity());
      reach_m[static_cast<std::size_t>(first)] = 0.0;
      for (std::size_t i = 1; i <= n; ++i) {
        std::vector<double> next_m(reach_m.size(), std::numeric_limits<double>::infinity());
        for (int from = 0; from < headings; ++from) {
          const double so_far = reach_m[static_cast<std::size_t>(from)];
          if (so_far >= best_m) continue;
          for (int to = 0; to < headings; ++to) {
            if (i == n && to != first) continue;
            double& there = next_m[static_cast<std::size_t>(to)];
            there = std::min(there, so_far + shortest_dubins_length(pose(order[i - 1], from),
                                                                    pose(order[i % n], to),
                                                                    problem.turn_radius_m));
          }
        }
        reach_m = std::move(next_m);
      }
      best_m = std::min(best_m, reach_m[static_cast<std::size_t>(first)]);
    }
  } while (std::next_permutation(order.begin() + 1, order.end()));
  return best_m;
}

TEST(Tour, IsNoLongerThanTheBestOfAGridInEveryOrder) {
  Random random{8};
  for (int i = 0; i < 6; ++i) {
    TourProblem problem = draw(random, 5, 400.0);
    for (TourStop& stop : problem.stops) stop.radius_m = 0.0;
    EXPECT_LE(judged_m(problem, plan(problem, 2000)), best_of_grid_m(problem, 12) + 1e-6)
        << "problem " << i;
  }
}

TEST(Tour, MoreStepsNeverGiveALongerOneAndTheSameSeedTheSame) {
  Random random{3};
  const TourProblem problem = draw(random, 15, 600.0);
  double before_m = std::numeric_limits<double>::infinity();
  for (const std::uint64_t steps : {0U, 50U, 600U, 1200U}) {
    const Tour tour = plan(problem, steps);
    EXPECT_LE(tour.length_m, before_m + 1e-9);
    EXPECT_EQ(tour.length_m, plan(problem, steps).length_m);
    before_m = tour.length_m;
  }
  const Tour ended = [&] {
    Random again{1};
    return *plan_tour(problem, again, {1'000'000, [] { return true; }});
  }();
  EXPECT_EQ(ended.steps, 0U);
}

TEST(Tour, RefusesWhatIsNoProblem) {
  Random random{1};
  const PlanningBudget budget{10, {}};
  EXPECT_FALSE(plan_tour({}, random, budget).ok());
  EXPECT_FALSE(plan_tour({{{{0.0, 0.0}, 1.0}}, 0.0, {}}, random, budget).ok());
  EXPECT_FALSE(plan_tour({{{{0.0, 0.0}, -1.0}}, 1.0, {}}, random, budget).ok());
  EXPECT_FALSE(plan_tour({{{{std::nan(""), 0.0}, 1.0}}, 1.0, {}}, random, budget).ok());
  TourProblem many;
  many.turn_radius_m = 1.0;
  many.stops.resize(kTourStopsMax + 1);
  EXPECT_FALSE(plan_tour(many, random, budget).ok());
}

}  // namespace
}  // namespace skein::planning
