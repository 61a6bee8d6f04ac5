// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "skein/base/time.hpp"
#include "skein/domain/autopilot_notice.hpp"
#include "skein/domain/vehicle.hpp"
#include "skein/mavlink/messages.hpp"
#include "skein/mavlink/packet.hpp"

namespace skein::ardupilot {

/// A parameter as it was told: by its name or, where an autopilot has another, by that one.
struct TestedParameter {
  std::string name;
  std::optional<double> value;  ///< none: not told
  std::string finding;          ///< empty: it is good
  bool of_own_id = false;       ///< what is good is another number for each autopilot
};

/// What is on a bus, and what its autopilot says of itself.
struct AutopilotFacts {
  std::vector<std::uint8_t> nodes;         ///< heard, but ours
  std::uint64_t frames = 0;                ///< received
  bool own_id_taken = false;               ///< somebody sends with our node id: nothing was asked
  bool node_heard = false;                 ///< the flight controller's
  bool serial_heard = false;               ///< its serial port, for us
  std::optional<AutopilotNotice> trouble;  ///< of the link, the lowest that there is
  std::optional<mavlink::Heartbeat> heartbeat;
  std::optional<std::uint32_t> firmware;
  std::optional<mavlink::SysStatus> health;
  std::optional<mavlink::GpsRawInt> gnss;
  std::optional<mavlink::EkfStatusReport> filter;
  std::optional<mavlink::SystemTime> time;
  Instant time_at;  ///< when it came
  std::optional<mavlink::ExtendedSysState> landed;
  std::vector<TestedParameter> safety;  ///< that nothing is flown without (parameter_check.hpp)
  std::map<std::string, double> parameters;  ///< the others, as far as they were told
  std::vector<std::string> pre_arm;          ///< why it would not arm
  /// Of what says a Remote ID: why it does not; empty: it does.
  std::optional<std::string> remote_id;
  /// Armed or in the air, and not only waiting on the ground for who flies it.
  bool in_flight = false;

  /// What the autopilot says of itself in a message of its own; false: that is another one.
  bool take(const mavlink::Packet& packet, Instant now);
  /// Told, and it would arm or is not asked to look.
  [[nodiscard]] bool prearm_good() const;
  /// What SYS_STATUS has of the first battery; kBatteryNotTold where it is not measured.
  [[nodiscard]] std::uint8_t battery_percent() const;
  /// It would arm in another mode, into which a companion that launches it puts it.
  [[nodiscard]] bool only_mode_forbids_arming() const;
};

}  // namespace skein::ardupilot
