// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "skein/ardupilot/can_link.hpp"
#include "skein/base/result.hpp"
#include "skein/configuration/vehicle_config.hpp"

namespace skein::onboard {

/// Of the flight controller that the configuration describes; `unix_us` is system time at
/// Instant{}. Fails where its signing key cannot be read.
[[nodiscard]] Result<ardupilot::CanLinkParams> can_params(
    const configuration::VehicleConfig& config, std::int64_t unix_us);

}  // namespace skein::onboard
