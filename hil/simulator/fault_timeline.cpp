// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/fault_timeline.hpp"

#include <algorithm>
#include <utility>

namespace skein::hil {
namespace {

bool of_radio(const Fault& fault) {
  return std::holds_alternative<radio::Cut>(fault.what) ||
         std::holds_alternative<radio::Disturbance>(fault.what) ||
         std::holds_alternative<radio::Flood>(fault.what) ||
         std::holds_alternative<Healing>(fault.what);
}

bool of_whole_mission(const Fault& fault) {
  return std::holds_alternative<ClockOff>(fault.what) ||
         std::holds_alternative<OtherRelease>(fault.what);
}

/// Whom a fault is done to, and who of several has to be chosen by.
struct Whom {
  const std::vector<VehicleId>* who = nullptr;
  std::uint64_t pick = 0;
};
Whom whom(const Fault& fault) {
  if (const auto* ended = std::get_if<ProgramsEnd>(&fault.what)) return {&ended->who, ended->pick};
  if (const auto* still = std::get_if<ProgramsStall>(&fault.what))
    return {&still->who, still->pick};
  if (const auto* taken = std::get_if<PilotsTake>(&fault.what)) return {&taken->who, taken->pick};
  return {};
}

}  // namespace

FaultTimeline::FaultTimeline(const std::vector<Fault>& faults) {
  for (const Fault& fault : faults) {
    if (of_whole_mission(fault)) continue;
    coming_.push_back({fault, std::nullopt, {}, false});
    const When& when = fault.when;
    if (when.change || when.role) continue;
    quiet_from_ = std::max(quiet_from_, when.not_before + when.after);
  }
}

void FaultTimeline::plan(Coming& coming, Instant now, const Having& having) const {
  const When& when = coming.fault.when;
  const Whom named = whom(coming.fault);
  if (named.who != nullptr) coming.who = *named.who;
  if (when.role) {
    const auto candidates = having(*when.role);
    if (candidates.empty()) return;
    if (coming.who.empty()) coming.who = {candidates[named.pick % candidates.size()]};
    coming.at = now + when.after;
  } else if (when.change) {
    if (*when.change < changes_.size()) coming.at = changes_[*when.change] + when.after;
  } else {
    coming.at = when.not_before + when.after;
  }
}

void FaultTimeline::play(Instant now, const Having& having, const Begin& begin) {
  radio_changed_ = false;
  for (Coming& coming : coming_) {
    const Fault& fault = coming.fault;
    if (now < fault.when.not_before) continue;
    coming.over = fault.when.not_after && now >= *fault.when.not_after;
    if (coming.over) continue;
    if (!coming.at) plan(coming, now, having);
    if (!coming.at || now < *coming.at || !begin(fault, coming.who)) continue;
    coming.over = true;
    if (fault.lasts) quiet_from_ = std::max(quiet_from_, now + *fault.lasts);
    if (!of_radio(fault)) continue;
    active_.push_back({fault, fault.lasts ? *coming.at + *fault.lasts : Instant::max()});
    radio_changed_ = true;
  }
  std::erase_if(coming_, [](const Coming& coming) { return coming.over; });
  update_radio(now);
}

void FaultTimeline::update_radio(Instant now) {
  const auto ended = [now](const Active& active) { return active.until <= now; };
  radio_changed_ = std::erase_if(active_, ended) > 0 || radio_changed_;
  if (!radio_changed_) return;
  interference_ = {};
  for (const Active& active : active_) {
    if (const auto* cut = std::get_if<radio::Cut>(&active.fault.what)) {
      interference_.cuts.push_back(*cut);
    } else if (const auto* worse = std::get_if<radio::Disturbance>(&active.fault.what)) {
      interference_.disturbance.add(*worse);
    } else if (const auto* flood = std::get_if<radio::Flood>(&active.fault.what)) {
      interference_.floods.push_back(*flood);
    } else {
      interference_.healed = true;
    }
  }
}

}  // namespace skein::hil
