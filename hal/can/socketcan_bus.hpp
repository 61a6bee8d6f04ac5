// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "skein/can/bus.hpp"

namespace skein::can {

/// A SocketCAN interface of the kernel.
[[nodiscard]] Result<std::unique_ptr<Bus>> open_socketcan(const std::string& interface,
                                                          const BusOptions& options);

}  // namespace skein::can
