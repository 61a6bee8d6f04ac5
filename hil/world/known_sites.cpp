// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/known_sites.hpp"

#include <algorithm>
#include <iterator>

namespace skein::hil {

void KnownSites::on_event(const mission::MissionEvent& event) {
  if (event.kind() == mission::EventKind::site_done) done_.insert(event.task.site);
  // Whoever announces, bids or declines has heard of the site.
  if (event.vehicle != kGroundStation) on_told(event.task.site, event.vehicle);
}

std::vector<Site> KnownSites::on_program_end(VehicleId vehicle, const std::vector<Site>& sites) {
  std::vector<Site> forgotten;
  std::ranges::copy_if(sites, std::back_inserter(forgotten), [&](const Site& site) {
    auto& knowing = knowing_[site.id];
    return knowing.erase(vehicle) > 0 && knowing.empty() && !done(site.id);
  });
  return forgotten;
}

std::set<VehicleId> KnownSites::knowing(SiteId site) const {
  const auto known = knowing_.find(site);
  return known == knowing_.end() ? std::set<VehicleId>{} : known->second;
}

}  // namespace skein::hil
