// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
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
  bool only_wakes = false;
  InstanceId start = {};  ///< of the ground station that says it
  friend bool operator<(const Parcel& a, const Parcel& b) {
    return std::tie(a.at, a.order) < std::tie(b.at, b.order);
  }
};

/// All that is on its way: earlier first, and in the order of posting at one moment. Kept in the
/// slots of the simulation's steps, so that only what is due in one step has to be sorted.
class InFlight {
 public:
  static constexpr Duration kStep = std::chrono::milliseconds{20};

  void post(Parcel parcel);
  /// A message that does no more than wake its node. Of those that come to a node in one step the
  /// first arrives, and after whatever has moved it (on_moved()) the next: one that was awake at
  /// this moment, and did nothing, does nothing.
  void post_wake(Instant at, std::size_t to, VehicleId from,
                 const std::shared_ptr<const Content>& what);
  /// What was popped last has made its node do something.
  void on_moved(const Parcel& by);
  /// The next that is due by `now`, which never decreases. What is posted meanwhile counts.
  [[nodiscard]] std::optional<Parcel> pop_due(Instant now);

 private:
  using Slot = Duration::rep;
  struct Later {
    bool operator()(const Parcel& a, const Parcel& b) const { return b < a; }
  };
  /// The first step at or after the instant.
  [[nodiscard]] Slot slot_of(Instant at) const {
    return (at.time_since_epoch() + kStep - Duration{1}) / kStep;
  }
  /// Where a parcel of a step comes in it: by the time from its begin, then in the order of
  /// posting.
  using Place = std::uint64_t;
  struct Wake {
    Place place = 0;
    std::uint32_t to = 0;
    std::uint32_t said = 0;  ///< index of what
  };
  struct Said {
    VehicleId from;
    std::shared_ptr<const Content> what;
  };
  /// What comes in one step.
  struct Step {
    std::vector<Parcel> parcels;
    std::vector<Wake> wakes;  ///< in the order of posting: in a large team, thousands
    std::vector<Said> said;   ///< by which they wake
    Instant from{};           ///< nothing of it comes before
    std::uint64_t order = 0;
  };
  /// The wakes of the newest opened step that are one node's.
  struct Waking {
    std::uint32_t begin = 0;  ///< in wakes_
    std::uint32_t end = 0;
    Place next = 0;  ///< that arrives, or did so last
  };
  [[nodiscard]] Step& step_of(Slot slot);
  [[nodiscard]] static Place place_in(const Step& step, Instant at, std::uint64_t order);
  [[nodiscard]] Parcel wake_of(std::size_t to) const;
  void open_slots(Slot until);
  void open_wakes();

  std::uint64_t order_ = 0;
  Slot opened_ = -1;
  std::deque<Step> slots_;      ///< those after opened_
  std::vector<Step> spare_;     ///< the memory of slots that have been opened
  std::vector<Parcel> due_;     ///< of the opened slots, sorted
  Step open_;                   ///< the newest opened
  std::vector<Wake> wakes_;     ///< its wakes by node, and of each in the order of posting
  std::vector<Waking> waking_;  ///< by node
  std::size_t next_ = 0;        ///< in due_
  std::priority_queue<Parcel, std::vector<Parcel>, Later> urgent_;  ///< posted into opened slots
};

}  // namespace skein::hil
