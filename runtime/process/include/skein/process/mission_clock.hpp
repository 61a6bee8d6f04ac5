// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>

#include "skein/base/time.hpp"

namespace skein::process {

/// The one clock of a process: mission time = (system time - epoch) * rate. The system time is read
/// once, at the start; after that only CLOCK_MONOTONIC counts, so that a clock that is set during
/// the mission moves nobody. Thread-safe; now() never decreases.
class MissionClock {
 public:
  /// Preconditions: an epoch after that of Unix, rate > 0.
  MissionClock(std::int64_t epoch_unix_ns, double rate);

  [[nodiscard]] Instant now() const;
  /// Mission time 0, by the system time that was read. (At a rate other than 1, later mission times
  /// are not so long after it.)
  [[nodiscard]] std::int64_t epoch_unix_ns() const { return epoch_unix_ns_; }
  /// When that instant is, for waiting. Instants further away than a day are cut to a day from now.
  [[nodiscard]] std::chrono::steady_clock::time_point steady_time_of(Instant t) const;
  /// Returns at once when `t` has passed. Allocates nothing and takes no lock.
  void sleep_until(Instant t) const;

 private:
  std::chrono::steady_clock::time_point steady_start_;
  Instant mission_start_;
  double rate_;
  std::int64_t epoch_unix_ns_;
};

}  // namespace skein::process
