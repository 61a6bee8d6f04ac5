// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <map>

#include "skein/mission/messages.hpp"
#include "skein/mission/told_by.hpp"

namespace skein::mission {

/// Beside the orders (OrderBook), what a program that starts anew has to be told again, by vehicles
/// where the ground station is not in reach: hazards that are there, and sites that nobody is to go
/// on with. That a hazard is gone nobody passes on: who has not heard of it keeps clear of nothing.
class ToldBook {
 public:
  static constexpr std::size_t kHazardsMax = 256;
  static constexpr std::size_t kSitesMax = 256;

  /// What was heard first hand. It passes over what is nothing of this kind.
  void note(const Message& message) {
    if (told_by(message) != kGroundStation) return;
    if (const auto* hazard = std::get_if<HazardReport>(&message)) {
      const HazardId id = hazard->hazard.id;
      const auto known = hazards_.find(id);
      if (known == hazards_.end()) {
        if (hazards_.size() < kHazardsMax) hazards_.emplace(id, *hazard);
      } else if (!known->second.withdrawn) {  // late copies bring none back
        known->second = *hazard;
      }
    } else if (const auto* site = std::get_if<SiteReport>(&message)) {
      if (site->withdrawn && sites_.size() < kSitesMax) sites_.emplace(site->site.id, *site);
    }
  }

  /// All of it, as it is passed on by `teller`: hazards first.
  [[nodiscard]] std::deque<Message> all(VehicleId teller) const {
    std::deque<Message> all;
    for (auto [id, hazard] : hazards_) {
      if (hazard.withdrawn) continue;
      hazard.told_by = teller;
      all.emplace_back(hazard);
    }
    for (auto [id, site] : sites_) {
      site.told_by = teller;
      all.emplace_back(site);
    }
    return all;
  }

 private:
  std::map<HazardId, HazardReport> hazards_;
  std::map<SiteId, SiteReport> sites_;
};

/// The same word, by whomever it is passed on.
[[nodiscard]] inline bool is_same_word(const Message& one, const Message& other) {
  const auto* site = std::get_if<SiteReport>(&one);
  const auto* other_site = std::get_if<SiteReport>(&other);
  if (site != nullptr && other_site != nullptr) return site->site.id == other_site->site.id;
  const auto* hazard = std::get_if<HazardReport>(&one);
  const auto* other_hazard = std::get_if<HazardReport>(&other);
  return hazard != nullptr && other_hazard != nullptr &&
         hazard->hazard.id == other_hazard->hazard.id &&
         hazard->hazard.centre == other_hazard->hazard.centre &&
         hazard->hazard.radius_m == other_hazard->hazard.radius_m;
}

}  // namespace skein::mission
