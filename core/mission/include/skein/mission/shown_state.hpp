// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "skein/mission/messages.hpp"

namespace skein::mission {

struct FleetEntry;

/// What a person reads of a vehicle's state. Their names, with spaces, are the words that page and
/// command line show.
enum class ShownState : std::uint8_t {
  silent,
  on_the_ground,
  waiting_for_the_start,
  taking_off,
  searching,
  surveying,
  leading,
  bidding,
  waiting_for_authorisation,
  delivering,
  assessing,
  executing,  ///< one of these, of an older release
  too_late_for_its_task,
  monitoring,
  holding,
  holding_by_order,
  not_worked_with,
  returning,
  at_home,
  range_reserve,
  back_into_its_fence,
  forming,
  en_route,
  standing_by,
  landing,
  landed,
  keeping_clear_of_traffic,
  piloted,  ///< or flown by a failsafe of its autopilot
  count
};
[[nodiscard]] std::string_view to_string(ShownState state);
/// "range reserve"
[[nodiscard]] std::string words_of(ShownState state);

/// As a vehicle has told it last.
[[nodiscard]] ShownState shown_state(Activity activity, ActivityDetail in_detail);
/// By its own word others fly it.
[[nodiscard]] bool is_piloted(const Telemetry& telemetry);
/// The same as shown_state() of one that was heard, where it is known what it goes on with after it
/// has kept clear of traffic: that it holds or comes home by order, which lasts longer.
[[nodiscard]] ShownState shown_state(const FleetEntry& entry);
/// It keeps clear of traffic besides what shown_state() says.
[[nodiscard]] bool keeps_clear_besides(const FleetEntry& entry);

}  // namespace skein::mission
