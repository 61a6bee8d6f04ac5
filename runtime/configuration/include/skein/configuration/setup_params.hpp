// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "skein/configuration/ground_config.hpp"
#include "skein/configuration/vehicle_config.hpp"
#include "skein/mission/setup_book.hpp"

namespace skein::configuration {

/// The program, as far as others must have the same.
struct Release {
  std::string version;
  std::string wire;  ///< codec::wire_versions()
};

/// What every node of a team must have in common: origin, time, protocol, planning, what formations
/// keep to, and the release. Of two configurations that are rendered from one scenario it is equal.
[[nodiscard]] mission::SetupParams setup_params(const VehicleConfig& config,
                                                const Release& release);
[[nodiscard]] mission::SetupParams setup_params(const GroundConfig& config, const Release& release);

}  // namespace skein::configuration
