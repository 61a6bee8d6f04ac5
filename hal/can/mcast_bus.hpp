// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include "skein/can/bus.hpp"

namespace skein::can {

/// Names of multicast buses begin with it.
inline constexpr std::string_view kMcast = "mcast:";
/// That of "mcast:NUMBER@INTERFACE"; loopback where none is named.
[[nodiscard]] inline std::string interface_in(const std::string& mcast_name) {
  const std::size_t at = mcast_name.find('@');
  return at == std::string::npos ? "lo" : mcast_name.substr(at + 1);
}

/// Bus `index` of the group 239.65.82.0/24, over `interface`.
[[nodiscard]] Result<std::unique_ptr<Bus>> open_mcast(const std::string& name, std::uint8_t index,
                                                      const std::string& interface,
                                                      const BusOptions& options);

}  // namespace skein::can
