// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "battery.hpp"
#include "skein/base/time.hpp"
#include "skein/mavlink/parser.hpp"
#include "vehicle.hpp"

namespace skein::hil {

/// What messages are made of.
struct Situation {
  const FlightReport& flight;
  const Earth& earth;
  const Battery& battery;
  mavlink::VehicleType type = mavlink::VehicleType::fixed_wing;
  Duration since_boot{};
  std::int64_t unix_us = 0;
  bool position = true;              ///< it knows where it is
  bool may_arm = false;              ///< the checks before arming pass
  Vec3 ekf_origin_m = Vec3::Zero();  ///< of the local position, NED of the mission's origin
};

/// What the aircraft really does, as a simulator tells it.
[[nodiscard]] mavlink::SimState sim_state(const FlightReport& flight, const Earth& earth);

/// The messages that can be streamed or asked for, by id.
[[nodiscard]] std::span<const std::uint32_t> telemetry_ids();
/// Of these, what ArduPlane streams at 1 Hz unasked.
[[nodiscard]] bool is_streamed_unasked(std::uint32_t id);
/// A packet, or nothing for a message that there is not. Numbered only where it is made.
[[nodiscard]] std::optional<mavlink::WireBytes> telemetry(std::uint32_t id,
                                                          mavlink::Encoder& encoder,
                                                          const Situation& situation);

}  // namespace skein::hil
