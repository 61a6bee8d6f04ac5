// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "skein/base/result.hpp"
#include "skein/ros2/console_client.hpp"
#include "skein/ros2/ros_node.hpp"

namespace skein::ros2 {

struct BridgeConfig {
  ConsoleClient::Config console;
  RosNodeConfig node;
  /// Where the ground station takes markers (agencies.markers); none: proposals are dropped.
  std::optional<Place> markers{};
};

/// Why it cannot be run so.
[[nodiscard]] Result<void> check(const BridgeConfig& config);

/// Runs until SIGINT or SIGTERM. Call it once, from a process without other threads. Gives the exit
/// code: 0, or process::kExitCannotStart with the reason in the log.
[[nodiscard]] int run(const BridgeConfig& config);

}  // namespace skein::ros2
