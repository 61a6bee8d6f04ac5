// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <queue>
#include <tuple>
#include <variant>
#include <vector>

#include "skein/base/ids.hpp"
#include "skein/base/time.hpp"
#include "skein/mission/messages.hpp"
#include "skein/mission/vehicle_agent.hpp"

namespace skein::hil {

using Content = std::variant<mission::Message, mission::PlanningResult>;

/// A message or a finished plan on its way to a node. What is sent to many is held once.
struct Parcel {
  Instant at{};
  std::uint64_t order = 0;  ///< of posting
  std::size_t to = 0;       ///< index of the node
  VehicleId from;
  std::uint32_t life = 0;  ///< of the receiver, where it is for that one only
  std::shared_ptr<const Content> what;
  friend bool operator<(const Parcel& a, const Parcel& b) {
    return std::tie(a.at, a.order) < std::tie(b.at, b.order);
  }
};

/// All that is on its way: earlier first, and in the order of posting at one moment. Kept in the
/// slots of the simulation's steps, so that only what is due in one step has to be sorted.
class InFlight {
 public:
  explicit InFlight(Duration step) : step_{step} {}

  void post(Parcel parcel);
  /// The next that is due by `now`, which never decreases. What is posted meanwhile counts.
  [[nodiscard]] std::optional<Parcel> pop_due(Instant now);

 private:
  using Slot = Duration::rep;
  struct Later {
    bool operator()(const Parcel& a, const Parcel& b) const { return b < a; }
  };
  /// The first step at or after the instant.
  [[nodiscard]] Slot slot_of(Instant at) const {
    return (at.time_since_epoch() + step_ - Duration{1}) / step_;
  }
  void open_slots(Slot until);

  Duration step_;
  std::uint64_t order_ = 0;
  Slot opened_ = -1;
  std::deque<std::vector<Parcel>> slots_;   ///< those after opened_
  std::vector<std::vector<Parcel>> spare_;  ///< the memory of slots that have been opened
  std::vector<Parcel> due_;                 ///< of the opened slots, sorted
  std::size_t next_ = 0;                    ///< in due_
  std::priority_queue<Parcel, std::vector<Parcel>, Later> urgent_;  ///< posted into opened slots
};

}  // namespace skein::hil
