// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "skein/base/static_vector.hpp"
#include "skein/mavlink/packet.hpp"
#include "skein/mavlink/signing.hpp"

namespace skein::mavlink {

struct ParserParams {
  std::optional<SigningKey> key;  ///< without: signatures are read over
  SigningTime now = 0;            ///< see SignatureChecker
  bool accept_unsigned = true;    ///< with a key: whether packets without a signature pass
};

struct ParserStatistics {
  std::uint64_t packets = 0;        ///< delivered
  std::uint64_t unknown = 0;        ///< of messages not in use: skipped whole, checksum unchecked
  std::uint64_t bad_crc = 0;        ///< began as a packet does, and its checksum did not hold
  std::uint64_t bad_signature = 0;  ///< or none, where one is asked for
  std::uint64_t skipped_bytes = 0;  ///< that belonged to no packet
  std::uint64_t lost = 0;           ///< missing sequence numbers, of all senders
  std::uint32_t last_unknown = 0;   ///< id
};

/// Finds MAVLink 2 and 1 packets in a stream of bytes that may hold anything else, cut anywhere.
/// After a packet that does not hold, it looks again from the byte after its start: noise costs
/// itself and no more. Allocates nothing after it is made, but for the streams of a
/// SignatureChecker.
class Parser {
 public:
  explicit Parser(const ParserParams& params = {});

  /// Takes the next bytes; calls `sink(const Packet&)` for each packet that they complete.
  template <class Sink>
  void parse(std::span<const std::uint8_t> bytes, Sink&& sink) {
    while (!bytes.empty()) {
      const std::size_t taken = append(bytes);
      bytes = bytes.subspan(taken);
      while (const Packet* packet = next()) sink(*packet);
    }
  }

  [[nodiscard]] const ParserStatistics& statistics() const { return statistics_; }
  /// Of the genuine signatures; 0 without a key.
  [[nodiscard]] SigningTime newest_signature() const { return checker_ ? checker_->newest() : 0; }

 private:
  enum class Verdict : std::uint8_t { wait, not_a_packet, packet, skip };
  struct Sender {
    std::uint8_t system;
    std::uint8_t component;
    std::uint8_t next;
  };

  std::size_t append(std::span<const std::uint8_t> bytes);
  const Packet* next();
  Verdict judge(std::span<const std::uint8_t> bytes, std::size_t& size);
  Verdict judge_unknown(std::span<const std::uint8_t> bytes, std::size_t size);
  bool signature_holds(std::span<const std::uint8_t> packet);
  void count_sequence();

  std::array<std::uint8_t, 2 * kPacketMax> buffer_{};
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  Packet packet_;
  std::optional<SignatureChecker> checker_;
  bool accept_unsigned_;
  StaticVector<Sender, 16> senders_;
  ParserStatistics statistics_;
};

/// Makes packets of messages: MAVLink 2, with a sequence number of its own, zeros truncated.
class Encoder {
 public:
  Encoder(std::uint8_t system, std::uint8_t component) : system_{system}, component_{component} {}

  void sign_with(const Signer& signer) { signer_ = signer; }
  [[nodiscard]] Signer* signer() { return signer_ ? &*signer_ : nullptr; }

  template <class Message>
  [[nodiscard]] WireBytes encode(const Message& message) {
    return encode(kMessageInfo<Message>, to_payload(message));
  }
  [[nodiscard]] WireBytes encode(const MessageInfo& info, const Payload& payload);

  [[nodiscard]] std::uint8_t system() const { return system_; }
  [[nodiscard]] std::uint8_t component() const { return component_; }

 private:
  std::uint8_t system_;
  std::uint8_t component_;
  std::uint8_t sequence_ = 0;
  std::optional<Signer> signer_;
};

}  // namespace skein::mavlink
