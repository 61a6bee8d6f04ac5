// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "skein/ardupilot/companion.hpp"
#include "skein/can/bus.hpp"
#include "skein/dronecan/node.hpp"
#include "skein/dronecan/tunnel.hpp"

namespace skein::ardupilot {

class LinkWatch;

struct CanLinkParams {
  CompanionParams companion;
  std::uint8_t node_id = 10;            ///< of the flight controller: CAN_D1_UC_NODE
  std::uint8_t companion_node_id = 42;  ///< ours: CAN_D1_UC_S1_NOD
  std::int8_t serial_id = 0;            ///< of the tunnel: CAN_D1_UC_S1_IDX
};

/// A Companion on a CAN bus: a DroneCAN node with a unique id that depends on vehicle and node id
/// alone, and the tunnel that carries MAVLink. Never blocks. One thread at a time.
class CanLink {
 public:
  CanLink(std::unique_ptr<can::Bus> bus, const CanLinkParams& params, const MissionOrigin& origin,
          Instant now);
  ~CanLink();

  /// Takes what has come, decides, and sends. To be called when descriptor() is readable, and every
  /// 10 ms or so. Precondition: `now` never decreases.
  void step(Instant now);

  [[nodiscard]] Companion& companion() { return companion_; }
  [[nodiscard]] const Companion& companion() const { return companion_; }
  [[nodiscard]] const can::Bus& bus() const { return *bus_; }
  [[nodiscard]] const dronecan::ReassemblyStatistics& reassembly() const {
    return node_.reassembly();
  }
  /// Companion::facts(), and what is heard on the bus.
  [[nodiscard]] std::optional<AutopilotFacts> facts(Instant now) const;
  /// Transfers that the bus did not take. They are not kept: what is old is not to be flown.
  [[nodiscard]] std::uint64_t transfers_dropped() const { return transfers_dropped_; }

 private:
  void receive(Instant now);
  void on_transfer(const dronecan::Transfer& transfer, Instant now);
  void transmit(Instant now);
  void watch(Instant now);

  CanLinkParams params_;
  std::unique_ptr<can::Bus> bus_;
  dronecan::Node node_;
  dronecan::TunnelPort port_;
  Companion companion_;
  std::unique_ptr<LinkWatch> watch_;
  std::optional<std::uint32_t> uptime_s_;  ///< of the flight controller, as heard last
  std::uint64_t transfers_dropped_ = 0;
};

}  // namespace skein::ardupilot
