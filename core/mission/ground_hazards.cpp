// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/ground_hazards.hpp"

#include <algorithm>
#include <cmath>

#include "operator_numbers.hpp"
#include "skein/planning/circle_cover.hpp"

namespace skein::mission {
namespace {
constexpr Duration kRepeat = std::chrono::seconds{5};
/// What is no more is told as often for a while, and then now and then: who was away hears of it.
constexpr Duration kWithdrawnOften = std::chrono::minutes{2};
constexpr Duration kWithdrawnRepeat = std::chrono::seconds{30};
constexpr Duration kKnownAtLeast = std::chrono::seconds{2};
constexpr std::size_t kRememberedMax =
    4096;  ///< what a flood from the network can make us remember

bool is_circle(const HazardShape& shape) {
  return shape.centre_m.allFinite() && shape.radius_m > 0.0 && std::isfinite(shape.radius_m);
}
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
  if (const auto* event = std::get_if<MissionEvent>(&message)) {
    const auto* known = std::get_if<event::HazardKnown>(&event->body);
    const bool asked =
        known != nullptr && std::ranges::any_of(retiring_, [&](const auto& one) {
          return std::ranges::find(one.in_place, known->hazard) != one.in_place.end();
        });
    if (asked) heard_.emplace(known->hazard, event->vehicle);
    return;
  }
  const auto* report = std::get_if<HazardReport>(&message);
  if (report == nullptr || taken_.size() >= kRememberedMax) return;
  taken_.insert(report->hazard.id);
  report->withdrawn ? known_.withdraw(report->hazard.id) : known_.add(report->hazard);
}

std::size_t GroundHazards::standing() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(told_, [](const Told& t) { return !t.report.withdrawn; }));
}

Result<HazardId> GroundHazards::add(const Vec2& centre, double radius_m, Instant now) {
  return add(HazardShape{{}, centre, radius_m}, now);
}

Result<HazardGroup> GroundHazards::tell(const HazardShape& shape, Instant now) {
  HazardGroup group{shape, {}, 0.0};
  std::vector<planning::Circle> circles{{shape.centre_m, shape.radius_m}};
  if (!shape.corners.empty()) {
    auto cover = planning::cover_with_circles(shape.corners);
    if (!cover) return cover.error();
    circles = std::move(cover->circles);
    group.more = cover->more();
  } else if (!is_circle(shape)) {
    return Error{"a hazard is a circle: a centre, and a radius above 0 m"};
  }
  if (standing() + circles.size() > kHazardsMax) {
    return Error{"there are too many hazards already; withdraw those that are no more"};
  }
  if (told_.size() + circles.size() > kToldMax) {
    return Error{"in this mission " + std::to_string(told_.size()) + " circles of " +
                 std::to_string(kToldMax) +
                 " were told, those of changed and withdrawn hazards included; no more are kept"};
  }
  for (const planning::Circle& circle : circles) {
    const HazardReport report{{new_number(taken_, now), circle.centre, circle.radius_m}, false};
    known_.add(report.hazard);
    say(report, now);
    group.circles.push_back(report.hazard.id);
  }
  return group;
}

Result<HazardId> GroundHazards::add(const HazardShape& shape, Instant now) {
  auto group = tell(shape, now);
  if (!group) return group.error();
  const HazardId number = group->circles.front();
  if (!shape.corners.empty()) groups_[number] = *std::move(group);
  return number;
}

HazardId GroundHazards::number_of(HazardId id) const {
  if (groups_.contains(id)) return id;
  const auto group = std::ranges::find_if(groups_, [id](const auto& one) {
    return std::ranges::find(one.second.circles, id) != one.second.circles.end();
  });
  return group == groups_.end() ? id : group->first;
}

Result<void> GroundHazards::change(HazardId number, const HazardShape& shape, Instant now) {
  const auto group = group_of(number);
  if (group == groups_.end() && !known_.knows(number)) {
    return Error{"there is no hazard " + std::to_string(number.value) + "; 'hazards' lists them"};
  }
  auto changed = tell(shape, now);
  if (!changed) return changed.error();
  const HazardId name = group == groups_.end() ? number : group->first;
  Retiring retiring{name, {number}, changed->circles, now};
  if (group != groups_.end()) retiring.old = group->second.circles;
  retiring_.push_back(std::move(retiring));
  groups_[name] = *std::move(changed);
  return {};
}

void GroundHazards::withdraw_circle(HazardId id, Instant now) {
  const auto& all = known_.all();
  const auto known = std::ranges::find_if(all, [id](const Hazard& h) { return h.id == id; });
  if (known == all.end()) return;
  const HazardReport report{*known, true};
  known_.withdraw(id);
  say(report, now);
}

Result<void> GroundHazards::withdraw(HazardId id, Instant now) {
  const auto group = group_of(id);
  if (group == groups_.end()) {
    if (!known_.knows(id)) {
      return Error{"there is no hazard " + std::to_string(id.value) + "; 'hazards' lists them"};
    }
    withdraw_circle(id, now);
    return {};
  }
  for (const HazardId circle : group->second.circles) withdraw_circle(circle, now);
  for (const Retiring& retiring : retiring_) {
    if (retiring.number != group->first) continue;
    for (const HazardId circle : retiring.old) withdraw_circle(circle, now);
  }
  std::erase_if(retiring_, [&](const Retiring& r) { return r.number == group->first; });
  groups_.erase(group);
  return {};
}

bool GroundHazards::all_know(const Retiring& retiring, const Fleet& fleet) const {
  return std::ranges::all_of(fleet.vehicles(), [&](const auto& vehicle) {
    const auto& [id, entry] = vehicle;
    if (!entry.expected || !entry.telemetry || entry.silent) return true;
    return std::ranges::all_of(retiring.in_place, [&, id = id](HazardId circle) {
      return heard_.contains({circle, id});
    });
  });
}

void GroundHazards::retire(const Fleet& fleet, Instant now) {
  for (std::size_t i = 0; i < retiring_.size();) {
    const Retiring& one = retiring_[i];
    const bool is_time = now >= one.since + kChangeWithin ||
                         (now >= one.since + kKnownAtLeast && all_know(one, fleet));
    if (!is_time) {
      ++i;
      continue;
    }
    for (const HazardId circle : one.old) withdraw_circle(circle, now);
    retiring_.erase(retiring_.begin() + static_cast<std::ptrdiff_t>(i));
  }
  if (retiring_.empty()) heard_.clear();
}

void GroundHazards::say(const HazardReport& report, Instant now) {
  taken_.insert(report.hazard.id);
  const auto before = std::ranges::find_if(
      told_, [&report](const Told& t) { return t.report.hazard.id == report.hazard.id; });
  const Told told{report, now, now + kRepeat};
  if (before != told_.end()) {
    *before = told;
  } else {
    told_.push_back(told);
  }
  messages_.push(Message{report});
  next_ = std::min(next_, now + kRepeat);
}

void GroundHazards::on_timeout(Instant now) {
  if (now < next_) return;
  next_ = Instant::max();
  for (Told& told : told_) {
    if (now >= told.next) {
      messages_.push(Message{told.report});
      const bool seldom = told.report.withdrawn && now > told.since + kWithdrawnOften;
      told.next = now + (seldom ? kWithdrawnRepeat : kRepeat);
    }
    next_ = std::min(next_, told.next);
  }
}

}  // namespace skein::mission
