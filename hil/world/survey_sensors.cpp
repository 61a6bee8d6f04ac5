// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/survey_sensors.hpp"

#include <algorithm>
#include <utility>

namespace skein::hil {

SurveySensors::SurveySensors(std::vector<Site> sites, std::vector<VehicleSpec> vehicles)
    : hidden_{std::move(sites)}, vehicles_{std::move(vehicles)} {
  std::erase_if(vehicles_,
                [](const VehicleSpec& v) { return !v.capabilities.has(TaskKind::survey); });
  std::sort(vehicles_.begin(), vehicles_.end(),
            [](const VehicleSpec& a, const VehicleSpec& b) { return a.id < b.id; });
}

std::vector<mission::SiteReport> SurveySensors::update(const std::map<VehicleId, Vec2>& positions) {
  std::vector<mission::SiteReport> reports;
  std::erase_if(hidden_, [&](const Site& site) {
    for (const auto& vehicle : vehicles_) {
      const auto at = positions.find(vehicle.id);
      if (at == positions.end()) continue;
      if ((at->second - site.position).norm() > vehicle.sensor_radius_m) continue;
      reports.push_back({vehicle.id, site});
      return true;
    }
    return false;
  });
  return reports;
}

}  // namespace skein::hil
