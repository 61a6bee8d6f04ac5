// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace skein::ros2 {

/// What ROS 2 calls a type of messages.
struct TypeInfo {
  std::string_view name;      ///< skein_msgs/msg/Event
  std::string_view dds_name;  ///< skein_msgs::msg::dds_::Event_
  std::string_view hash;      ///< REP-2011: RIHS01_ and 64 hex digits
};

}  // namespace skein::ros2
