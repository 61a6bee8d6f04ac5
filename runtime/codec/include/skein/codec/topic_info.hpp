// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "skein/air/link.hpp"
#include "skein/base/time.hpp"

namespace skein::codec {

/// What a node is on the network. It decides which topics it writes and reads.
enum class Role : std::uint8_t { vehicle = 1, ground = 2 };

/// A set of roles.
struct Roles {
  bool vehicle = false;
  bool ground = false;
  [[nodiscard]] constexpr bool has(Role role) const {
    return role == Role::vehicle ? vehicle : ground;
  }
};
inline constexpr Roles kVehicles{true, false};
inline constexpr Roles kGround{false, true};
inline constexpr Roles kAll{true, true};

/// One topic with everything that DDS is told about it. Durability is volatile everywhere: nothing
/// old is sent to who joins; the protocols above repeat what is still of use.
struct TopicInfo {
  std::string_view name;
  std::string_view type;  ///< as DDS and tools know it
  std::uint16_t version;  ///< of the type
  Roles writers;
  Roles readers;
  bool reliable;  ///< resent until acknowledged, and in the sender's order
  air::Urgency urgency;
  std::int32_t writer_history;  ///< samples kept for resending; the oldest gives way, never blocks
  std::int32_t reader_history;  ///< samples kept while an earlier one is missing
  std::size_t size_max;         ///< of a message of this release, in bytes
};

/// Of reliable writers: a loss is repaired after about this.
inline constexpr Duration kHeartbeatPeriod = std::chrono::milliseconds{100};

}  // namespace skein::codec
