// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "skein/ardupilot/companion.hpp"

namespace skein::ardupilot {

/// HEARTBEAT's custom_mode, by airframe.
[[nodiscard]] std::uint32_t guided_mode(Airframe airframe);
/// In which the aircraft leaves the ground.
[[nodiscard]] std::uint32_t takeoff_mode(Airframe airframe);
/// A copter comes down where it is; a plane flies its mission.
[[nodiscard]] std::uint32_t land_mode(Airframe airframe);
/// RTL
[[nodiscard]] bool is_return(Airframe airframe, std::uint32_t mode);
/// "GUIDED"; the number of one that has no name here.
[[nodiscard]] std::string name_of_mode(Airframe airframe, std::uint32_t mode);
/// Whether HEARTBEAT's `type` is of the airframe.
[[nodiscard]] bool is_of(Airframe airframe, std::uint8_t vehicle_type);

}  // namespace skein::ardupilot
