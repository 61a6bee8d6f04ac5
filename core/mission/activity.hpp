// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "failsafe.hpp"
#include "skein/mission/messages.hpp"

namespace skein::mission {

/// The states of a vehicle's parts, as far as they make its activity.
struct PartStates {
  Failsafe::Action failsafe = Failsafe::Action::none;
  bool lands = false;   ///< comes down by order, or has
  bool landed = false;  ///< and is on the ground
  bool has_task = false;
  bool leads = false;
  bool monitors = false;  ///< leads, and waits before its next round
  bool scouts = false;
  bool bids = false;  ///< or is in a coalition
  bool en_route = false;
  bool stands_by = false;  ///< in a relay orbit
};

struct ActivityRule {
  bool (*holds)(const PartStates&);
  Activity activity;
};
/// Earlier entries take precedence; where none holds, a vehicle is searching.
inline constexpr std::array kActivityRules{
    ActivityRule{[](const PartStates& s) { return s.landed; }, Activity::landed},
    ActivityRule{[](const PartStates& s) { return s.lands; }, Activity::landing},
    ActivityRule{[](const PartStates& s) { return s.failsafe == Failsafe::Action::obey; },
                 Activity::holding},
    ActivityRule{[](const PartStates& s) {
                   const bool leaves_work = s.failsafe == Failsafe::Action::stay ||
                                            s.failsafe == Failsafe::Action::come_home;
                   return leaves_work && !s.has_task && !s.leads;
                 },
                 Activity::holding},
    ActivityRule{[](const PartStates& s) { return s.has_task; }, Activity::executing},
    ActivityRule{[](const PartStates& s) { return s.monitors; }, Activity::monitoring},
    ActivityRule{[](const PartStates& s) { return s.leads; }, Activity::leading},
    ActivityRule{[](const PartStates& s) { return s.scouts; }, Activity::surveying},
    ActivityRule{[](const PartStates& s) { return s.bids; }, Activity::bidding},
    ActivityRule{[](const PartStates& s) { return s.en_route; }, Activity::en_route},
    ActivityRule{[](const PartStates& s) { return s.stands_by; }, Activity::standing_by},
};

[[nodiscard]] constexpr Activity activity_of(const PartStates& states) {
  for (const ActivityRule& rule : kActivityRules) {
    if (rule.holds(states)) return rule.activity;
  }
  return Activity::searching;
}

}  // namespace skein::mission
