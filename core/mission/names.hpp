// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "skein/base/ids.hpp"

/// How sentences for people name things.
namespace skein::mission {

[[nodiscard]] inline std::string name_of(VehicleId vehicle) {
  return "vehicle " + std::to_string(vehicle.value);
}
[[nodiscard]] inline std::string name_of(SiteId site) {
  return "site " + std::to_string(site.value);
}

}  // namespace skein::mission
