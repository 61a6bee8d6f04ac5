// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "skein/configuration/ground_config.hpp"
#include "skein/configuration/vehicle_config.hpp"

namespace skein::configuration {

/// A key whose value differs between two configurations, as people find it in the files:
/// "origin.latitude_deg", "network.peers[3].port" (by id, where the elements have one,
/// otherwise counted from 1).
struct Difference {
  std::string key;
  std::string first;   ///< empty: not there
  std::string second;  ///< empty: not there
  friend bool operator==(const Difference&, const Difference&) = default;
};

/// By value, in the order of the files' keys.
[[nodiscard]] std::vector<Difference> differences(const VehicleConfig& first,
                                                  const VehicleConfig& second);
[[nodiscard]] std::vector<Difference> differences(const GroundConfig& first,
                                                  const GroundConfig& second);

}  // namespace skein::configuration
