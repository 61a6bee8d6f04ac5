// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

/// Versions of firmware as AUTOPILOT_VERSION tells them.
namespace skein::ardupilot {

/// "4.6.3".
[[nodiscard]] inline std::string firmware_text(std::uint32_t version) {
  return std::to_string(version >> 24U) + "." + std::to_string((version >> 16U) & 0xFFU) + "." +
         std::to_string((version >> 8U) & 0xFFU);
}
/// 4.5 is the first with the tunnel.
[[nodiscard]] constexpr bool firmware_is_new_enough(std::uint32_t version) {
  constexpr std::uint32_t kMin = 0x0405;
  return (version >> 16U) >= kMin;
}

}  // namespace skein::ardupilot
