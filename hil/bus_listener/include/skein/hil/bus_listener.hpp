// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "skein/can/frame.hpp"
#include "skein/dronecan/transfer.hpp"
#include "skein/mavlink/parser.hpp"

namespace skein::hil {

/// The bytes that a node sends through uavcan.tunnel.Targetted to a port of another.
struct TunnelStream {
  std::uint8_t source = 0;
  std::uint8_t target = 0;
  std::int8_t serial_id = 0;
  friend auto operator<=>(const TunnelStream&, const TunnelStream&) = default;
};

/// Listens to a bus as a person does: tells what each frame completed, as lines to read, and
/// counts.
class BusListener {
 public:
  /// What the frame completed: a line for a transfer of DroneCAN or an error frame, then one for
  /// each packet of MAVLink in it. Most frames complete nothing. Times are those of the frames.
  [[nodiscard]] std::vector<std::string> on_frame(const can::Frame& frame);

  [[nodiscard]] std::uint64_t frames() const { return frames_; }
  [[nodiscard]] const dronecan::ReassemblyStatistics& reassembly() const {
    return reassembler_.statistics();
  }
  /// MAVLink in each tunnel.
  [[nodiscard]] std::map<TunnelStream, mavlink::ParserStatistics> tunnels() const;
  /// What was counted, a line for DroneCAN and one for each tunnel.
  [[nodiscard]] std::string summary() const;

 private:
  void on_tunnel(const dronecan::Transfer& transfer, std::vector<std::string>& lines);

  dronecan::Reassembler reassembler_;
  std::map<TunnelStream, mavlink::Parser> tunnels_;
  Instant now_;
  std::uint64_t frames_ = 0;
};

}  // namespace skein::hil
