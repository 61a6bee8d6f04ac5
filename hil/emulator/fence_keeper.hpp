// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "earth.hpp"
#include "skein/domain/fence.hpp"
#include "skein/mavlink/enums.hpp"
#include "skein/mavlink/messages.hpp"
#include "vehicle.hpp"

namespace skein::hil {

/// The autopilot's own fence: one polygon to stay within, and a height above home.
class FenceKeeper {
 public:
  /// `height_max_m`: FENCE_ALT_MAX; 0: FENCE_ENABLE is 0.
  explicit FenceKeeper(double height_max_m) { fence_.height_max_m = height_max_m; }
  [[nodiscard]] bool enabled() const { return fence_.height_max_m > 0.0; }
  /// Takes the place of the one before.
  [[nodiscard]] mavlink::MissionResult load(std::span<const mavlink::MissionItemInt> items,
                                            const Earth& earth);
  /// As ArduPilot says it, once: from when an armed aircraft in flight is outside, until it is
  /// inside again.
  [[nodiscard]] std::optional<std::string_view> news(const FlightReport& report);

 private:
  Fence fence_;  ///< corners by east and north
  bool breached_ = false;
};

}  // namespace skein::hil
