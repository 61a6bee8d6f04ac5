// SPDX-License-Identifier: Apache-2.0
#include "skein/routes/optimiser.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace skein::routes {
namespace {

using Point = std::span<const double>;

double sphere(Point x) {
  double sum = 0.0;
  for (const double v : x) sum += (v - 1.0) * (v - 1.0);
  return sum;
}
double rosenbrock(Point x) {
  double sum = 0.0;
  for (std::size_t j = 0; j + 1 < x.size(); ++j) {
    sum += 100.0 * std::pow(x[j + 1] - x[j] * x[j], 2.0) + std::pow(1.0 - x[j], 2.0);
  }
  return sum;
}
double rastrigin(Point x) {
  double sum = 0.0;
  for (const double v : x) {
    sum += v * v - 10.0 * std::cos(2.0 * std::numbers::pi * v) + 10.0;
  }
  return sum;
}

SearchSpace box_of(std::size_t n, double reach) {
  return {{std::vector<double>(n, -reach), std::vector<double>(n, 0.9 * reach)}, {}};
}

constexpr std::array kMethods = {SearchMethod::grey_wolf, SearchMethod::chaotic_grey_wolf,
                                 SearchMethod::particle_swarm, SearchMethod::differential_evolution,
                                 SearchMethod::cma_es};

TEST(Optimiser, AllFindTheBottomOfASphere) {
  for (const SearchMethod method : kMethods) {
    const auto found = search(method, sphere, box_of(5, 10.0), 0, {10'000, {}}, Random{1});
    EXPECT_LT(found.value, method == SearchMethod::chaotic_grey_wolf ? 0.1 : 1e-3)
        << to_string(method);
    EXPECT_EQ(found.value, sphere(found.best));
  }
}

TEST(Optimiser, ASuccessHistoryFindsBottomsValleysAndPitsWithinItsBudget) {
  const auto run = [](const Objective& objective, std::size_t n, double reach,
                      std::uint64_t budget) {
    const SearchSpace space = box_of(n, reach);
    const auto found = success_history_evolution(objective, space, {}, {budget, {}}, Random{4});
    EXPECT_EQ(found.evaluations, budget);
    EXPECT_EQ(found.value, objective(found.best));
    for (std::size_t j = 0; j < n; ++j) {
      EXPECT_GE(found.best[j], space.box.low[j]);
      EXPECT_LE(found.best[j], space.box.high[j]);
    }
    return found.value;
  };
  EXPECT_LT(run(sphere, 5, 10.0, 10'000), 1e-9);
  EXPECT_LT(run(rosenbrock, 4, 2.0, 30'000), 1e-6);
  EXPECT_LT(run(rastrigin, 3, 5.0, 30'000), 1e-6);
  run(sphere, 5, 10.0, 3);
  run(sphere, 5, 10.0, 95);
}

TEST(Optimiser, GoodOnesFindTheEndOfRosenbrocksValleyAndTheBestOfManyPits) {
  for (const SearchMethod method : {SearchMethod::differential_evolution, SearchMethod::cma_es}) {
    EXPECT_LT(search(method, rosenbrock, box_of(4, 2.0), 0, {30'000, {}}, Random{2}).value, 1e-6)
        << to_string(method);
    EXPECT_LT(search(method, rastrigin, box_of(3, 5.0), 0, {30'000, {}}, Random{3}).value, 1e-6)
        << to_string(method);
  }
}

TEST(Optimiser, EveryEvaluationIsCountedAndWithinTheBox) {
  for (const SearchMethod method : kMethods) {
    for (const std::uint64_t budget : {1u, 2u, 7u, 30u, 61u, 1000u}) {
      const SearchSpace space = box_of(3, 1.0);
      std::uint64_t calls = 0;
      double least = 1e300;
      const Objective counted = [&](Point x) {
        ++calls;
        for (std::size_t j = 0; j < x.size(); ++j) {
          EXPECT_GE(x[j], space.box.low[j]);
          EXPECT_LE(x[j], space.box.high[j]);
        }
        const double value = rastrigin(x);
        least = std::min(least, value);
        return value;
      };
      const auto found = search(method, counted, space, 0, {budget, {}}, Random{budget});
      EXPECT_EQ(calls, budget) << to_string(method);
      EXPECT_EQ(found.evaluations, budget) << to_string(method);
      EXPECT_EQ(found.value, least) << to_string(method);
      EXPECT_EQ(rastrigin(found.best), least) << to_string(method);
    }
  }
}

TEST(Optimiser, TheSameSeedGivesTheSameResult) {
  for (const SearchMethod method : kMethods) {
    const auto run = [&](std::uint64_t seed) {
      return search(method, rastrigin, box_of(4, 5.0), 20, {2'000, {}}, Random{seed});
    };
    EXPECT_EQ(run(7).best, run(7).best) << to_string(method);
    EXPECT_NE(run(7).best, run(8).best) << to_string(method);
  }
}

TEST(Optimiser, StopsWhenToldToAndReportsProgress) {
  for (const SearchMethod method : kMethods) {
    std::vector<double> best;
    const SearchBudget budget{100'000, [&](const SearchProgress& progress) {
                                best.push_back(progress.best);
                                return best.size() < 5;
                              }};
    const auto found = search(method, rastrigin, box_of(4, 5.0), 20, budget, Random{1});
    EXPECT_TRUE(found.cancelled) << to_string(method);
    EXPECT_EQ(best.size(), 5U) << to_string(method);
    EXPECT_TRUE(std::is_sorted(best.rbegin(), best.rend()));
    EXPECT_LT(found.evaluations, 1'000U) << to_string(method);
  }
}

TEST(Optimiser, SeedsAreLookedAtFirst) {
  for (const SearchMethod method : kMethods) {
    SearchSpace space = box_of(4, 5.0);
    space.seeds = {std::vector<double>(4, 1.0)};
    EXPECT_EQ(search(method, sphere, space, 10, {1, {}}, Random{1}).value, 0.0);
  }
}

TEST(Chaos, MapsStayWithinTheirRangeAndDoNotStick) {
  for (int m = 0; m < static_cast<int>(ChaoticMap::count); ++m) {
    const auto map = static_cast<ChaoticMap>(m);
    ChaoticSequence sequence{map, Random{static_cast<std::uint64_t>(m)}};
    std::vector<double> seen;
    for (int k = 0; k < 20'000; ++k) {
      seen.push_back(sequence.next());
      ASSERT_GE(seen.back(), 0.0) << to_string(map);
      ASSERT_LE(seen.back(), 1.0) << to_string(map);
    }
    std::sort(seen.begin(), seen.end());
    const auto distinct = std::unique(seen.begin(), seen.end()) - seen.begin();
    EXPECT_GT(distinct, 5'000) << to_string(map);
    EXPECT_GT(seen[static_cast<std::size_t>(distinct) - 1] - seen[0], 0.3) << to_string(map);
  }
}

TEST(Chaos, StepsAreThoseOfTheTable) {
  const auto after = [](ChaoticMap map, double x) {
    ChaoticSequence sequence{map, Random{1}};
    sequence.start_at(x);
    return sequence.next();
  };
  EXPECT_NEAR(after(ChaoticMap::logistic, 0.3), 0.84, 1e-12);
  EXPECT_NEAR(after(ChaoticMap::circle, 0.25), 0.45 - 0.25 / std::numbers::pi, 1e-12);
  EXPECT_NEAR(after(ChaoticMap::gauss, 0.4), 0.5, 1e-12);
  EXPECT_NEAR(after(ChaoticMap::tent, 0.35), 0.5, 1e-12);
  EXPECT_NEAR(after(ChaoticMap::tent, 0.85), 0.5, 1e-12);
  EXPECT_NEAR(after(ChaoticMap::sine, 0.5 / 3.0), 0.5, 1e-12);
  EXPECT_NEAR(after(ChaoticMap::sinusoidal, 0.5), 0.575, 1e-12);
  EXPECT_NEAR(after(ChaoticMap::singer, 0.5), 1.07 * (3.93 - 5.8275 + 3.59375 - 13.302875 / 16),
              1e-12);
  EXPECT_NEAR(after(ChaoticMap::piecewise, 0.15), 0.5, 1e-12);
  EXPECT_NEAR(after(ChaoticMap::piecewise, 0.6), 0.5, 1e-12);
  EXPECT_NEAR(after(ChaoticMap::chebyshev, 0.75), 0.5 * (std::cos(4 * std::acos(0.5)) + 1), 1e-12);
  EXPECT_NEAR(after(ChaoticMap::iterative, 0.75), 0.5 * (std::sin(1.7 * std::numbers::pi) + 1),
              1e-12);
  EXPECT_NEAR(after(ChaoticMap::liebovitch, 0.55), 0.5, 1e-12);
  EXPECT_NEAR(after(ChaoticMap::intermittency, 0.25), 0.45, 1e-12);
  EXPECT_NEAR(after(ChaoticMap::intermittency, 0.75), 0.5, 1e-12);
}

}  // namespace
}  // namespace skein::routes
