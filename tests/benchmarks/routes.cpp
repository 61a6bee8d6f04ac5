// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "skein/paper_routes/paper_world.hpp"
#include "skein/routes/cooperative.hpp"
#include "skein/routes/corridors.hpp"
#include "skein/routes/fly_by.hpp"
#include "skein/routes/single_route.hpp"

namespace {

using skein::Random;
using skein::Vec2;
using skein::routes::CurveEvaluator;
using skein::routes::CurveForm;
using skein::routes::CurveProblem;

CurveProblem paper_problem() {
  return skein::routes::paper_curve(skein::routes::paper_starts().front());
}

/// Points of one form around the best way, so that some hazards are near.
std::vector<std::vector<double>> points(const CurveEvaluator& evaluator) {
  Random random{1};
  std::vector<std::vector<double>> all;
  for (int k = 0; k < 256; ++k) {
    std::vector<Vec2> way = {{133, 197}, {265, 395}, {406, 584}, {599, 721}, {794, 855}};
    for (Vec2& p : way) p += Vec2{random.normal(0.0, 40.0), random.normal(0.0, 40.0)};
    all.push_back(evaluator.point_of(way));
  }
  return all;
}

void evaluate(benchmark::State& state, CurveForm form, CurveEvaluator::Width width) {
  CurveEvaluator evaluator{paper_problem(), form, width};
  const auto all = points(evaluator);
  std::size_t k = 0;
  for (auto _ : state) benchmark::DoNotOptimize(evaluator(all[k++ % all.size()]));
}

/// The peer: the same costs as they are defined, sample by sample.
void plain(benchmark::State& state) {
  const CurveProblem problem = paper_problem();
  CurveEvaluator evaluator{problem, CurveForm::lateral_offsets};
  const auto all = points(evaluator);
  std::vector<std::vector<Vec2>> curves;
  std::vector<std::vector<Vec2>> ways;
  for (const auto& point : all) {
    curves.push_back(evaluator.curve(point));
    ways.push_back(evaluator.waypoints(point));
    ways.back().insert(ways.back().begin(), problem.start);
    ways.back().push_back(problem.site);
  }
  std::size_t k = 0;
  for (auto _ : state) {
    const std::vector<Vec2>& curve = curves[k % curves.size()];
    const std::vector<Vec2>& way = ways[k++ % ways.size()];
    double exposure = 0.0;
    double length = 0.0;
    double turning = 0.0;
    for (std::size_t i = 0; i < curve.size(); ++i) {
      for (const auto& hazard : problem.hazards) exposure += hazard.value_at(curve[i]);
      if (i > 0) length += (curve[i] - curve[i - 1]).norm();
    }
    for (std::size_t i = 3; i < way.size(); ++i) {
      turning += std::abs(skein::routes::turn_at(way[i - 2], way[i - 1], way[i]) -
                          skein::routes::turn_at(way[i - 3], way[i - 2], way[i - 1]));
    }
    benchmark::DoNotOptimize(exposure / 200.0 + length + turning / 4.0);
  }
}

void plan_single(benchmark::State& state) {
  const CurveProblem problem = skein::routes::paper_curve(
      skein::routes::paper_starts()[static_cast<std::size_t>(state.range(0))]);
  std::uint64_t seed = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(skein::routes::plan_route(problem, {}, Random{seed++}));
  }
}

/// Of flights, in random worlds.
void plan_flight(benchmark::State& state) {
  std::uint64_t seed = 0;
  for (auto _ : state) {
    CurveProblem problem = skein::routes::random_curve(Random{seed});
    problem.reading = skein::routes::CostReading::of_flights;
    benchmark::DoNotOptimize(skein::routes::plan_route(problem, {}, Random{seed++}));
  }
}

void corridors(benchmark::State& state) {
  const auto problem = skein::routes::random_team(1, 30, Random{1});
  std::vector<skein::routes::Disc> discs;
  for (const auto& hazard : problem.hazards) discs.push_back({hazard.centre, hazard.radius_m});
  const skein::routes::CorridorEnds ends{.start = problem.vehicles[0].start, .goal = problem.site};
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        skein::routes::shortest_corridors(ends, discs, static_cast<std::size_t>(state.range(0))));
  }
}

void plan_paper_team(benchmark::State& state) {
  const auto problem = skein::routes::paper_team();
  std::uint64_t seed = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(skein::routes::plan_routes(problem, {}, Random{seed++}));
  }
}

void plan_random_team(benchmark::State& state) {
  std::uint64_t seed = 0;
  for (auto _ : state) {
    const auto problem =
        skein::routes::random_team(static_cast<std::size_t>(state.range(0)), 30, Random{seed});
    benchmark::DoNotOptimize(skein::routes::plan_routes(problem, {}, Random{seed++}));
  }
}

BENCHMARK_CAPTURE(evaluate, lateral, CurveForm::lateral_offsets, CurveEvaluator::widths().back())
    ->Name("evaluate/skein/lateral");
BENCHMARK_CAPTURE(evaluate, free, CurveForm::free_points, CurveEvaluator::widths().back())
    ->Name("evaluate/skein/free");
BENCHMARK_CAPTURE(evaluate, shape, CurveForm::turns_and_legs, CurveEvaluator::widths().back())
    ->Name("evaluate/skein/shape");
BENCHMARK_CAPTURE(evaluate, narrow, CurveForm::lateral_offsets, CurveEvaluator::Width::baseline)
    ->Name("evaluate/narrow/lateral");
BENCHMARK(plain)->Name("evaluate/plain/lateral");
BENCHMARK(plan_single)->Name("plan_route/skein")->DenseRange(0, 2)->Unit(benchmark::kMillisecond);
BENCHMARK(plan_flight)->Name("plan_route/skein/flights")->Unit(benchmark::kMillisecond);
BENCHMARK(corridors)->Name("corridors/skein")->Arg(1)->Arg(12)->Unit(benchmark::kMicrosecond);
BENCHMARK(plan_paper_team)->Name("plan_routes/skein/paper")->Unit(benchmark::kMillisecond);
BENCHMARK(plan_random_team)
    ->Name("plan_routes/skein/random")
    ->Arg(5)
    ->Arg(10)
    ->Arg(20)
    ->Iterations(10)
    ->Unit(benchmark::kMillisecond);

}  // namespace
