// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "skein/base/time.hpp"

namespace skein::ardupilot {

/// The autopilot's clock (time since its boot) in mission time. Of the round trips of TIMESYNC the
/// one that binds the offset best counts: half its duration, and what the clocks may have drifted
/// since. Until one has been answered, a message counts as measured when it came. Where two cannot
/// both be true, none counts.
class BootClock {
 public:
  void restart();
  /// `boot`: the autopilot's clock, read between the two instants. Precondition: all three are less
  /// than 100 years.
  void on_round_trip(Instant sent, Instant answered, Duration boot);
  /// A message that was measured at `boot` has come. Bounds the offset from one side.
  void on_arrival(Instant now, Duration boot);

  /// Nothing before anything was heard. Never later than `now`, at which the message came.
  [[nodiscard]] std::optional<Instant> mission_time(Duration boot, Instant now) const;
  /// That a round trip was answered.
  [[nodiscard]] bool synchronised() const { return best_.has_value(); }
  /// The most that the offset may be wrong, at `now`.
  [[nodiscard]] Duration uncertainty(Instant now) const;

 private:
  struct Binding {
    Instant zero;  ///< mission time at the autopilot's boot
    Duration half_trip{};
    Instant at;
  };
  std::optional<Binding> best_;
  std::optional<Instant> earliest_zero_;
};

}  // namespace skein::ardupilot
