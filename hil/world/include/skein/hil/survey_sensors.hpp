// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <vector>

#include "skein/base/geometry.hpp"
#include "skein/domain/site.hpp"
#include "skein/domain/vehicle.hpp"
#include "skein/mission/messages.hpp"

namespace skein::hil {

/// The survey sensors of the whole team: a site is found once, by the first vehicle with survey
/// capability that comes within its sensor radius (the lower id when two do at one moment).
class SurveySensors {
 public:
  SurveySensors(std::vector<Site> sites, std::vector<VehicleSpec> vehicles);

  /// What is found at these positions (mission frame); a vehicle without one finds nothing.
  [[nodiscard]] std::vector<mission::SiteReport> update(const std::map<VehicleId, Vec2>& positions);

  /// They can be found anew.
  void hide(const std::vector<Site>& sites) {
    hidden_.insert(hidden_.end(), sites.begin(), sites.end());
  }
  /// The sites that nobody has found yet.
  [[nodiscard]] const std::vector<Site>& hidden() const { return hidden_; }

 private:
  std::vector<Site> hidden_;
  std::vector<VehicleSpec> vehicles_;  ///< those that can survey, by id
};

}  // namespace skein::hil
