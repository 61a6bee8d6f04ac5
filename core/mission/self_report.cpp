// SPDX-License-Identifier: Apache-2.0
#include "self_report.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <tuple>

#include "names.hpp"

namespace skein::mission {
namespace {

std::string text_of(const SeparationConflict& conflict, VehicleId self) {
  const std::string near = name_of(conflict.other) + " comes too near: ";
  if (conflict.gives_way == self) return near + "it gives way by its height";
  if (conflict.gives_way == VehicleId{}) return near + "it has no room to give way";
  return near + name_of(conflict.gives_way) + " gives way";
}

std::string text_of(const TrafficWatch::Conflict& conflict) {
  std::array<char, 32> address{};
  std::snprintf(address.data(), address.size(), "%06x", static_cast<unsigned>(conflict.address));
  return "aircraft " + std::string{address.data()} + " comes too near: " +
         (conflict.gives_way ? "it gives way by its height" : "it does not give way");
}

}  // namespace

void SelfReport::on_plan(const FlightPlan& plan) {
  plan_ = plan;
  next_plan_ = Instant::min();
}

void SelfReport::plan_wanted() {
  if (plan_) next_plan_ = std::min(next_plan_, plan_told_ + kPlanWanted);
}

std::optional<PlanReport> SelfReport::plan_due(Instant now) {
  if (!plan_ || now < next_plan_) return std::nullopt;
  plan_told_ = now;
  next_plan_ = now + kPlanPeriod;
  return PlanReport{base_.vehicle, *plan_};
}

Health SelfReport::health(const Facts& facts, Instant now) {
  next_health_ = now + kHealthPeriod;
  Health health = base_;
  health.time = now;
  health.mode = facts.condition.mode;
  health.problems = problems(facts, now);
  health.fence = facts.fence;
  told_ = facts;
  forget_silent(now);
  for (std::size_t i = 0; i < senders_.size(); ++i) {
    health.heard.push_back({senders_[i], now - heard_at_[i]});
  }
  const std::size_t told = std::min(health.heard.size(), kHeardMax);
  std::partial_sort(health.heard.begin(), health.heard.begin() + static_cast<std::ptrdiff_t>(told),
                    health.heard.end(), [](const Heard& a, const Heard& b) {
                      return std::tie(a.age, a.vehicle) < std::tie(b.age, b.vehicle);
                    });
  health.heard.resize(told);
  return health;
}

void SelfReport::forget_silent(Instant now) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < senders_.size(); ++i) {
    if (now - heard_at_[i] > kHeardFor) continue;
    senders_[kept] = senders_[i];
    heard_at_[kept++] = heard_at_[i];
  }
  senders_.resize(kept);
  heard_at_.resize(kept);
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
  if (facts.differs != nullptr) {
    all.push_back("the ground station has " + text_of(*facts.differs) + ": it holds");
  }
  if (facts.range_spent) all.emplace_back("its range is used up, but for the way home");
  if (facts.traffic) all.push_back(text_of(*facts.traffic));
  if (facts.separation) all.push_back(text_of(*facts.separation, base_.vehicle));
  if (!facts.knows_orders) all.emplace_back("it does not know which orders stand: it holds");
  const auto more = [&all](std::uint64_t count, std::uint64_t told, const char* what) {
    if (count > told) all.push_back(std::to_string(count - told) + what);
  };
  more(facts.condition.overruns, told_.condition.overruns, " control periods missed");
  more(facts.condition.dropped, told_.condition.dropped, " messages or records dropped");
  more(facts.refused, told_.refused, " messages refused: not their sender's to say");
  return all;
}

}  // namespace skein::mission
