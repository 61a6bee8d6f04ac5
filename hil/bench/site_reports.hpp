// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <vector>

#include "skein/configuration/scenario.hpp"
#include "skein/hil/fault.hpp"
#include "skein/hil/known_sites.hpp"
#include "skein/hil/survey_sensors.hpp"
#include "skein/mission/messages.hpp"

namespace skein::hil {

/// It holds, by its own word, until it may work with the others.
[[nodiscard]] bool is_barred(const mission::Telemetry& telemetry);

/// Which sites the team is told of: by its sensors, and, once the radio has healed, by somebody who
/// reports those that nobody is at work on. As the simulator's finder, by what is heard.
class SiteReports {
 public:
  /// Who is there, and takes part, by what it has told last.
  using Team = std::map<VehicleId, mission::Telemetry>;

  explicit SiteReports(const configuration::Scenario& scenario)
      : sites_{scenario.sites}, vehicles_{specs(scenario)}, sensors_{sites_, vehicles_} {}

  void on_event(const mission::MissionEvent& event) {
    known_.on_event(event);
    answered_.on_event(event);
  }
  /// A site that nobody else has heard of can be found anew.
  void on_program_end(VehicleId vehicle) {
    sensors_.hide(known_.on_program_end(vehicle, sites_));
    static_cast<void>(answered_.on_program_end(vehicle, sites_));
  }
  [[nodiscard]] std::vector<mission::SiteReport> look(const Team& team);
  /// Of what nobody there knows who takes part and is not held, each to the nearest that can
  /// survey; again until one has said that it knows.
  [[nodiscard]] std::vector<mission::SiteReport> report_unattended(const Team& team);

 private:
  static std::vector<VehicleSpec> specs(const configuration::Scenario& scenario) {
    std::vector<VehicleSpec> all;
    for (const auto& v : scenario.vehicles) all.push_back(v.spec);
    return all;
  }

  std::vector<Site> sites_;
  std::vector<VehicleSpec> vehicles_;
  SurveySensors sensors_;
  KnownSites known_;     ///< by what they were told, too
  KnownSites answered_;  ///< by their own words
};

/// Those of them that have the role.
[[nodiscard]] std::vector<VehicleId> having(const SiteReports::Team& team, Role role);

}  // namespace skein::hil
