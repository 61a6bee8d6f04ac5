// SPDX-License-Identifier: Apache-2.0
//
// Prints simulated missions to the last bit, for comparison between compilers (./dev test
// compilers).
#include <array>
#include <cstdint>
#include <cstdio>
#include <string>

#include "skein/hil/judged_runs.hpp"
#include "skein/hil/team_mission.hpp"

namespace skein {
namespace {

/// Every event, plan and state, numbers exact.
hil::TeamObserver exact_printer() {
  hil::TeamObserver print;
  print.event = [](const mission::MissionEvent& e) {
    std::printf("%s %a\n", hil::trace_line(e).c_str(), e.value);
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
  return 0;
}
