// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/configuration/scenario.hpp"
#include "skein/hil/team_simulator.hpp"

/// Simulated formations, judged by code that knows the bodies and what is said only.
namespace skein::hil {

struct FormationViolation {
  Instant time{};
  std::string check;  ///< separation, ceiling, place, liveness
  std::string sentence;
};

struct FormationRun {
  std::uint64_t seed = 0;
  std::vector<FormationViolation> violations;  ///< the first of each check and pair
  bool script_done = false;
  std::string reason;          ///< where it is not: why the team holds
  double least_m = 0.0;        ///< of any two bodies in the air, heights stretched, continuous time
  double farthest_m = 0.0;     ///< of any body from its reference
  double worst_rms_m = 0.0;    ///< of planes, from their places while the formation held
  std::size_t changes = 0;     ///< that were begun
  std::size_t lost = 0;        ///< vehicles, for good
  std::uint64_t messages = 0;  ///< of the vehicles, counted once for each sender
  Instant ended_at{};
  [[nodiscard]] bool held() const { return violations.empty(); }
};

/// Flies it in the calling thread. The same mission gives the same bytes. Fails where the script
/// cannot be read. Precondition: mission.formation.
[[nodiscard]] Result<FormationRun> fly_formation(const TeamMission& mission,
                                                 const TeamObserver& watcher = {});

struct FormationSeries {
  std::string faults = "none";
  std::uint64_t first_seed = 1;
  std::size_t runs = 1;
  std::size_t jobs = 1;  ///< threads, each flying one mission at a time
};
/// In the order of seeds, whatever `jobs` is. `on_done` is called from one thread at a time.
[[nodiscard]] Result<std::vector<FormationRun>> fly_formations(
    const configuration::Scenario& scenario, const FormationSeries& series,
    const std::function<void(const FormationRun&)>& on_done = {});

}  // namespace skein::hil
