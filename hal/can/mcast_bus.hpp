// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "skein/can/bus.hpp"

namespace skein::can {

/// Bus `index` of the group 239.65.82.0/24, over `interface`.
[[nodiscard]] Result<std::unique_ptr<Bus>> open_mcast(const std::string& name, std::uint8_t index,
                                                      const std::string& interface,
                                                      const BusOptions& options);

}  // namespace skein::can
