// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>

#include "skein/base/time.hpp"
#include "skein/mavlink/parser.hpp"

namespace skein::mavlink {

/// What one end of a link signs its packets with, and demands of the other's. It signs no earlier
/// than the newest genuine packet that it has heard, so that a clock that was set back does not
/// make it mute.
struct Signing {
  SigningKey key{};
  std::int64_t unix_us = 0;  ///< system time at Instant{}

  [[nodiscard]] SigningTime at(Instant now) const {
    return signing_time(unix_us + now.time_since_epoch() / std::chrono::microseconds{1});
  }
};

[[nodiscard]] inline ParserParams parser_params(const std::optional<Signing>& signing,
                                                Instant now) {
  if (!signing) return {};
  return {.key = signing->key, .now = signing->at(now), .accept_unsigned = false};
}

/// To be called once before anything is sent, and again as time goes on.
inline void sign_at(const std::optional<Signing>& signing, Encoder& encoder, const Parser& parser,
                    Instant now) {
  if (!signing) return;
  const auto time = std::max(signing->at(now), parser.newest_signature());
  if (encoder.signer() == nullptr) encoder.sign_with({signing->key, 0, time});
  encoder.signer()->advance_to(time);
}

}  // namespace skein::mavlink
