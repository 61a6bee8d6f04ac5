// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "skein/ros2/messages.hpp"
#include "skein/ros2/type_info.hpp"

namespace skein::ros2 {

/// How a topic is published, as users of ROS 2 expect it.
enum class Quality : std::uint8_t {
  sensor,  ///< what was measured: best effort, the newest five
  state,   ///< reliable and transient local: who comes late has the newest one
  history  ///< the same, with the newest kHistoryDepth
};
inline constexpr int kHistoryDepth = 100;

/// One message on its way.
struct Publication {
  std::string topic;  ///< below the namespace, as "vehicle_3/fix"
  TypeInfo type;
  Quality quality{};
  std::vector<std::uint8_t> bytes;  ///< CDR with its header
};

}  // namespace skein::ros2
