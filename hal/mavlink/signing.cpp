// SPDX-License-Identifier: Apache-2.0
#include "skein/mavlink/signing.hpp"

#include <nettle/sha2.h>

#include <algorithm>
#include <charconv>
#include <system_error>

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

Result<SigningKey> key_from_text(std::string_view text) {
  constexpr std::string_view kWhite = " \t\r\n";
  const std::size_t begin = text.find_first_not_of(kWhite);
  if (begin == std::string_view::npos) return Error{"is empty"};
  text = text.substr(begin, text.find_last_not_of(kWhite) + 1 - begin);
  SigningKey key{};
  if (text.size() != 2 * key.size()) return key_of(text);
  for (std::size_t i = 0; i < key.size(); ++i) {
    const char* at = text.data() + 2 * i;
    const auto [end, failed] = std::from_chars(at, at + 2, key[i], 16);
    if (failed != std::errc{} || end != at + 2) return key_of(text);
  }
  return key;
}

SigningTime signing_time(std::int64_t unix_us) {
  constexpr std::int64_t kBegin_us = 1'420'070'400'000'000;  // 2015-01-01
  return static_cast<SigningTime>(std::max<std::int64_t>(unix_us - kBegin_us, 0) / 10) & kTimeMask;
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
