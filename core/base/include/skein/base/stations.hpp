// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "skein/base/ids.hpp"

/// Where a mission has several ground stations, each has a number of its own, from 1 up, and by it
/// the id of a node under which it listens and says nothing that anybody acts on. Who has the
/// command speaks as kGroundStation. Vehicles have none of these ids.
namespace skein {

inline constexpr std::uint16_t kStationsMax = 99;
inline constexpr VehicleId kFirstStation{65001};

[[nodiscard]] constexpr VehicleId station_node(std::uint16_t number) {
  return VehicleId{static_cast<std::uint16_t>(kFirstStation.value + number - 1)};
}
[[nodiscard]] constexpr bool is_station(VehicleId node) {
  return node >= kFirstStation && node <= station_node(kStationsMax);
}
/// Precondition: is_station().
[[nodiscard]] constexpr std::uint16_t station_number(VehicleId node) {
  return static_cast<std::uint16_t>(node.value - kFirstStation.value + 1);
}

}  // namespace skein
