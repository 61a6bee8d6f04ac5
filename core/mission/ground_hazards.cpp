// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/ground_hazards.hpp"

#include <algorithm>
#include <cmath>

#include "operator_numbers.hpp"

namespace skein::mission {
namespace {
constexpr Duration kRepeat = std::chrono::seconds{5};
constexpr std::size_t kRememberedMax =
    4096;  ///< what a flood from the network can make us remember
}  // namespace

void GroundHazards::recall(const Message& message, VehicleId sender, Instant at) {
  if (sender != kGroundStation) return on_message(message);
  const auto* report = std::get_if<HazardReport>(&message);
  if (report == nullptr) return;
  const bool news =
      report->withdrawn ? known_.withdraw(report->hazard.id) : known_.add(report->hazard);
  if (news || report->withdrawn) say(*report, at);
  while (messages_.pop()) continue;  // said then
}

void GroundHazards::on_message(const Message& message) {
  const auto* report = std::get_if<HazardReport>(&message);
  if (report == nullptr || taken_.size() >= kRememberedMax) return;
  taken_.insert(report->hazard.id);
  report->withdrawn ? known_.withdraw(report->hazard.id) : known_.add(report->hazard);
}

Result<HazardId> GroundHazards::add(const Vec2& centre, double radius_m, Instant now) {
  if (!centre.allFinite() || !(radius_m > 0.0) || !std::isfinite(radius_m)) {
    return Error{"a hazard is a circle: a centre, and a radius above 0 m"};
  }
  if (told_.size() >= kHazardsMax) return Error{"there are too many hazards already"};
  const HazardReport report{{new_number(taken_, now), centre, radius_m}, false};
  known_.add(report.hazard);
  say(report, now);
  return report.hazard.id;
}

Result<void> GroundHazards::withdraw(HazardId id, Instant now) {
  const auto& all = known_.all();
  const auto known = std::ranges::find_if(all, [id](const Hazard& h) { return h.id == id; });
  if (known == all.end()) {
    return Error{"there is no hazard " + std::to_string(id.value) + "; 'hazards' lists them"};
  }
  const HazardReport report{*known, true};
  known_.withdraw(id);
  say(report, now);
  return {};
}

void GroundHazards::say(const HazardReport& report, Instant now) {
  taken_.insert(report.hazard.id);
  const auto before = std::ranges::find_if(
      told_, [&report](const HazardReport& r) { return r.hazard.id == report.hazard.id; });
  if (before != told_.end()) {
    *before = report;
  } else if (told_.size() < 2 * kHazardsMax) {
    told_.push_back(report);
  }
  messages_.push(Message{report});
  next_ = std::min(next_, now + kRepeat);
}

void GroundHazards::on_timeout(Instant now) {
  if (now < next_) return;
  for (const HazardReport& report : told_) messages_.push(Message{report});
  next_ = now + kRepeat;
}

}  // namespace skein::mission
