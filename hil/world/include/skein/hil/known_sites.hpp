// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <vector>

#include "skein/domain/site.hpp"
#include "skein/mission/events.hpp"

namespace skein::hil {

/// Whose programs have heard of which site, and which are done.
class KnownSites {
 public:
  void on_event(const mission::MissionEvent& event);
  void on_told(SiteId site, VehicleId vehicle) { knowing_[site].insert(vehicle); }
  /// Its program ends. Which of the sites, not done yet, nobody has heard of any more.
  [[nodiscard]] std::vector<Site> on_program_end(VehicleId vehicle, const std::vector<Site>& sites);

  [[nodiscard]] bool done(SiteId site) const { return done_.contains(site); }
  [[nodiscard]] std::set<VehicleId> knowing(SiteId site) const;

 private:
  std::map<SiteId, std::set<VehicleId>> knowing_;
  std::set<SiteId> done_;
};

}  // namespace skein::hil
