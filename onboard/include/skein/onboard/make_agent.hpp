// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "skein/base/ids.hpp"
#include "skein/configuration/vehicle_config.hpp"
#include "skein/domain/path.hpp"
#include "skein/mission/onboard_agent.hpp"

namespace skein::onboard {

/// The agent that the configuration describes: a multirotor flies in formation, a fixed wing in
/// coalitions. `route` is that of the configuration, timed.
[[nodiscard]] std::unique_ptr<mission::OnboardAgent> make_agent(
    const configuration::VehicleConfig& config, const std::optional<TimedPath>& route,
    InstanceId instance, Instant now);

}  // namespace skein::onboard
