// SPDX-License-Identifier: Apache-2.0
#include "skein/ardupilot/autopilot_facts.hpp"

#include <algorithm>

#include "skein/mavlink/enums.hpp"
#include "troubles.hpp"

namespace skein::ardupilot {

bool AutopilotFacts::take(const mavlink::Packet& packet, Instant now) {
  const auto is = [&packet]<class Message>(std::optional<Message>& told) {
    const auto message = mavlink::decode<Message>(packet);
    if (message) told = *message;
    return message.has_value();
  };
  if (is(time)) {
    time_at = now;
    return true;
  }
  if (const auto version = mavlink::decode<mavlink::AutopilotVersion>(packet)) {
    firmware = version->flight_sw_version;
    return true;
  }
  return is(heartbeat) || is(health) || is(gnss) || is(filter) || is(landed);
}

bool AutopilotFacts::prearm_good() const {
  if (!health) return false;
  return (health->onboard_control_sensors_enabled & ~health->onboard_control_sensors_health &
          mavlink::sensor_prearm_check) == 0;
}

std::uint8_t AutopilotFacts::battery_percent() const {
  if (!health || (health->onboard_control_sensors_enabled & mavlink::sensor_battery) == 0) {
    return kBatteryNotTold;
  }
  const int percent{health->battery_remaining};  // -1: no capacity is set
  if (percent < 0 || percent > kBatteryFull_percent) return kBatteryNotTold;
  return static_cast<std::uint8_t>(percent);
}

bool AutopilotFacts::only_mode_forbids_arming() const {
  return !pre_arm.empty() && std::ranges::all_of(pre_arm, PreArmTexts::is_of_mode);
}

}  // namespace skein::ardupilot
