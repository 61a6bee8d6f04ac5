// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>

namespace skein::seal {

/// Which counters of one sender were seen (as RFC 6479): the newest, and which of the kReach before
/// it. Datagrams overtake each other on a radio, so order is not asked for; what is older than the
/// window counts as seen.
class ReplayWindow {
 public:
  static constexpr std::size_t kReach = 1024;

  [[nodiscard]] bool is_new(std::uint64_t counter) const;
  /// Only what was opened may be noted, or a forger moves the window.
  void note(std::uint64_t counter);

 private:
  bool any_ = false;
  std::uint64_t newest_ = 0;
  std::bitset<kReach> seen_;  ///< of counter c at c % kReach
};

}  // namespace skein::seal
