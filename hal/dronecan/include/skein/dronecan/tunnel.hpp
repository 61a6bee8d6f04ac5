// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "skein/base/time.hpp"
#include "skein/dronecan/node.hpp"

namespace skein::dronecan {

/// A ring of bytes with a fixed capacity.
class ByteRing {
 public:
  explicit ByteRing(std::size_t capacity) : bytes_(capacity) {}
  /// As many as there is room for; returns how many.
  std::size_t push(std::span<const std::uint8_t> bytes);
  std::size_t pop(std::span<std::uint8_t> out);
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::size_t room() const { return bytes_.size() - size_; }

 private:
  std::vector<std::uint8_t> bytes_;
  std::size_t first_ = 0;
  std::size_t size_ = 0;
};

struct TunnelParams {
  std::uint8_t remote_node = 10;
  std::int8_t serial_id = 0;  ///< -16..15
  TunnelProtocol protocol = TunnelProtocol::mavlink2;
  std::uint32_t baudrate = 115200;
  std::uint8_t options = kLockPort;
  std::uint8_t priority = kPriorityMedium;
  Duration keepalive = std::chrono::milliseconds{500};  ///< an empty transfer after this silence
  /// Take only what names this node as its target. ArduPilot 4.6 does not look at it.
  bool check_target = true;
  std::size_t buffer_bytes = 4096;  ///< each way
  std::size_t chunk = 120;          ///< bytes a transfer; more than 120 are dropped by an ArduPilot
};

struct TunnelStatistics {
  std::uint64_t bytes_sent = 0;
  std::uint64_t bytes_received = 0;
  std::uint64_t transfers_sent = 0;
  std::uint64_t transfers_received = 0;
  std::uint64_t bytes_overflowed = 0;  ///< received, dropped because nobody read
  std::uint64_t misaddressed = 0;      ///< transfers of the remote node for another target
};

/// A stream of bytes, both ways, to a serial port of another node over uavcan.tunnel.Targetted.
/// Nothing is acknowledged or sent again: a transfer that is lost is a hole in the stream.
class TunnelPort {
 public:
  TunnelPort(const TunnelParams& params, Instant now);

  /// All of the bytes, or none when there is no room: then false.
  [[nodiscard]] bool write(std::span<const std::uint8_t> bytes);
  /// Returns how many were read.
  std::size_t read(std::span<std::uint8_t> out) { return incoming_.pop(out); }
  [[nodiscard]] std::size_t unsent() const { return outgoing_.size(); }

  /// A transfer that the node has received; others than this port's are not looked at.
  void on_transfer(const Transfer& transfer, std::uint8_t own_node, Instant now);
  /// Hands what was written, and the keepalive when it is due, to the node.
  void step(Node& node, Instant now);
  [[nodiscard]] Instant next_timeout() const;

  /// When the other end was last heard on this port, keepalives included.
  [[nodiscard]] std::optional<Instant> heard() const { return heard_; }
  [[nodiscard]] const TunnelStatistics& statistics() const { return statistics_; }

 private:
  TunnelParams params_;
  ByteRing outgoing_;
  ByteRing incoming_;
  Instant keepalive_at_;
  std::optional<Instant> heard_;
  TunnelStatistics statistics_;
};

}  // namespace skein::dronecan
