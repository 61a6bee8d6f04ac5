// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "skein/base/time.hpp"
#include "skein/mission/messages.hpp"

namespace skein::onboard {

/// What a vehicle tells of itself besides its telemetry, for people who watch it: the plan that it
/// follows, with every new one and every 5 s; and once a second how its program is. Pure.
class SelfReport {
 public:
  static constexpr Duration kPlanPeriod = std::chrono::seconds{5};
  static constexpr Duration kHealthPeriod = std::chrono::seconds{1};
  static constexpr Duration kHeardFor = std::chrono::seconds{60};  ///< then it is left out

  struct Program {
    std::string name;               ///< and version
    std::string flight_controller;  ///< its kind
  };
  SelfReport(VehicleId self, Program program, Instant now);

  void on_heard(VehicleId sender, Instant now) { heard_[sender] = now; }
  void on_plan(const mission::FlightPlan& plan);

  /// What can be wrong, counted since the start.
  struct Condition {
    InstanceId instance;
    std::string mode;
    std::optional<Instant> state_at;  ///< of the newest state; none: none came yet
    std::uint64_t overruns = 0;       ///< of control
    std::uint64_t dropped = 0;        ///< messages and records
  };
  [[nodiscard]] std::optional<mission::PlanReport> plan_due(Instant now);
  [[nodiscard]] bool health_due(Instant now) const { return now >= next_health_; }
  /// Problems are those since the last call.
  [[nodiscard]] mission::Health health(const Condition& condition, Instant now);
  [[nodiscard]] Instant next_due() const;

 private:
  [[nodiscard]] std::vector<std::string> problems(const Condition& condition, Instant now) const;

  VehicleId self_;
  Program program_;
  std::map<VehicleId, Instant> heard_;
  std::optional<mission::FlightPlan> plan_;
  Instant next_plan_ = Instant::max();
  Instant next_health_;
  std::uint64_t overruns_ = 0;  ///< told
  std::uint64_t dropped_ = 0;
};

}  // namespace skein::onboard
