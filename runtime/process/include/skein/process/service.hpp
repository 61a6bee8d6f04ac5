// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace skein::process {

/// Whether several parts of a process get on, by counters that each of them moves. Pure.
class ProgressWatch {
 public:
  using Time = std::chrono::steady_clock::time_point;
  ProgressWatch(std::size_t parts, Time now) : parts_(parts, Part{0, false, now}) {}

  /// True where every counter has moved since it last was: only then may a watchdog be fed.
  /// Precondition: as many counters as parts.
  [[nodiscard]] bool all_moved(std::span<const std::uint64_t> counters, Time now);
  /// How long that part's counter has stood, as of all_moved().
  [[nodiscard]] std::chrono::nanoseconds age(std::size_t part, Time now) const {
    return now - parts_[part].moved_at;
  }

 private:
  struct Part {
    std::uint64_t counter;
    bool moved;
    Time moved_at;
  };
  std::vector<Part> parts_;
};

/// What the process says to the service manager that started it (sd_notify(3)); nothing, where none
/// did. A watchdog bites where it is not fed in time.
class Service {
 public:
  Service();

  void ready() const;
  void stopping() const;
  void feed_watchdog() const;
  /// How often the watchdog should be looked after, four times in its patience; none where the
  /// service manager watches nobody.
  [[nodiscard]] std::optional<std::chrono::microseconds> watchdog_period() const {
    return watchdog_period_;
  }

 private:
  std::optional<std::chrono::microseconds> watchdog_period_;
};

}  // namespace skein::process
