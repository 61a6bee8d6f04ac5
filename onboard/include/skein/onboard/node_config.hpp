// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "skein/configuration/vehicle_config.hpp"
#include "skein/mission/vehicle_node.hpp"

namespace skein::onboard {

/// The node of the vehicle that the configuration describes; `route` is
/// configuration::timed_path(config.route, config.vehicle). Whoever makes it of the same gets one
/// that decides and says the same: the process, and its re-execution. `program` is its name and its
/// version.
[[nodiscard]] mission::VehicleNodeConfig node_config(const configuration::VehicleConfig& config,
                                                     const std::optional<TimedPath>& route,
                                                     InstanceId instance, std::string program);

}  // namespace skein::onboard
