// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cmath>
#include <cstdint>

namespace skein {

/// Integer nanoseconds. 2^63 ns are 292 years, so no mission overflows it.
using Duration = std::chrono::nanoseconds;

/// Mission time: nanoseconds since the scenario's epoch. It has no now(): code that decides is
/// handed the time and cannot read a clock. Only the processes own one (onboard/, groundstation/,
/// hil/).
struct MissionTime {
  using rep = Duration::rep;
  using period = Duration::period;
  using duration = Duration;
  using time_point = std::chrono::time_point<MissionTime>;
  static constexpr bool is_steady = true;
};
using Instant = MissionTime::time_point;

/// A duration from seconds, to the nearest nanosecond. Precondition: |s| < 9.2e9.
[[nodiscard]] inline Duration from_seconds(double s) { return Duration{std::llround(s * 1e9)}; }
[[nodiscard]] constexpr double to_seconds(Duration d) {
  return static_cast<double>(d.count()) * 1e-9;
}

/// The instant `s` seconds after the epoch, and back.
[[nodiscard]] inline Instant at_seconds(double s) { return Instant{from_seconds(s)}; }
[[nodiscard]] constexpr double to_seconds(Instant t) { return to_seconds(t.time_since_epoch()); }

/// The first multiple of the period after `t`: who is due then is not shifted by a late step.
[[nodiscard]] constexpr Instant next_multiple(Instant t, Duration period) {
  return Instant{(t.time_since_epoch() / period + 1) * period};
}

}  // namespace skein
