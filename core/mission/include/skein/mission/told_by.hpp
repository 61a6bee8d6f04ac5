// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "skein/base/ids.hpp"
#include "skein/mission/messages.hpp"

namespace skein::mission {

/// Who passes on what the ground station or a sensor has said, to who has started anew; none (0)
/// for what is said first hand.
[[nodiscard]] inline VehicleId told_by(const Message& message) {
  if (const auto* site = std::get_if<SiteReport>(&message)) return site->told_by;
  if (const auto* hazard = std::get_if<HazardReport>(&message)) return hazard->told_by;
  if (const auto* command = std::get_if<Command>(&message)) return command->told_by;
  return kGroundStation;
}

}  // namespace skein::mission
