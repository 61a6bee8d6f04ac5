// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string_view>
#include <tuple>

#include "skein/base/result.hpp"
#include "skein/mavlink/packet.hpp"

/// Signatures of MAVLink 2 packets (mavlink.io/en/guide/message_signing.html): link id, 48-bit
/// timestamp, and the first 48 bits of SHA-256 over key, packet, link id and timestamp.
namespace skein::mavlink {

using SigningKey = std::array<std::uint8_t, 32>;
/// Units of 10 us since 2015-01-01 UTC, 48 bits.
using SigningTime = std::uint64_t;

inline constexpr std::size_t kSignatureSize = 13;
/// A stream that is first heard may be this much behind the newest time seen (a minute).
inline constexpr SigningTime kSigningTimeSlack = 6'000'000;

[[nodiscard]] SigningTime signing_time(std::int64_t unix_us);

/// The key that ground stations make of a passphrase: its SHA-256.
[[nodiscard]] SigningKey key_of(std::string_view passphrase);
/// The key of a file: 64 hexadecimal digits, or a passphrase. White space around it does not count.
[[nodiscard]] Result<SigningKey> key_from_text(std::string_view text);

class Signer {
 public:
  /// `start`: never less than what this link has signed with before, or its packets are refused.
  Signer(const SigningKey& key, std::uint8_t link, SigningTime start)
      : key_{key}, time_{start}, link_{link} {}

  /// Time goes on to `now`; it never goes back, and every signature takes a time of its own.
  void advance_to(SigningTime now) { time_ = now > time_ ? now : time_; }
  /// Appends the signature to a packet that says in its header that it has one.
  void sign(WireBytes& packet);
  [[nodiscard]] SigningTime time() const { return time_; }

 private:
  SigningKey key_;
  SigningTime time_;
  std::uint8_t link_;
};

class SignatureChecker {
 public:
  /// `now` as far as it is known; 0 leaves old recordings to be replayed once.
  explicit SignatureChecker(const SigningKey& key, SigningTime now = 0) : key_{key}, newest_{now} {}

  /// Whether the packet (with its last 13 bytes as signature) is genuine and newer than what its
  /// stream (system, component, link) had before.
  [[nodiscard]] bool accept(std::span<const std::uint8_t> packet, std::uint8_t system,
                            std::uint8_t component);
  [[nodiscard]] SigningTime newest() const { return newest_; }

 private:
  using Stream = std::tuple<std::uint8_t, std::uint8_t, std::uint8_t>;
  static constexpr std::size_t kStreamsMax = 64;
  SigningKey key_;
  SigningTime newest_;
  std::map<Stream, SigningTime> streams_;
};

}  // namespace skein::mavlink
