// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "failsafe.hpp"
#include "skein/mission/messages.hpp"

namespace skein::mission {

/// The states of a vehicle's parts, as far as they make its activity.
struct PartStates {
  Failsafe::Action failsafe = Failsafe::Action::none;
  bool piloted = false;  ///< others fly it
  bool lands = false;    ///< comes down, or has
  bool landed = false;   ///< and is on the ground
  bool has_task = false;
  bool leads = false;
  bool monitors = false;  ///< leads, and waits before its next round
  bool scouts = false;
  bool bids = false;  ///< or is in a coalition
  bool en_route = false;
  bool stands_by = false;  ///< in a relay orbit
  // What tells an activity apart further.
  bool on_ground = false;  ///< as its flight controller has it
  bool takes_off = false;
  bool begun = true;  ///< its flight
  bool homes = false;
  bool at_home = false;
  bool range_spent = false;
  bool delivers = false;         ///< its task is a delivery
  bool awaits_decision = false;  ///< of that, or of the deliveries that it leads
  bool late = false;             ///< for its task
  bool avoids_traffic = false;   ///< by its height
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

struct DetailRule {
  bool (*holds)(const PartStates&);
  ActivityDetail detail;
};
/// Earlier entries take precedence; where none holds, the activity says it all.
inline constexpr std::array kDetailRules{
    DetailRule{[](const PartStates& s) { return s.landed; }, ActivityDetail::none},
    DetailRule{[](const PartStates& s) { return s.on_ground; }, ActivityDetail::on_ground},
    DetailRule{[](const PartStates& s) { return s.piloted; }, ActivityDetail::piloted},
    DetailRule{[](const PartStates& s) { return s.lands; }, ActivityDetail::none},
    DetailRule{[](const PartStates& s) { return s.takes_off; }, ActivityDetail::taking_off},
    DetailRule{[](const PartStates& s) { return !s.begun; }, ActivityDetail::not_begun},
    DetailRule{[](const PartStates& s) { return s.avoids_traffic; },
               ActivityDetail::avoiding_traffic},
    DetailRule{[](const PartStates& s) { return s.homes && s.at_home; }, ActivityDetail::at_home},
    DetailRule{[](const PartStates& s) { return s.failsafe == Failsafe::Action::obey && s.homes; },
               ActivityDetail::returning},
    DetailRule{[](const PartStates& s) { return s.failsafe == Failsafe::Action::obey; },
               ActivityDetail::ordered},
    DetailRule{[](const PartStates& s) { return s.late; }, ActivityDetail::late},
    DetailRule{[](const PartStates& s) { return s.has_task && s.awaits_decision; },
               ActivityDetail::awaiting_decision},
    DetailRule{[](const PartStates& s) { return s.has_task && s.delivers; },
               ActivityDetail::delivering},
    DetailRule{[](const PartStates& s) { return s.has_task; }, ActivityDetail::assessing},
    DetailRule{[](const PartStates& s) { return s.failsafe == Failsafe::Action::stay; },
               ActivityDetail::barred},
    DetailRule{[](const PartStates& s) {
                 return s.failsafe == Failsafe::Action::come_home && s.range_spent;
               },
               ActivityDetail::range_reserve},
    DetailRule{[](const PartStates& s) { return s.failsafe == Failsafe::Action::come_home; },
               ActivityDetail::left_fence},
    DetailRule{[](const PartStates& s) { return s.awaits_decision; },
               ActivityDetail::awaiting_decision},
};

[[nodiscard]] constexpr ActivityDetail detail_of(const PartStates& states) {
  for (const DetailRule& rule : kDetailRules) {
    if (rule.holds(states)) return rule.detail;
  }
  return ActivityDetail::none;
}

[[nodiscard]] constexpr Activity activity_of(const PartStates& states) {
  for (const ActivityRule& rule : kActivityRules) {
    if (rule.holds(states)) return rule.activity;
  }
  return Activity::searching;
}

}  // namespace skein::mission
