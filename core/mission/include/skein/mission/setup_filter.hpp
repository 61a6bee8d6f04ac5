// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <vector>

#include "skein/base/ids.hpp"
#include "skein/base/time.hpp"
#include "skein/mission/messages.hpp"
#include "skein/mission/setup_book.hpp"

namespace skein::mission {

/// Which setups of others a vehicle need not judge. Nearly all agree with its own, and change
/// nothing in its SetupBook; but to prove their signatures costs a team that starts together more
/// than all else. What it passes by is not proven, so it is used for nothing; and what anybody
/// forges makes it heed more, never less.
class SetupFilter {
 public:
  /// Of each node one setup is proven so often: an older one that somebody repeats counts no more.
  static constexpr Duration kProven = std::chrono::seconds{60};
  /// How long all are heeded after one that was unusual: the book waits for several that are as
  /// they should be, which come every few minutes in the largest teams.
  static constexpr Duration kHeeded = std::chrono::minutes{10};

  /// Parameters and number as of the SetupBook.
  SetupFilter(const SetupParams& params, VehicleId self);

  /// Of each message in the order in which they are heard. False only of a setup of another vehicle
  /// that knows its orders, is set up as this one, under the start that was heard of it before (or
  /// none was), with clocks within the guard, and not long after one of which that was not true.
  [[nodiscard]] bool heeds(const Message& message, Instant now);

 private:
  struct Heard {
    InstanceId instance = {};
    Instant proven_at = Instant::max();  ///< the next; max: none was heard
    Instant heeded_until = Instant::min();
  };
  [[nodiscard]] bool heeds(const Setup& setup, Instant now);
  [[nodiscard]] bool is_usual(const Setup& setup, Instant now) const;
  [[nodiscard]] Heard& heard(VehicleId node);

  Duration clock_guard_;
  VehicleId self_;
  std::vector<SetupItem> items_;
  std::vector<Heard> heard_;  ///< by number
};

}  // namespace skein::mission
