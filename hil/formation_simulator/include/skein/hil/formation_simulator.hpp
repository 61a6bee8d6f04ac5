// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "skein/base/attitude.hpp"
#include "skein/base/result.hpp"
#include "skein/configuration/formation_config.hpp"
#include "skein/configuration/scenario.hpp"
#include "skein/hil/fault.hpp"
#include "skein/hil/radio/radio_model.hpp"
#include "skein/mission/messages.hpp"

/// A team of multirotors in formation, in virtual time and with faults: the production agents and
/// ground station, a radio between them, and bodies that follow their references as well as gusts
/// let them. Judged by code that knows the bodies only.
namespace skein::hil {

struct FormationVehicle {
  VehicleId id;
  Vec3 start = Vec3::Zero();  ///< on the ground
};

struct FormationMission {
  std::uint64_t seed = 1;
  std::vector<FormationVehicle> vehicles;    ///< in the order of their numbers
  configuration::FormationConfig formation;  ///< with the script that is flown
  radio::RadioParams radio;
  /// Of how far gusts push a body from its reference, per axis; never beyond 0.3 m.
  double gust_error_m = 0.05;
  std::vector<Fault> faults;
};

/// The scenario's formation with this seed, and the faults of its time line. With more faults the
/// shapes, the gusts and what goes wrong are drawn too; with "none" the scenario's script is flown.
[[nodiscard]] Result<FormationMission> formation_mission(const configuration::Scenario& scenario,
                                                         std::uint64_t seed,
                                                         const std::string& faults);

struct FormationViolation {
  Instant time{};
  std::string check;  ///< separation, ceiling, tracking, liveness
  std::string sentence;
};

struct FormationRun {
  std::uint64_t seed = 0;
  std::vector<FormationViolation> violations;  ///< the first of each check and pair
  bool script_done = false;
  std::string reason;          ///< where it is not: why the team holds
  double least_m = 0.0;        ///< of any two bodies in the air, heights stretched, continuous time
  double farthest_m = 0.0;     ///< of any body from its reference
  std::size_t changes = 0;     ///< that were begun
  std::size_t lost = 0;        ///< vehicles, for good
  std::uint64_t messages = 0;  ///< sent, counted once for each sender
  Instant ended_at{};
  [[nodiscard]] bool held() const { return violations.empty(); }
};

struct FormationObserver {
  std::function<void(const mission::MissionEvent&)> event;
  std::function<void(Instant, const std::string&)> fault;
  /// Of every body, at every control step.
  std::function<void(Instant, VehicleId, const Vec3& position_m)> body;
};

/// Flies it in the calling thread, until the script is done or nobody moves any more. The same
/// mission gives the same bytes. Fails where the script cannot be read.
[[nodiscard]] Result<FormationRun> fly_formation(const FormationMission& mission,
                                                 const FormationObserver& observer = {});

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
