// SPDX-License-Identifier: Apache-2.0
#include "skein/autopilot/command.hpp"

#include <array>
#include <utility>

namespace skein::autopilot {

std::optional<std::string_view> arming_refusal(const Health& health) {
  const std::array<std::pair<bool, std::string_view>, 7> checks{{
      {health.gyros, "Gyros not healthy"},
      {health.accelerometers, "Accels not healthy"},
      {health.compass, "Compass not healthy"},
      {health.barometer, "Barometer not healthy"},
      {health.satellites, "GPS 1: Bad fix"},
      {health.position, "Need Position Estimate"},
      {health.battery, "Battery below minimum arming voltage"},
  }};
  for (const auto& [passes, reason] : checks) {
    if (!passes) return reason;
  }
  return std::nullopt;
}

void CompanionWatch::heard(Instant now) {
  last_ = now;
  lost_ = false;
}

bool CompanionWatch::lost_now(Instant now) {
  if (!enabled_ || lost_ || !last_ || now - *last_ < timeout_) return false;
  lost_ = true;
  return true;
}

}  // namespace skein::autopilot
