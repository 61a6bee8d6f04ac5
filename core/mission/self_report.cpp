// SPDX-License-Identifier: Apache-2.0
#include "self_report.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

namespace skein::mission {

void SelfReport::on_plan(const FlightPlan& plan) {
  plan_ = plan;
  next_plan_ = Instant::min();
}

std::optional<PlanReport> SelfReport::plan_due(Instant now) {
  if (!plan_ || now < next_plan_) return std::nullopt;
  next_plan_ = now + kPlanPeriod;
  return PlanReport{base_.vehicle, *plan_};
}

Health SelfReport::health(const Facts& facts, Instant now) {
  next_health_ = now + kHealthPeriod;
  Health health = base_;
  health.time = now;
  health.mode = facts.condition.mode;
  health.problems = problems(facts, now);
  told_ = facts;
  std::erase_if(heard_, [now](const auto& entry) { return now - entry.second > kHeardFor; });
  for (const auto& [vehicle, at] : heard_) health.heard.push_back({vehicle, now - at});
  std::stable_sort(health.heard.begin(), health.heard.end(),
                   [](const auto& a, const auto& b) { return a.age < b.age; });
  if (health.heard.size() > kHeardMax) health.heard.resize(kHeardMax);
  return health;
}

std::vector<std::string> SelfReport::problems(const Facts& facts, Instant now) const {
  std::vector<std::string> all;
  if (!facts.state_at) {
    all.emplace_back("its flight controller has told no state yet");
  } else if (now - *facts.state_at > kFlightControllerSilence) {
    std::array<char, 32> seconds{};
    std::snprintf(seconds.data(), seconds.size(), "%.1f", to_seconds(now - *facts.state_at));
    all.push_back("no state from its flight controller for " + std::string{seconds.data()} + " s");
  }
  const auto more = [&all](std::uint64_t count, std::uint64_t told, const char* what) {
    if (count > told) all.push_back(std::to_string(count - told) + what);
  };
  more(facts.condition.overruns, told_.condition.overruns, " control periods missed");
  more(facts.condition.dropped, told_.condition.dropped, " messages or records dropped");
  more(facts.refused, told_.refused, " messages refused: not their sender's to say");
  return all;
}

}  // namespace skein::mission
