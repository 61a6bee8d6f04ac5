// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "skein/ardupilot/can_link.hpp"
#include "skein/configuration/vehicle_config.hpp"

namespace skein::onboard {

/// Of the flight controller that the configuration describes.
[[nodiscard]] ardupilot::CanLinkParams can_params(const configuration::VehicleConfig& config);

}  // namespace skein::onboard
