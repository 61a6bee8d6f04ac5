// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "carrier.hpp"

/// What a node and the process that carries its network tell each other, a datagram each: a byte
/// for the kind, then its fields, little endian. Both are of one program, so there is no version.
/// What is read is bounded before memory is taken: a process that parses a stranger's bytes may
/// be a stranger's.
namespace skein::network {

/// No datagram is longer: a configuration of all peers that there may be, and not the longest
/// message of the mission.
inline constexpr std::size_t kCarrierMessageBytesMax = std::size_t{128} * 1024;
inline constexpr std::size_t kCarrierPeersMax = 4096;
inline constexpr std::size_t kCarrierTextMax = 1000;
/// Certificates and key changes, whose own readers judge them.
inline constexpr std::size_t kCarrierBlobMax = 2048;
static_assert(identity::kCertificateBytesMax <= kCarrierBlobMax);
static_assert(identity::kChangeBytesMax + kNewsSenderBytes <= kCarrierBlobMax);

// --- to the carrier: CarrierConfig first, then these -------------------------------------------

struct WriteSample {
  codec::Topic topic = codec::Topic::count;
  std::span<const std::uint8_t> bytes;
};
struct Ping {
  std::uint32_t number = 0;
  std::uint64_t counters_end = 0;  ///< of its seal
};
struct ChangeKey {
  seal::EpochKey key;
  Duration old_for{};
};
/// All that was to be told until now is not.
struct ForgetNews {};
struct TellNews {
  KeyNews news;
  bool is_last = false;  ///< told from now on, with all before it
};
using ToCarrier = std::variant<CarrierConfig, WriteSample, Ping, ChangeKey, ForgetNews, TellNews>;

// --- from the carrier: Joined or Refused first, then the rest ----------------------------------

struct Joined {
  std::string unconfined;  ///< why it could not give up all of its rights; empty: it has
};
struct Refused {
  std::string why;
};
/// It ends itself, since a thread of it does not get on.
struct Stuck {};
struct HeardSample {
  codec::Topic topic = codec::Topic::count;
  VehicleId sender;
  InstanceId instance;
  std::span<const std::uint8_t> bytes;
};
struct HeardCertificate {
  std::span<const std::uint8_t> bytes;
};
struct HeardNews {
  std::span<const std::uint8_t> bytes;
};
struct PeersNow {
  std::vector<Peer> peers;
};
struct ReceptionsNow {
  std::vector<Reception> receptions;
};
struct Pong {
  std::uint32_t number = 0;
  std::uint64_t next_counter = 0;
  CarrierCounts counts{};
};
using FromCarrier = std::variant<Joined, Refused, Stuck, HeardSample, HeardCertificate, HeardNews,
                                 PeersNow, ReceptionsNow, Pong>;

/// Precondition: it is within the limits above.
[[nodiscard]] std::vector<std::uint8_t> to_bytes(const ToCarrier& message);
[[nodiscard]] std::vector<std::uint8_t> to_bytes(const FromCarrier& message);

/// Nothing where the bytes are no whole message within the limits. What is read refers to them.
[[nodiscard]] std::optional<ToCarrier> to_carrier_from(std::span<const std::uint8_t> bytes);
[[nodiscard]] std::optional<FromCarrier> from_carrier_from(std::span<const std::uint8_t> bytes);

}  // namespace skein::network
