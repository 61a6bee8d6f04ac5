// SPDX-License-Identifier: Apache-2.0
#include "skein/planning/dubins.hpp"

#include <benchmark/benchmark.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/spaces/DubinsStateSpace.h>

#include <memory>
#include <vector>

#include "skein/base/angles.hpp"
#include "skein/base/random.hpp"

namespace {

using skein::Pose2;

constexpr double kRadius_m = 165.0;
constexpr std::size_t kQueries = 100'000;

struct Queries {
  std::vector<Pose2> from;
  std::vector<Pose2> to;
};

/// Poses in a square of that many radii: `near` meets every word, in `far` the circles are apart.
Queries random_queries(double radii) {
  skein::Random random{1};
  const auto pose = [&] {
    return Pose2{random.uniform(0.0, radii * kRadius_m), random.uniform(0.0, radii * kRadius_m),
                 random.uniform(-skein::kPi, skein::kPi)};
  };
  Queries queries;
  for (std::size_t i = 0; i < kQueries; ++i) {
    queries.from.push_back(pose());
    queries.to.push_back(pose());
  }
  return queries;
}

void scalar(benchmark::State& state, double radii) {
  const Queries queries = random_queries(radii);
  std::size_t i = 0;
  while (state.KeepRunning()) {
    benchmark::DoNotOptimize(
        skein::planning::shortest_dubins_length(queries.from[i], queries.to[i], kRadius_m));
    i = i + 1 == kQueries ? 0 : i + 1;
  }
}

void ompl_distance(benchmark::State& state, double radii) {
  const Queries queries = random_queries(radii);
  const auto space = std::make_shared<ompl::base::DubinsStateSpace>(kRadius_m);
  using Pose = ompl::base::ScopedState<ompl::base::SE2StateSpace>;
  const auto states = [&](const std::vector<Pose2>& poses) {
    std::vector<std::unique_ptr<Pose>> result;
    for (const Pose2& p : poses) {
      auto& s = *result.emplace_back(std::make_unique<Pose>(space));
      s->setXY(p.x_m, p.y_m);
      s->setYaw(p.heading_rad);
    }
    return result;
  };
  const auto from = states(queries.from);
  const auto to = states(queries.to);
  std::size_t i = 0;
  while (state.KeepRunning()) {
    benchmark::DoNotOptimize(space->distance(from[i]->get(), to[i]->get()));
    i = i + 1 == kQueries ? 0 : i + 1;
  }
}

BENCHMARK_CAPTURE(scalar, near, 6.0)->Name("dubins_length/skein/near");
BENCHMARK_CAPTURE(ompl_distance, near, 6.0)->Name("dubins_length/ompl/near");
BENCHMARK_CAPTURE(scalar, far, 60.0)->Name("dubins_length/skein/far");
BENCHMARK_CAPTURE(ompl_distance, far, 60.0)->Name("dubins_length/ompl/far");

}  // namespace
