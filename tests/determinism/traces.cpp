// SPDX-License-Identifier: Apache-2.0
//
// Prints simulated missions, plans of coupled problems and Dubins lengths to the last bit, for
// comparison between compilers (./dev test compilers).
#include <array>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "instances.hpp"
#include "skein/base/angles.hpp"
#include "skein/hil/judged_runs.hpp"
#include "skein/hil/team_mission.hpp"
#include "skein/idl/autopilot_fields.hpp"
#include "skein/idl/coalition_fields.hpp"
#include "skein/idl/domain_fields.hpp"
#include "skein/idl/events_fields.hpp"
#include "skein/planning/dubins_batch.hpp"

namespace skein {
namespace {

/// The moments and figures of an event.
template <class Struct>
void print_exactly(const Struct& made) {
  codec::for_each_field(made, []<class T>(std::string_view /*name*/, const T& value) {
    if constexpr (std::is_same_v<T, double>) std::printf(" %a", value);
    if constexpr (std::is_same_v<T, Instant> || std::is_same_v<T, Duration>) {
      std::printf(" %a", to_seconds(value));
    }
  });
}

/// Every event, plan and state, numbers exact.
hil::TeamObserver exact_printer() {
  hil::TeamObserver print;
  print.event = [](const mission::MissionEvent& e) {
    std::printf("%s", hil::trace_line(e).c_str());
    std::visit([](const auto& body) { print_exactly(body); }, e.body);
    std::printf("\n");
  };
  print.plan = [](VehicleId id, const mission::FlightPlan& plan, Instant) {
    const Pose2 end = plan.timed.path.end();
    std::printf("plan %u.%u %a %a %a\n", static_cast<unsigned>(id.value), plan.number, end.x_m,
                end.y_m, plan.timed.path.length_m());
  };
  print.track = [](VehicleId id, const VehicleState& s, const mission::FlightPlan&) {
    std::printf("at %u %a %a %a\n", static_cast<unsigned>(id.value), s.x_m, s.y_m, s.heading_rad);
  };
  print.fault = [](const hil::FaultEvent& e) { std::printf("%s\n", hil::trace_line(e).c_str()); };
  return print;
}

struct Trace {
  const char* scenario;
  const char* faults;
  std::uint64_t first_seed;
  std::uint64_t last_seed;
};
constexpr std::array<Trace, 3> kTraces{
    {{"coalition-32", "none", 1, 1}, {"coalition-6", "lossy", 1, 3}, {"faults-8", "mixed", 1, 12}}};

void print(const planning::CoupledPlan& plan) {
  std::printf("coupled plan %a %a, %u steps\n", plan.objective, plan.bound.value_or(0.0),
              static_cast<unsigned>(plan.steps));
  for (const planning::CoupledTask& task : plan.tasks) {
    std::printf("%s %u %a %a %a\n", to_string(task.task).c_str(),
                static_cast<unsigned>(task.vehicle.value), task.time_s, task.end_s, task.transit_m);
  }
}

/// A tree that ends, one that a budget ends, and a search, by every criterion.
void print_coupled_plans() {
  for (const auto criterion : {planning::Criterion::value, planning::Criterion::completion,
                               planning::Criterion::makespan}) {
    for (const std::size_t sites : {std::size_t{3}, std::size_t{6}}) {
      Random draws{sites};
      planning::CoupledProblem problem =
          planning::draw_problem(draws, {.sites = sites, .vehicles = sites});
      problem.criterion = criterion;
      if (const auto plan = branch_and_bound(problem, {.steps_max = 3000, .expired = {}})) {
        print(*plan);
      }
      Random lots{7};
      if (const auto plan = ruin_and_recreate(problem, lots, {.steps_max = 300, .expired = {}})) {
        print(*plan);
      }
    }
  }
}

void print_lengths() {
  Random random{8};
  for (const double size_m : {300.0, 1000.0, 10000.0}) {
    planning::PoseBatch from;
    planning::PoseBatch to;
    const auto draw = [&] {
      return Pose2{random.uniform(0.0, size_m), random.uniform(0.0, size_m),
                   random.uniform(-kPi, kPi)};
    };
    constexpr int kPairs = 2000;
    for (int i = 0; i < kPairs; ++i) {
      from.push_back(draw());
      to.push_back(draw());
    }
    std::vector<double> lengths_m(kPairs);
    for (const planning::SimdLevel level : planning::simd_levels()) {
      shortest_dubins_lengths(from.columns(), to.columns(), 165.0, lengths_m, level);
      for (const double length_m : lengths_m) std::printf("length %a\n", length_m);
    }
  }
}

}  // namespace
}  // namespace skein

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: traces FOLDER-OF-SCENARIOS\n", stderr);
    return 2;
  }
  for (const auto& trace : skein::kTraces) {
    auto scenario =
        skein::configuration::load_scenario(std::string{argv[1]} + "/" + trace.scenario + ".yaml");
    if (!scenario) {
      std::fprintf(stderr, "%s\n", scenario.error().message.c_str());
      return 2;
    }
    scenario->wind.gust_mps = 0.5;
    for (std::uint64_t seed = trace.first_seed; seed <= trace.last_seed; ++seed) {
      const auto mission = skein::hil::seeded_mission(*scenario, seed, trace.faults);
      if (!mission) return 2;
      std::printf("%s, seed %u\n%s", trace.scenario, static_cast<unsigned>(seed),
                  skein::hil::describe(*mission).c_str());
      const auto run = skein::hil::fly_judged(*mission, skein::hil::limits_of(scenario->expect),
                                              skein::exact_printer());
      for (const auto& check : run.broken) {
        for (const auto& v : check.violations) std::printf("%s\n", v.sentence.c_str());
      }
    }
  }
  skein::print_coupled_plans();
  skein::print_lengths();
  return 0;
}
