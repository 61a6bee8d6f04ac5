// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "aircraft.hpp"
#include "skein/hil/known_sites.hpp"
#include "skein/hil/survey_sensors.hpp"
#include "skein/hil/team_simulator.hpp"

namespace skein::hil {

/// Who finds which site. A site that is not done is hidden again when the last program that had
/// heard of it ends.
class SiteFinder {
 public:
  explicit SiteFinder(const TeamMission& mission);

  struct Found {
    std::size_t vehicle = 0;  ///< index
    mission::SiteReport report;
  };
  /// What the sensors see now.
  [[nodiscard]] std::vector<Found> look(const std::vector<Aircraft>& vehicles);
  /// The sites whose time to be reported has come (TeamMission::reported), and those that nobody
  /// could be told of in report_all(): each to the nearest vehicle that can survey it and is free.
  [[nodiscard]] std::vector<Found> report_due(const std::vector<Aircraft>& vehicles, Instant now);
  /// Every site that is hidden still is reported, each to the nearest vehicle that can survey it;
  /// to different ones as long as there are some.
  [[nodiscard]] std::vector<Found> report_all(const std::vector<Aircraft>& vehicles);

  void on_event(const mission::MissionEvent& event) { known_.on_event(event); }
  void on_agent_end(std::size_t vehicle);

 private:
  [[nodiscard]] std::vector<Site> unattended(const std::vector<Aircraft>& vehicles) const;
  Found found(std::size_t vehicle, const Site& site);

  const TeamMission& mission_;
  std::vector<VehicleSpec> specs_;
  SurveySensors sensors_;
  std::vector<Site> to_report_;  ///< as soon as somebody can be told
  KnownSites known_;
};

}  // namespace skein::hil
