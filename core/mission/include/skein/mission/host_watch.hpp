// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace skein::mission {

/// What a machine knows of itself that a team relies on; nothing where it does not matter, or the
/// machine does not say.
struct HostFacts {
  struct Clock {
    bool synchronised = false;
    std::chrono::microseconds error_max{0};
  };
  std::optional<std::uint64_t> disk_free_bytes;  ///< where it records
  std::optional<Clock> clock;
  /// How often the process that carries the network was started again, if it was just now.
  std::uint64_t network_restarts = 0;
};

/// Below it a recording will end before long: several minutes are left, to land or to make room.
inline constexpr std::uint64_t kDiskFreeMinBytes = 500'000'000;
/// Two clocks that may be off so far differ by no more than the protocol's clock guard (0.5 s).
inline constexpr std::chrono::milliseconds kClockErrorMax{250};

/// For whoever watches the node, among the problems of its Health.
[[nodiscard]] std::vector<std::string> host_problems(const HostFacts& facts);

}  // namespace skein::mission
