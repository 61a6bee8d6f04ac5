// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace skein::coalition {

/// What was of no use, or had no room, since the start.
struct Tally {
  std::uint64_t protocol_errors = 0;  ///< inputs that the state machine had no entry for
  std::uint64_t bad_messages = 0;     ///< whose values make no sense
  std::uint64_t dropped = 0;          ///< queues were full

  Tally& operator+=(const Tally& other) {
    protocol_errors += other.protocol_errors;
    bad_messages += other.bad_messages;
    dropped += other.dropped;
    return *this;
  }
};

}  // namespace skein::coalition
