// SPDX-License-Identifier: Apache-2.0
#include "site_reports.hpp"

#include <algorithm>

#include "skein/mission/ground_sites.hpp"

namespace skein::hil {

bool is_barred(const mission::Telemetry& telemetry) {
  const mission::ActivityDetail does = telemetry.detail;
  return does == mission::ActivityDetail::barred;
}

std::vector<VehicleId> having(const SiteReports::Team& team, Role role) {
  std::vector<VehicleId> some;
  for (const auto& [id, telemetry] : team) {
    if (has_role(telemetry.activity, role)) some.push_back(id);
  }
  return some;
}

std::vector<mission::SiteReport> SiteReports::look(const Team& team) {
  std::map<VehicleId, Vec2> positions;
  for (const auto& [id, telemetry] : team) {
    positions.emplace(id, telemetry.state.position().horizontal());
  }
  auto reports = sensors_.update(positions);
  for (const auto& report : reports) known_.on_told(report.site.id, report.finder);
  return reports;
}

std::vector<mission::SiteReport> SiteReports::report_unattended(const Team& team) {
  std::vector<mission::SiteReport> reports;
  // As the ground station, to nobody that its pilot has, or that is on its way home.
  const auto attends = [&team](VehicleId id) {
    const auto at = team.find(id);
    return at != team.end() && !is_barred(at->second) &&
           mission::can_be_told_of_sites(at->second.activity);
  };
  for (const Site& site : sites_) {
    if (answered_.done(site.id) || std::ranges::any_of(answered_.knowing(site.id), attends)) {
      continue;
    }
    const VehicleSpec* nearest = nullptr;
    double least_m = 0.0;
    for (const VehicleSpec& vehicle : vehicles_) {
      if (!attends(vehicle.id) || !vehicle.capabilities.has(TaskKind::survey)) continue;
      const double away_m =
          (team.at(vehicle.id).state.position().horizontal() - site.position).norm();
      if (nearest != nullptr && away_m >= least_m) continue;
      nearest = &vehicle;
      least_m = away_m;
    }
    if (nearest != nullptr) reports.push_back({nearest->id, site});
  }
  for (const auto& report : reports) known_.on_told(report.site.id, report.finder);
  return reports;
}

}  // namespace skein::hil
