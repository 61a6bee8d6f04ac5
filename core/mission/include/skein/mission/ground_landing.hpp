// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <set>
#include <vector>

#include "skein/base/bounded_queue.hpp"
#include "skein/base/result.hpp"
#include "skein/base/time.hpp"
#include "skein/mission/fleet.hpp"
#include "skein/mission/messages.hpp"

namespace skein::mission {

/// Who lands next: the operator orders any number of vehicles to land, which are at home or on
/// their way there; each is told when the one before it is down, or has not come down within
/// kSlot. The lowest lands first, so that nobody comes down through another's height. Calling rules
/// as of GroundAgent.
class GroundLanding {
 public:
  static constexpr Duration kSlot = std::chrono::minutes{5};

  /// Why that vehicle is not to land, `standing` being the order that it obeys: a sentence; none
  /// where it may.
  [[nodiscard]] static std::optional<std::string> why_not(VehicleId vehicle, CommandKind standing,
                                                          const Fleet& fleet);
  /// It waits for its turn.
  void add(VehicleId vehicle, Instant now) {
    waiting_.insert(vehicle);
    next_ = now;
  }
  /// Another order than to land: it waits no more, and has no turn.
  void drop(VehicleId vehicle);
  /// Whoever waits waits for nobody any more.
  void forget() {
    waiting_.clear();
    turn_.reset();
    next_ = Instant::max();
  }
  [[nodiscard]] const std::set<VehicleId>& waiting() const { return waiting_; }

  /// Who is to be told now to land.
  [[nodiscard]] std::optional<VehicleId> next(const Fleet& fleet, Instant now);
  [[nodiscard]] std::optional<MissionEvent> poll_event() { return events_.pop(); }
  [[nodiscard]] Instant next_timeout() const { return next_; }
  [[nodiscard]] std::uint64_t dropped() const { return events_.dropped(); }

 private:
  struct Turn {
    VehicleId vehicle;
    Instant since{};
  };
  [[nodiscard]] bool turn_ends(const Fleet& fleet, Instant now);

  std::set<VehicleId> waiting_;
  std::optional<Turn> turn_;
  Instant next_ = Instant::max();
  BoundedQueue<MissionEvent> events_{16};
};

}  // namespace skein::mission
