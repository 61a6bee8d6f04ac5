// SPDX-License-Identifier: Apache-2.0
#include "skein/planning/dubins.hpp"

#include <benchmark/benchmark.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/spaces/DubinsStateSpace.h>

#include <memory>
#include <vector>

#include "skein/base/angles.hpp"
#include "skein/base/random.hpp"
#include "skein/planning/arrival.hpp"
#include "skein/planning/dubins_batch.hpp"

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

/// All queries in one call. With the trigonometry of the headings at hand, or without.
void batch(benchmark::State& state, double radii, bool cached, std::size_t level) {
  using skein::planning::simd_levels;
  if (level >= simd_levels().size()) return state.SkipWithError("not on this processor");
  const Queries queries = random_queries(radii);
  skein::planning::PoseBatch from;
  skein::planning::PoseBatch to;
  for (const Pose2& pose : queries.from) from.push_back(pose);
  for (const Pose2& pose : queries.to) to.push_back(pose);
  auto a = from.columns();
  auto b = to.columns();
  if (!cached) a.cos = a.sin = b.cos = b.sin = {};
  std::vector<double> lengths(kQueries);
  while (state.KeepRunning()) {
    skein::planning::shortest_dubins_lengths(a, b, kRadius_m, lengths, simd_levels()[level]);
    benchmark::DoNotOptimize(lengths.data());
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(kQueries) * state.iterations());
}

/// A time to be promised: poses 3 to 6 km apart, hazards about, none of them in the way.
void arrival(benchmark::State& state) {
  using namespace skein::planning;  // NOLINT(google-build-using-namespace)
  const Queries queries = random_queries(20.0);
  std::vector<skein::Hazard> hazards;
  for (std::uint16_t i = 0; i < 4; ++i) {
    hazards.push_back({skein::HazardId{i}, {-9000.0, 3000.0 * i}, 300.0});
  }
  std::size_t i = 0;
  while (state.KeepRunning()) {
    Transit transit{queries.from[i], queries.to[i], kRadius_m, 1e5, hazards};
    transit.to.x_m += 25.0 * kRadius_m;
    const double length_m = (transit.to.position() - transit.from.position()).norm() + 500.0;
    benchmark::DoNotOptimize(least_length_from({}, transit, length_m));
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

BENCHMARK(arrival)->Name("least_length_from/skein");
// The batch against the peer's one by one; it has no batch.
BENCHMARK_CAPTURE(batch, avx2_near, 6.0, false, 1)->Name("dubins_batch/skein/near");
BENCHMARK_CAPTURE(ompl_distance, batch_near, 6.0)->Name("dubins_batch/ompl/near");
BENCHMARK_CAPTURE(batch, avx2_far, 60.0, false, 1)->Name("dubins_batch/skein/far");
BENCHMARK_CAPTURE(ompl_distance, batch_far, 60.0)->Name("dubins_batch/ompl/far");
BENCHMARK_CAPTURE(batch, cached_near, 6.0, true, 1)->Name("dubins_batch_cached/skein/near");
BENCHMARK_CAPTURE(batch, cached_far, 60.0, true, 1)->Name("dubins_batch_cached/skein/far");
BENCHMARK_CAPTURE(batch, baseline_near, 6.0, false, 0)->Name("dubins_batch_baseline/skein/near");
BENCHMARK_CAPTURE(batch, baseline_far, 60.0, false, 0)->Name("dubins_batch_baseline/skein/far");
BENCHMARK_CAPTURE(batch, avx512_near, 6.0, false, 2)->Name("dubins_batch_avx512/skein/near");
BENCHMARK_CAPTURE(batch, avx512_far, 60.0, false, 2)->Name("dubins_batch_avx512/skein/far");

}  // namespace
