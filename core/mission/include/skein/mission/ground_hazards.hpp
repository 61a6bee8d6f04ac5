// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include "skein/base/bounded_queue.hpp"
#include "skein/base/result.hpp"
#include "skein/base/time.hpp"
#include "skein/domain/hazard.hpp"
#include "skein/mission/messages.hpp"

namespace skein::mission {

/// The hazards that the operator tells all of, or takes back. Calling rules as of GroundAgent.
class GroundHazards {
 public:
  static constexpr std::size_t kHazardsMax = 100;

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
  /// Tells everybody, in the same way, that there is none any more; of any that is known here. It
  /// never comes back.
  Result<void> withdraw(HazardId id, Instant now);

  /// All that are known here.
  [[nodiscard]] const std::vector<Hazard>& known() const { return known_.all(); }

  [[nodiscard]] std::optional<Message> poll_message() { return messages_.pop(); }
  [[nodiscard]] Instant next_timeout() const { return next_; }
  [[nodiscard]] std::uint64_t dropped() const { return messages_.dropped(); }

 private:
  void say(const HazardReport& report, Instant now);

  KnownHazards known_;              ///< the operator's, and those heard of
  std::vector<HazardReport> told_;  ///< by the operator: each one's newest
  std::set<HazardId> taken_;
  Instant next_ = Instant::max();
  BoundedQueue<Message> messages_{256};
};

}  // namespace skein::mission
