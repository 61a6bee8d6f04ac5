// SPDX-License-Identifier: Apache-2.0
#include "skein/onboard/self_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "skein/onboard/control_loop.hpp"

namespace skein::onboard {

SelfReport::SelfReport(VehicleId self, Program program, Instant now)
    : self_{self}, program_{std::move(program)}, next_health_{now} {}

void SelfReport::on_plan(const mission::FlightPlan& plan) {
  plan_ = plan;
  next_plan_ = Instant::min();
}

std::optional<mission::PlanReport> SelfReport::plan_due(Instant now) {
  if (!plan_ || now < next_plan_) return std::nullopt;
  next_plan_ = now + kPlanPeriod;
  return mission::PlanReport{self_, *plan_};
}

mission::Health SelfReport::health(const Condition& condition, Instant now) {
  next_health_ = now + kHealthPeriod;
  mission::Health health;
  health.vehicle = self_;
  health.instance = condition.instance;
  health.time = now;
  health.program = program_.name;
  health.flight_controller = program_.flight_controller;
  health.mode = condition.mode;
  health.problems = problems(condition, now);
  overruns_ = condition.overruns;
  dropped_ = condition.dropped;
  std::erase_if(heard_, [now](const auto& entry) { return now - entry.second > kHeardFor; });
  for (const auto& [vehicle, at] : heard_) health.heard.push_back({vehicle, now - at});
  std::stable_sort(health.heard.begin(), health.heard.end(),
                   [](const auto& a, const auto& b) { return a.age < b.age; });
  if (health.heard.size() > mission::kHeardMax) health.heard.resize(mission::kHeardMax);
  return health;
}

std::vector<std::string> SelfReport::problems(const Condition& condition, Instant now) const {
  std::vector<std::string> all;
  if (!condition.state_at) {
    all.emplace_back("its flight controller has told no state yet");
  } else if (now - *condition.state_at > ControlLoop::kStateAgeMax) {
    all.push_back(fmt::format("no state from its flight controller for {:.1f} s",
                              to_seconds(now - *condition.state_at)));
  }
  if (condition.overruns > overruns_) {
    all.push_back(fmt::format("{} control periods missed", condition.overruns - overruns_));
  }
  if (condition.dropped > dropped_) {
    all.push_back(fmt::format("{} messages or records dropped", condition.dropped - dropped_));
  }
  return all;
}

Instant SelfReport::next_due() const { return std::min(next_plan_, next_health_); }

}  // namespace skein::onboard
