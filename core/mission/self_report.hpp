// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "skein/base/time.hpp"
#include "skein/mission/messages.hpp"
#include "skein/mission/onboard_agent.hpp"
#include "skein/mission/setup_book.hpp"

namespace skein::mission {

/// What a vehicle tells of itself besides its telemetry, for people who watch it: the plan that it
/// follows, with every new one and every 5 s; and once a second how its program is.
class SelfReport {
 public:
  static constexpr Duration kPlanPeriod = std::chrono::seconds{5};
  static constexpr Duration kPlanWanted = std::chrono::seconds{1};
  static constexpr Duration kHealthPeriod = std::chrono::seconds{1};
  static constexpr Duration kHeardFor = std::chrono::seconds{60};  ///< then it is left out

  /// What does not change is in `base`: vehicle, instance, program, flight controller.
  SelfReport(Health base, Instant now) : base_{std::move(base)}, next_health_{now} {}

  void on_heard(VehicleId sender, Instant now) {
    const auto at = std::ranges::lower_bound(senders_, sender);
    const auto i = at - senders_.begin();
    if (at != senders_.end() && *at == sender) {
      heard_at_[static_cast<std::size_t>(i)] = now;
    } else {
      senders_.insert(at, sender);
      heard_at_.insert(heard_at_.begin() + i, now);
    }
  }
  void on_plan(const FlightPlan& plan);
  /// Somebody plans for it: the plan is told again, but not more than once in a second.
  void plan_wanted();

  /// What can be wrong, counted since the start.
  struct Facts {
    Condition condition;
    std::optional<Instant> state_at = {};      ///< of the newest state; none: none came yet
    std::uint64_t refused = 0;                 ///< messages that were not their sender's to say
    const SetupDifference* differs = nullptr;  ///< from the ground station
    bool knows_orders = true;
    bool range_spent = false;  ///< but for the way home
    std::optional<SeparationConflict> separation = {};
    std::uint32_t fence = 0;  ///< digest_of() the one that it keeps
    std::optional<TrafficWatch::Conflict> traffic = {};
  };
  [[nodiscard]] std::optional<PlanReport> plan_due(Instant now);
  [[nodiscard]] bool health_due(Instant now) const { return now >= next_health_; }
  /// Problems are those since the last call.
  [[nodiscard]] Health health(const Facts& facts, Instant now);
  [[nodiscard]] Instant next_due() const { return std::min(next_plan_, next_health_); }

 private:
  void forget_silent(Instant now);
  [[nodiscard]] std::vector<std::string> problems(const Facts& facts, Instant now) const;

  Health base_;
  // Looked into at every message: side by side, the senders of a large team are one cache line.
  std::vector<VehicleId> senders_;  ///< by number
  std::vector<Instant> heard_at_;   ///< when, of each
  std::optional<FlightPlan> plan_;
  Instant next_plan_ = Instant::max();
  Instant plan_told_{};
  Instant next_health_;
  Facts told_;
};

}  // namespace skein::mission
