// SPDX-License-Identifier: Apache-2.0
#include "skein/mavlink/signing.hpp"

#include <nettle/sha2.h>

#include <algorithm>

namespace skein::mavlink {
namespace {

constexpr std::size_t kHashBytes = 6;
constexpr SigningTime kTimeMask = (SigningTime{1} << 48U) - 1;

/// Of everything up to the signature's hash: packet, link id and timestamp.
std::array<std::uint8_t, kHashBytes> hash(const SigningKey& key,
                                          std::span<const std::uint8_t> signed_part) {
  sha256_ctx context{};
  sha256_init(&context);
  sha256_update(&context, key.size(), key.data());
  sha256_update(&context, signed_part.size(), signed_part.data());
  std::array<std::uint8_t, kHashBytes> digest{};
  sha256_digest(&context, digest.size(), digest.data());
  return digest;
}

}  // namespace

SigningKey key_of(std::string_view passphrase) {
  sha256_ctx context{};
  sha256_init(&context);
  for (const char c : passphrase) {
    const auto byte = static_cast<std::uint8_t>(c);
    sha256_update(&context, 1, &byte);
  }
  SigningKey key{};
  sha256_digest(&context, key.size(), key.data());
  return key;
}

void Signer::sign(WireBytes& packet) {
  time_ = (time_ + 1) & kTimeMask;
  packet.push_back(link_);
  for (unsigned i = 0; i < 6; ++i) {
    packet.push_back(static_cast<std::uint8_t>(time_ >> (8 * i)));
  }
  for (const std::uint8_t byte : hash(key_, packet)) packet.push_back(byte);
}

bool SignatureChecker::accept(std::span<const std::uint8_t> packet, std::uint8_t system,
                              std::uint8_t component) {
  const auto signature = packet.last(kSignatureSize);
  const auto expected = hash(key_, packet.first(packet.size() - kHashBytes));
  // Every byte is looked at: how long it takes must not tell how many were right.
  unsigned difference = 0;
  for (std::size_t i = 0; i < kHashBytes; ++i) {
    difference |= static_cast<unsigned>(expected[i] ^ signature[kSignatureSize - kHashBytes + i]);
  }
  if (difference != 0) return false;

  SigningTime time = 0;
  for (unsigned i = 0; i < 6; ++i) time |= SigningTime{signature[1 + i]} << (8 * i);
  const auto [stream, is_new] =
      streams_.size() < kStreamsMax
          ? streams_.try_emplace(Stream{system, component, signature[0]}, time)
          : std::pair{streams_.find(Stream{system, component, signature[0]}), false};
  if (stream == streams_.end()) return false;
  if (is_new) {
    if (time + kSigningTimeSlack < newest_) {
      streams_.erase(stream);
      return false;
    }
  } else if (time <= stream->second) {
    return false;
  }
  stream->second = time;
  newest_ = std::max(newest_, time);
  return true;
}

}  // namespace skein::mavlink
