// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>

namespace skein {

/// A number that is only equal to numbers of its own kind.
template <class Tag, class Rep>
struct Id {
  Rep value = 0;
  friend constexpr auto operator<=>(const Id&, const Id&) = default;
};

/// A node of the mission network, as the operator numbered it: vehicles are 1 and up.
using VehicleId = Id<struct VehicleTag, std::uint16_t>;
/// Made at random when a process starts: two processes with one VehicleId differ in it.
using InstanceId = Id<struct InstanceTag, std::uint64_t>;
using SiteId = Id<struct SiteTag, std::uint16_t>;
using HazardId = Id<struct HazardTag, std::uint16_t>;

inline constexpr VehicleId kGroundStation{0};

}  // namespace skein
