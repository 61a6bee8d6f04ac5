// SPDX-License-Identifier: Apache-2.0
#include "skein/coupled/coupled.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <optional>
#include <string>
#include <vector>

#include "instances.hpp"

namespace {

using skein::Random;
using skein::planning::CoupledDraw;
using skein::planning::CoupledPlan;
using skein::planning::CoupledProblem;
using skein::planning::Criterion;
using skein::planning::PlanningBudget;

constexpr std::uint64_t kInstances = 20;
constexpr std::uint64_t kSeeds = 5;  ///< of a search, for each instance
/// Those that nothing was tuned on.
constexpr std::uint64_t kFresh = 8900;
constexpr std::uint64_t kFreshInstances = 100;

/// Seconds of this process on the processor: the machine may be busy with others.
double cpu_s() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

PlanningBudget seconds_from_now(double seconds) {
  PlanningBudget budget;
  budget.expired = [end_s = cpu_s() + seconds] { return cpu_s() >= end_s; };
  return budget;
}

CoupledProblem instance(std::uint64_t number, const CoupledDraw& draw, Criterion criterion,
                        bool flyable_waits) {
  Random random{100 + number};
  CoupledProblem problem = draw_problem(random, draw);
  problem.criterion = criterion;
  problem.flyable_waits = flyable_waits;
  return problem;
}

double loss(const CoupledPlan& plan, double best) {
  return std::abs(plan.objective - best) / std::abs(best);
}

class Losses {
 public:
  void add(double value) { values_.push_back(value); }
  void report(benchmark::State& state, const std::string& who) {
    if (values_.empty()) return;
    std::sort(values_.begin(), values_.end());
    double sum = 0.0;
    for (const double v : values_) sum += v;
    state.counters[who + "_mean_%"] = 100.0 * sum / static_cast<double>(values_.size());
    state.counters[who + "_median_%"] = 100.0 * values_[values_.size() / 2];
    state.counters[who + "_worst_%"] = 100.0 * values_.back();
  }

 private:
  std::vector<double> values_;
};

/// Branch and bound to the proof, each instance once. Greedy beside it.
void prove(benchmark::State& state, CoupledDraw draw, Criterion criterion, bool flyable_waits) {
  std::vector<double> times_ms;
  Losses greedy;
  Losses gap;
  double proven = 0.0;
  while (state.KeepRunningBatch(kInstances)) {
    for (std::uint64_t k = 0; k < kInstances; ++k) {
      const CoupledProblem problem = instance(k, draw, criterion, flyable_waits);
      const double start_s = cpu_s();
      const auto plan = branch_and_bound(problem, seconds_from_now(60.0));
      times_ms.push_back(1e3 * (cpu_s() - start_s));
      if (!plan) return state.SkipWithError(plan.error().message.c_str());
      proven += plan->proven ? 1.0 : 0.0;
      gap.add(plan->gap());
      if (const auto tendered = greedy_awards(problem)) greedy.add(loss(*tendered, *plan->bound));
    }
  }
  std::sort(times_ms.begin(), times_ms.end());
  state.counters["proven_%"] = 100.0 * proven / static_cast<double>(times_ms.size());
  state.counters["median_ms"] = times_ms[times_ms.size() / 2];
  state.counters["most_ms"] = times_ms.back();
  greedy.report(state, "greedy");
  gap.report(state, "gap");
}

/// Ruin and recreate for so long, against the proven optimum.
void search(benchmark::State& state, CoupledDraw draw, Criterion criterion, double seconds,
            std::uint64_t first, std::uint64_t instances) {
  Losses found;
  double steps = 0.0;
  double runs = 0.0;
  std::vector<std::optional<double>> best(instances);
  while (state.KeepRunningBatch(static_cast<benchmark::IterationCount>(instances * kSeeds))) {
    for (std::uint64_t k = 0; k < instances; ++k) {
      const CoupledProblem problem = instance(first + k, draw, criterion, false);
      if (!best[k]) {
        state.PauseTiming();
        const auto exact = branch_and_bound(problem, seconds_from_now(60.0));
        if (!exact || !exact->proven) return state.SkipWithError("not proven in 60 s");
        best[k] = exact->objective;
        state.ResumeTiming();
      }
      for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
        Random random{seed};
        const auto plan = ruin_and_recreate(problem, random, seconds_from_now(seconds));
        if (!plan) return state.SkipWithError(plan.error().message.c_str());
        found.add(loss(*plan, *best[k]));
        steps += static_cast<double>(plan->steps);
        runs += 1.0;
      }
    }
  }
  found.report(state, "loss");
  state.counters["steps"] = steps / runs;
}

/// What nobody proves: against greedy, and against the bound of the branch and bound.
void large(benchmark::State& state, CoupledDraw draw, Criterion criterion, double seconds) {
  constexpr std::uint64_t kLarge = 5;
  Losses over_greedy;
  Losses over_bound;
  double steps = 0.0;
  double runs = 0.0;
  while (state.KeepRunningBatch(kLarge)) {
    for (std::uint64_t k = 0; k < kLarge; ++k) {
      const CoupledProblem problem = instance(k, draw, criterion, true);
      Random random{1};
      const auto plan = ruin_and_recreate(problem, random, seconds_from_now(seconds));
      if (!plan) return state.SkipWithError(plan.error().message.c_str());
      steps += static_cast<double>(plan->steps);
      runs += 1.0;
      state.PauseTiming();
      PlanningBudget root;
      root.steps_max = 1;
      const auto bounded = branch_and_bound(problem, root);
      if (bounded) over_bound.add(loss(*plan, *bounded->bound));
      if (const auto greedy = greedy_awards(problem)) {
        over_greedy.add(loss(*greedy, plan->objective));
      }
      state.ResumeTiming();
    }
  }
  over_bound.report(state, "bound_gap");
  over_greedy.report(state, "greedy");
  state.counters["steps"] = steps / runs;
}

struct NamedCriterion {
  const char* name;
  Criterion criterion;
};
constexpr std::array kCriteria{NamedCriterion{"value", Criterion::value},
                               NamedCriterion{"completion", Criterion::completion},
                               NamedCriterion{"makespan", Criterion::makespan}};

[[maybe_unused]] const bool kRegistered = [] {
  const auto add = [](const std::string& name, auto body, const auto&... arguments) {
    benchmark::RegisterBenchmark(name.data(), body, arguments...)->Unit(benchmark::kMillisecond);
  };
  for (const auto& [name, criterion] : kCriteria) {
    const Criterion by = criterion;
    for (const auto& [sites, vehicles] : {std::pair{3, 5}, std::pair{4, 6}, std::pair{6, 6}}) {
      CoupledDraw draw;
      draw.sites = static_cast<std::size_t>(sites);
      draw.vehicles = static_cast<std::size_t>(vehicles);
      const std::string size = std::to_string(sites) + "x" + std::to_string(vehicles);
      const std::string end = std::string{"/"} + name + "_" + size;
      add("prove/skein" + end, prove, draw, by, false);
      add("prove_flyable/skein" + end, prove, draw, by, true);
      add("search_10ms/skein" + end, search, draw, by, 0.010, std::uint64_t{0}, kInstances);
      if (by == Criterion::makespan) {
        add("fresh_10ms/skein" + end, search, draw, by, 0.010, kFresh, kFreshInstances);
      }
    }
    if (by == Criterion::makespan) {
      add("fresh_10ms/skein/makespan_8x8", search, CoupledDraw{.sites = 8, .vehicles = 8}, by,
          0.010, kFresh, kFreshInstances);
      add("fresh_10ms/skein/makespan_4x6_two_deliveries", search,
          CoupledDraw{.sites = 4, .vehicles = 6, .deliveries = 2}, by, 0.010, kFresh,
          kFreshInstances);
    }
    CoupledDraw draw;
    draw.vehicles = 56;
    draw.deliveries = 6;
    draw.assessments = 6;
    for (const int ms : {10, 100, 1000}) {
      add("search_" + std::to_string(ms) + "ms/skein/" + name + "_3x13_tasks_56", large, draw, by,
          1e-3 * ms);
    }
  }
  return true;
}();

}  // namespace
