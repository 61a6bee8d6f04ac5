// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "skein/base/time.hpp"
#include "skein/can/frame.hpp"
#include "skein/domain/autopilot_notice.hpp"
#include "skein/dronecan/transfer.hpp"

namespace skein::ardupilot {

/// Who is to talk to whom on a bus.
struct LinkIds {
  std::string bus;                      ///< its name, for people
  std::uint8_t node_id = 10;            ///< of the flight controller
  std::uint8_t companion_node_id = 42;  ///< ours
  std::int8_t serial_id = 0;
  std::uint8_t system_id = 1;
};

/// Tells why no autopilot is heard, by what is heard instead: the lowest of frames, its node, its
/// serial port over CAN and its HEARTBEAT that has been missing for so long. What lies above one
/// that is missing gets that time again once it is back.
class LinkWatch {
 public:
  /// An ArduPilot that restarts is on the bus for 4 s before it speaks MAVLink.
  static constexpr Duration kPatience = std::chrono::milliseconds{4500};

  LinkWatch(const LinkIds& ids, Instant now, Duration patience = kPatience);

  void on_frame(const can::Frame& frame, Instant now);
  void on_transfer(const dronecan::Transfer& transfer, Instant now);
  /// The node has restarted.
  void on_reboot(Instant now);
  /// HEARTBEAT of the autopilot of a system came, ours or another.
  void on_heartbeat(std::uint8_t system, Instant now);

  /// What is wrong with the link now. To be called at least every second: it passes the time on.
  [[nodiscard]] std::optional<AutopilotNotice> trouble(Instant now);

 private:
  enum Layer : std::uint8_t { frames, node, tunnel, heartbeat, layer_count };
  static constexpr std::size_t kNodes = 128;
  struct Served {  ///< whom a node's serial port is for
    std::uint8_t target = 0;
    std::int8_t serial_id = 0;
    Instant at;
  };

  [[nodiscard]] bool heard_lately(const std::optional<Instant>& at, Instant now) const {
    return at && now - *at < patience_;
  }
  [[nodiscard]] AutopilotNotice node_missing(Instant now) const;
  [[nodiscard]] AutopilotNotice tunnel_missing(Instant now) const;
  [[nodiscard]] AutopilotNotice heartbeat_missing(Instant now) const;

  LinkIds ids_;
  Duration patience_;
  std::array<Instant, layer_count> heard_;
  std::array<std::optional<Instant>, kNodes> nodes_;  ///< when each was heard
  std::array<std::optional<Served>, kNodes> served_;  ///< other ports than ours, by sender
  std::uint8_t other_system_ = 0;
  std::optional<Instant> other_system_at_;
};

}  // namespace skein::ardupilot
