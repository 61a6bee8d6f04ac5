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
#include "skein/planning/avoidance.hpp"
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

/// A time to be promised; hazards are about, none of them in the way.
/// Near ones may have a gap, so that a search decides.
void arrival(benchmark::State& state, double apart_radii, double size_radii) {
  using namespace skein::planning;  // NOLINT(google-build-using-namespace)
  const Queries queries = random_queries(size_radii);
  std::vector<skein::Hazard> hazards;
  for (std::uint16_t i = 0; i < 4; ++i) {
    hazards.push_back({skein::HazardId{i}, {-9000.0, 3000.0 * i}, 300.0});
  }
  std::size_t i = 0;
  while (state.KeepRunning()) {
    Transit transit{queries.from[i], queries.to[i], kRadius_m, 1e5, hazards};
    transit.to.x_m += apart_radii * kRadius_m;
    const double chord_m = (transit.to.position() - transit.from.position()).norm();
    const double length_m = chord_m + 500.0;
    benchmark::DoNotOptimize(least_length_from({}, transit, length_m));
    i = i + 1 == kQueries ? 0 : i + 1;
  }
}

/// The path past so many hazards between the ends; four more are about, out of reach.
std::vector<skein::Hazard> hazards_between(std::uint16_t count) {
  std::vector<skein::Hazard> hazards;
  for (std::uint16_t i = 0; i < 4; ++i) {
    hazards.push_back({skein::HazardId{i}, {-9000.0, 3000.0 * i}, 300.0});
  }
  for (std::uint16_t i = 0; i < count; ++i) {
    const double x_m = 22.5 * kRadius_m + 500.0 * (i % 2 == 0 ? 1.0 : -1.0);
    const double y_m = (i + 1.0) * 20.0 * kRadius_m / (count + 1.0);
    hazards.push_back({skein::HazardId{static_cast<std::uint16_t>(4 + i)}, {x_m, y_m}, 250.0});
  }
  return hazards;
}

void clear_path(benchmark::State& state, std::uint16_t between) {
  using skein::planning::shortest_clear_path;
  const Queries queries = random_queries(20.0);
  const auto hazards = hazards_between(between);
  std::size_t i = 0;
  while (state.KeepRunning()) {
    Pose2 to = queries.to[i];
    to.x_m += 25.0 * kRadius_m;
    benchmark::DoNotOptimize(shortest_clear_path({}, queries.from[i], to, kRadius_m, hazards));
    i = i + 1 == kQueries ? 0 : i + 1;
  }
}

void clear_length(benchmark::State& state) {
  using skein::planning::shortest_clear_length;
  const Queries queries = random_queries(20.0);
  const auto hazards = hazards_between(0);
  std::size_t i = 0;
  while (state.KeepRunning()) {
    Pose2 to = queries.to[i];
    to.x_m += 25.0 * kRadius_m;
    benchmark::DoNotOptimize(shortest_clear_length({}, queries.from[i], to, kRadius_m, hazards));
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

BENCHMARK_CAPTURE(arrival, far, 25.0, 20.0)->Name("least_length_from/skein/far");
BENCHMARK_CAPTURE(arrival, near, 0.0, 6.0)->Name("least_length_from/skein/near");
BENCHMARK_CAPTURE(clear_path, free, 0)->Name("shortest_clear_path/skein/free");
BENCHMARK_CAPTURE(clear_path, one, 1)->Name("shortest_clear_path/skein/one");
BENCHMARK_CAPTURE(clear_path, four, 4)->Name("shortest_clear_path/skein/four");
BENCHMARK(clear_length)->Name("shortest_clear_length/skein/free");
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
