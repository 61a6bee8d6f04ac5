// SPDX-License-Identifier: Apache-2.0
#include "skein/planning/allocation.hpp"

#include <benchmark/benchmark.h>
#include <glpk.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <vector>

#include "skein/base/angles.hpp"
#include "skein/base/random.hpp"
#include "skein/planning/assignment.hpp"

namespace {

using skein::Random;
using skein::planning::AllocationMethod;
using skein::planning::AllocationParams;
using skein::planning::AllocationProblem;
using skein::planning::Candidate;
using skein::planning::ColonyParams;

constexpr int kProblems = 64;

/// Site 1 of Wang 2022, 5.1: 8 simultaneous deliveries, 2 assessments; a fleet in the shares of
/// table 1 (11 allround, 11 carriers, 10 observers), anywhere in 8 by 7 km.
AllocationProblem random_problem(Random& random, std::size_t vehicles, std::size_t hazards) {
  AllocationProblem problem;
  auto& site = problem.site;
  site.id = skein::SiteId{1};
  site.position = {3500.0, 2800.0};
  for (const double bearing_deg : {15.0, 60.0, 105.0, 150.0, 195.0, 240.0, 285.0, 330.0}) {
    site.deliveries.push_back({skein::radians(bearing_deg), {}});
  }
  site.assess_wait = std::chrono::seconds{10};
  for (const double angle_deg : {0.0, 180.0}) {
    site.assessments.push_back({skein::radians(angle_deg), std::chrono::seconds{20}});
  }
  site.reward = 10.0;
  site.reward_decay_per_s = 0.005;
  problem.open_tasks = tasks_after_survey(site);
  problem.seed = random.next();
  for (std::size_t i = 0; i < vehicles; ++i) {
    Candidate c;
    c.id = skein::VehicleId{static_cast<std::uint16_t>(i + 1)};
    c.pose = {random.uniform(0.0, 8000.0), random.uniform(0.0, 7000.0),
              random.uniform(-skein::kPi, skein::kPi)};
    const bool carrier = i % 3 == 1;
    c.speed_mps = carrier ? 60.0 : 50.0;
    c.planning_radius_m = carrier ? 220.0 : 165.0;
    c.range_left_m = carrier ? 26000.0 : 18000.0;
    c.final_approach_m = 300.0;
    c.assess_radius_m = 300.0;
    if (i % 3 != 2) c.capabilities.add(skein::TaskKind::deliver);
    if (!carrier) c.capabilities.add(skein::TaskKind::assess);
    c.loads = 2;
    problem.candidates.push_back(c);
  }
  for (std::size_t i = 0; i < hazards; ++i) {
    const double angle = random.uniform(-skein::kPi, skein::kPi);
    problem.hazards.push_back(
        {skein::HazardId{static_cast<std::uint16_t>(i + 1)},
         site.position + random.uniform(900.0, 2500.0) * skein::unit_vector(angle),
         random.uniform(50.0, 250.0)});
  }
  return problem;
}

std::vector<AllocationProblem> random_problems(std::size_t vehicles, std::size_t hazards,
                                               std::uint64_t seed = 1, int count = kProblems) {
  Random random{seed};
  std::vector<AllocationProblem> problems;
  problems.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) problems.push_back(random_problem(random, vehicles, hazards));
  return problems;
}

/// Of this thread on the processor: the machine may be busy with others.
double cpu_us() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

/// Of one award each, the best of `runs`; sorted.
std::vector<double> times_us(const AllocationParams& params,
                             const std::vector<AllocationProblem>& problems, int runs) {
  std::vector<double> all_us;
  for (const auto& problem : problems) {
    double least_us = 1e9;
    for (int run = 0; run < runs; ++run) {
      const double begun_us = cpu_us();
      benchmark::DoNotOptimize(skein::planning::allocate(params, problem));
      least_us = std::min(least_us, cpu_us() - begun_us);
    }
    all_us.push_back(least_us);
  }
  std::sort(all_us.begin(), all_us.end());
  return all_us;
}

/// The whole award, with its table of lengths.
void award(benchmark::State& state, AllocationMethod method, std::size_t hazards) {
  const auto problems = random_problems(static_cast<std::size_t>(state.range(0)), hazards);
  AllocationParams params;
  params.method = method;
  std::size_t i = 0;
  double value = 0.0;
  double first_s = 0.0;
  int proven = 0;
  for (const auto& problem : problems) {
    const auto plan = skein::planning::allocate(params, problem);
    if (!plan) return state.SkipWithError(plan.error().message.c_str());
    value += plan->value.total / kProblems;
    first_s += plan->first_delivery_s / kProblems;
    proven += plan->proven ? 1 : 0;
  }
  while (state.KeepRunning()) {
    benchmark::DoNotOptimize(skein::planning::allocate(params, problems[i]));
    i = (i + 1) % problems.size();
  }
  state.counters["median_us"] = times_us(params, problems, 5)[kProblems / 2];
  state.counters["J"] = value;
  state.counters["deliver_s"] = first_s;
  state.counters["proven"] = static_cast<double>(proven) / kProblems;
}

/// How long awards take that are not tuned for: 3000 problems of another seed.
void award_tail(benchmark::State& state) {
  constexpr int kMany = 3000;
  auto problems = random_problems(32, static_cast<std::size_t>(state.range(0)), 8, kMany);
  for (auto& problem : problems) {
    for (auto& arc : problem.site.assessments) {
      if (state.range(1) != 0) arc.start_angle_rad.reset();
    }
  }
  const AllocationParams params;
  int proven = 0;
  while (state.KeepRunningBatch(1)) {
    proven = 0;
    for (const auto& problem : problems) {
      const auto plan = skein::planning::allocate(params, problem);
      proven += plan && plan->proven ? 1 : 0;
    }
    const auto all_us = times_us(params, problems, 3);
    state.counters["p50_us"] = all_us[kMany / 2];
    state.counters["p95_us"] = all_us[kMany * 95 / 100];
    state.counters["p99_us"] = all_us[kMany * 99 / 100];
    state.counters["worst_us"] = all_us.back();
  }
  state.counters["proven"] = static_cast<double>(proven) / kMany;
}

/// J as a share of the exact one, mean and least, after so many microseconds.
void colony_in_time(benchmark::State& state) {
  const auto problems = random_problems(32, 0);
  AllocationParams exact;
  exact.method = AllocationMethod::exact;
  AllocationParams colony;
  colony.method = AllocationMethod::colony;
  colony.colony.generations = 1'000'000;
  std::vector<double> best;
  best.reserve(problems.size());
  for (const auto& problem : problems) {
    best.push_back(skein::planning::allocate(exact, problem).value().value.total);
  }
  double sum = 0.0;
  double least = 1.0;
  std::size_t i = 0;
  int runs = 0;
  while (state.KeepRunning()) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::microseconds{state.range(0)};
    skein::planning::PlanningBudget budget;
    budget.expired = [end] { return std::chrono::steady_clock::now() >= end; };
    const auto plan = skein::planning::allocate(colony, problems[i], budget);
    const double share = plan.value().value.total / best[i];
    sum += share;
    least = std::min(least, share);
    ++runs;
    i = (i + 1) % problems.size();
  }
  state.counters["mean_share"] = sum / runs;
  state.counters["least_share"] = least;
}

/// J as a share of the exact one after 800 plans, with one of the tuned parameters at another
/// value.
void colony_tuning(benchmark::State& state, double ColonyParams::*parameter, double value) {
  const auto problems = random_problems(32, 0);
  AllocationParams exact;
  exact.method = AllocationMethod::exact;
  AllocationParams colony;
  colony.method = AllocationMethod::colony;
  if (parameter != nullptr) {
    colony.colony.*parameter = value;
  } else {
    colony.colony.ants = static_cast<int>(value);
  }
  colony.colony.generations = 1'000'000;
  double sum = 0.0;
  double least = 1.0;
  while (state.KeepRunning()) {
    sum = 0.0;
    for (const auto& problem : problems) {
      const auto best = skein::planning::allocate(exact, problem);
      const auto plan =
          skein::planning::allocate(colony, problem, {.steps_max = 800, .expired = {}});
      const double share = plan.value().value.total / best.value().value.total;
      sum += share;
      least = std::min(least, share);
    }
  }
  state.counters["mean_share"] = sum / kProblems;
  state.counters["least_share"] = least;
}

std::vector<Eigen::MatrixXd> random_matrices(int rows, int columns) {
  Random random{2};
  std::vector<Eigen::MatrixXd> matrices;
  for (int i = 0; i < kProblems; ++i) {
    Eigen::MatrixXd cost(rows, columns);
    for (double& entry : cost.reshaped()) entry = random.uniform(500.0, 6000.0);
    matrices.push_back(cost);
  }
  return matrices;
}

void assignment(benchmark::State& state) {
  const auto matrices =
      random_matrices(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
  std::size_t i = 0;
  while (state.KeepRunning()) {
    benchmark::DoNotOptimize(skein::planning::least_sum_assignment(matrices[i]));
    i = (i + 1) % matrices.size();
  }
}

/// The same as a linear program (its optimum is integral), by the primal simplex.
void glpk_assignment(benchmark::State& state) {
  const auto matrices =
      random_matrices(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
  std::size_t i = 0;
  while (state.KeepRunning()) {
    const auto& cost = matrices[i];
    const int rows = static_cast<int>(cost.rows());
    const int columns = static_cast<int>(cost.cols());
    glp_prob* program = glp_create_prob();
    glp_add_rows(program, rows + columns);
    glp_add_cols(program, rows * columns);
    std::vector<int> at{0};
    std::vector<int> variable{0};
    std::vector<double> one{0.0};
    for (int r = 0; r < rows; ++r) glp_set_row_bnds(program, r + 1, GLP_FX, 1.0, 1.0);
    for (int c = 0; c < columns; ++c) glp_set_row_bnds(program, rows + c + 1, GLP_UP, 0.0, 1.0);
    for (int r = 0; r < rows; ++r) {
      for (int c = 0; c < columns; ++c) {
        const int v = r * columns + c + 1;
        glp_set_col_bnds(program, v, GLP_LO, 0.0, 0.0);
        glp_set_obj_coef(program, v, cost(r, c));
        for (const int row : {r + 1, rows + c + 1}) {
          at.push_back(row);
          variable.push_back(v);
          one.push_back(1.0);
        }
      }
    }
    glp_load_matrix(program, static_cast<int>(at.size()) - 1, at.data(), variable.data(),
                    one.data());
    glp_smcp options;
    glp_init_smcp(&options);
    options.msg_lev = GLP_MSG_OFF;
    glp_simplex(program, &options);
    benchmark::DoNotOptimize(glp_get_obj_val(program));
    glp_delete_prob(program);
    i = (i + 1) % matrices.size();
  }
}

}  // namespace

using benchmark::kMicrosecond;
using benchmark::kMillisecond;

BENCHMARK(assignment)->Name("assignment/skein")->Args({8, 32})->Args({10, 56});
BENCHMARK(glpk_assignment)->Name("assignment/GLPK")->Args({8, 32})->Args({10, 56});

// Candidates; hazards in the last of each.
#define AWARD(method)                                                     \
  BENCHMARK_CAPTURE(award, method, AllocationMethod::method, 0)           \
      ->Name("award_" #method "/skein")                                   \
      ->Arg(24)                                                           \
      ->Arg(32)                                                           \
      ->Arg(56)                                                           \
      ->Unit(kMicrosecond);                                               \
  BENCHMARK_CAPTURE(award, method##_hazards, AllocationMethod::method, 4) \
      ->Name("award_" #method "/skein/4_hazards")                         \
      ->Arg(32)                                                           \
      ->Unit(kMicrosecond)
AWARD(exact);
AWARD(earliest);
AWARD(colony);
AWARD(polynomial);
AWARD(greedy);

// Hazards; are the assessments' angles free?
BENCHMARK(award_tail)
    ->Name("award_tail/skein")
    ->Args({0, 0})
    ->Args({4, 0})
    ->Args({0, 1})
    ->Args({4, 1})
    ->Iterations(1)
    ->Unit(kMillisecond);

// Microseconds allowed.
BENCHMARK(colony_in_time)
    ->Name("colony_in_us/skein")
    ->Arg(1000)
    ->Arg(2000)
    ->Arg(5000)
    ->Arg(10000)
    ->Arg(20000)
    ->Unit(kMillisecond);

namespace {

/// One parameter at a time, the value in use among them (docs/methods.md).
struct Tuned {
  const char* name;
  double ColonyParams::*parameter;  ///< null: ants
  std::vector<double> values;
};

bool register_tuning() {
  const std::vector<Tuned> all{
      {"ants", nullptr, {8, 16, 32, 64}},
      {"alpha", &ColonyParams::alpha, {0.5, 1.0, 2.0}},
      {"beta", &ColonyParams::beta, {1.0, 2.0, 3.0}},
      {"q0", &ColonyParams::q0, {0.0, 0.3, 0.7}},
      {"tau0", &ColonyParams::tau0, {0.005, 0.02, 0.1}},
      {"local_evaporation", &ColonyParams::local_evaporation, {0.0, 0.1, 0.3, 0.5}},
      {"global_evaporation", &ColonyParams::global_evaporation, {0.01, 0.02, 0.1}},
      {"distance_weight", &ColonyParams::distance_weight, {0.3, 1.0, 3.0}},
      {"time_weight", &ColonyParams::time_weight, {1.0, 3.0, 10.0}}};
  for (const Tuned& tuned : all) {
    for (const double value : tuned.values) {
      std::array<char, 80> name{};
      std::snprintf(name.data(), name.size(), "colony_tuning/skein/%s=%g", tuned.name, value);
      benchmark::RegisterBenchmark(name.data(), colony_tuning, tuned.parameter, value)
          ->Iterations(1)
          ->Unit(kMillisecond);
    }
  }
  return true;
}
[[maybe_unused]] const bool kTuningIsRegistered = register_tuning();

}  // namespace
