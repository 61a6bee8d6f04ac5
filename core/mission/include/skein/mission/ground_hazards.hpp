// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "skein/base/bounded_queue.hpp"
#include "skein/base/result.hpp"
#include "skein/base/time.hpp"
#include "skein/domain/hazard.hpp"
#include "skein/mission/fleet.hpp"
#include "skein/mission/messages.hpp"

namespace skein::mission {

/// What the operator draws. Mission frame.
struct HazardShape {
  std::vector<Vec2> corners;  ///< of a polygon; none: a circle
  Vec2 centre_m{0.0, 0.0};
  double radius_m = 0.0;
};

/// A hazard that is not one circle for good: circles that hold a polygon, or one that was changed.
/// On the air they are circles, each with a number of its own.
struct HazardGroup {
  HazardShape shape;
  std::vector<HazardId> circles;
  double more = 0.0;  ///< what the circles shut out besides, as a share of the polygon
};

/// The hazards that the operator tells all of, or takes back. Calling rules as of GroundAgent.
class GroundHazards {
 public:
  static constexpr std::size_t kHazardsMax = 100;  ///< that stand
  static constexpr std::size_t kToldMax = 400;     ///< with those that were withdrawn

  explicit GroundHazards(const std::vector<Hazard>& known_before) : known_{known_before} {
    for (const Hazard& hazard : known_before) taken_.insert(hazard.id);
  }

  void recall(const Message& message, VehicleId sender, Instant at);
  void on_message(const Message& message);
  void on_timeout(Instant now);

  /// Tells everybody of a hazard, every 5 s from now on, so that who was out of reach hears of it
  /// too. Gives its number (new_number()). Fails where the circle is no circle, or after
  /// kHazardsMax.
  Result<HazardId> add(const Vec2& centre, double radius_m, Instant now);
  /// The same of either shape; a polygon is told as circles that hold it. The number is of all.
  Result<HazardId> add(const HazardShape& shape, Instant now);
  /// Another shape under the same number. The old circles are withdrawn when all who are heard have
  /// said that they know the new ones, or kChangeWithin later: at no moment is there none.
  Result<void> change(HazardId number, const HazardShape& shape, Instant now);
  /// Tells everybody, in the same way, that there is none any more; of any that is known here. It
  /// never comes back.
  Result<void> withdraw(HazardId id, Instant now);
  /// Withdraws what was changed, when its time has come.
  void retire(const Fleet& fleet, Instant now);

  static constexpr Duration kChangeWithin = std::chrono::seconds{30};

  /// All that are known here.
  [[nodiscard]] const std::vector<Hazard>& known() const { return known_.all(); }
  /// By their numbers. Not recalled: after a new start each circle is a hazard of its own.
  [[nodiscard]] const std::map<HazardId, HazardGroup>& groups() const { return groups_; }

  /// Of the group that it is a circle of; its own where it stands alone.
  [[nodiscard]] HazardId number_of(HazardId id) const;

  [[nodiscard]] std::optional<Message> poll_message() { return messages_.pop(); }
  [[nodiscard]] Instant next_timeout() const { return next_; }
  [[nodiscard]] std::uint64_t dropped() const { return messages_.dropped(); }

 private:
  /// Circles that others are to take the place of.
  struct Retiring {
    HazardId number;
    std::vector<HazardId> old;
    std::vector<HazardId> in_place;
    Instant since{};
  };
  struct Told {
    HazardReport report;
    Instant since{};
    Instant next{};
  };
  void say(const HazardReport& report, Instant now);
  [[nodiscard]] Result<HazardGroup> tell(const HazardShape& shape, Instant now);
  [[nodiscard]] std::size_t standing() const;
  /// Of which this circle is one, or that number; none where it stands alone.
  [[nodiscard]] std::map<HazardId, HazardGroup>::iterator group_of(HazardId id) {
    return groups_.find(number_of(id));
  }
  void withdraw_circle(HazardId id, Instant now);
  [[nodiscard]] bool all_know(const Retiring& retiring, const Fleet& fleet) const;

  KnownHazards known_;      ///< the operator's, and those heard of
  std::vector<Told> told_;  ///< by the operator: each one's newest
  std::set<HazardId> taken_;
  std::map<HazardId, HazardGroup> groups_;
  std::vector<Retiring> retiring_;
  std::set<std::pair<HazardId, VehicleId>> heard_;  ///< who knows which of the new ones
  Instant next_ = Instant::max();
  BoundedQueue<Message> messages_{512};
};

}  // namespace skein::mission
