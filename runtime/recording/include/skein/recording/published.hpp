// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "skein/mission/messages.hpp"

namespace skein::recording {

/// A message as it stands in a recording, for whoever shows the same to others while it happens.
struct Published {
  std::string topic;                ///< "/vehicle_07/telemetry"
  std::string_view schema_name;     ///< "skein/msg/Telemetry"
  std::string_view schema;          ///< ros2msg; both for the life of the program
  std::vector<std::uint8_t> bytes;  ///< CDR
};

/// None for a message that cannot be sent, for a value out of its range.
[[nodiscard]] std::optional<Published> published(const mission::Message& message, VehicleId sender);

}  // namespace skein::recording
