// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/shown_state.hpp"

#include <algorithm>

#include "skein/mission/fleet.hpp"

namespace skein::mission {
namespace {

ShownState of_activity(Activity activity) {
  // In the order of Activity.
  static constexpr std::array kStates{
      ShownState::searching, ShownState::surveying,   ShownState::leading, ShownState::bidding,
      ShownState::executing, ShownState::monitoring,  ShownState::holding, ShownState::forming,
      ShownState::en_route,  ShownState::standing_by, ShownState::landing, ShownState::landed};
  static_assert(kStates.size() == static_cast<std::size_t>(Activity::count));
  return kStates.at(static_cast<std::size_t>(activity));
}

}  // namespace

std::string_view to_string(ShownState state) {
  static constexpr std::array<std::string_view, static_cast<std::size_t>(ShownState::count)> kNames{
      "silent",
      "on_the_ground",
      "waiting_for_the_start",
      "taking_off",
      "searching",
      "surveying",
      "leading",
      "bidding",
      "waiting_for_authorisation",
      "delivering",
      "assessing",
      "executing",
      "too_late_for_its_task",
      "monitoring",
      "holding",
      "holding_by_order",
      "not_worked_with",
      "returning",
      "at_home",
      "range_reserve",
      "back_into_its_fence",
      "forming",
      "en_route",
      "standing_by",
      "landing",
      "landed",
      "keeping_clear_of_traffic",
      "piloted"};
  return kNames.at(static_cast<std::size_t>(state));
}

std::string words_of(ShownState state) {
  std::string words{to_string(state)};
  std::ranges::replace(words, '_', ' ');
  return words;
}

ShownState shown_state(Activity activity, ActivityDetail in_detail) {
  // In the order of ActivityDetail, from the one after `none` on.
  static constexpr std::array kStates{ShownState::on_the_ground,
                                      ShownState::waiting_for_the_start,
                                      ShownState::taking_off,
                                      ShownState::landing,
                                      ShownState::waiting_for_authorisation,
                                      ShownState::delivering,
                                      ShownState::assessing,
                                      ShownState::too_late_for_its_task,
                                      ShownState::holding_by_order,
                                      ShownState::returning,
                                      ShownState::at_home,
                                      ShownState::range_reserve,
                                      ShownState::back_into_its_fence,
                                      ShownState::not_worked_with,
                                      ShownState::keeping_clear_of_traffic,
                                      ShownState::piloted};
  static_assert(kStates.size() + 1 == static_cast<std::size_t>(ActivityDetail::count));
  if (in_detail == ActivityDetail::none) return of_activity(activity);
  return kStates.at(static_cast<std::size_t>(in_detail) - 1);
}

bool is_piloted(const Telemetry& telemetry) {
  return shown_state(telemetry.activity, telemetry.detail) == ShownState::piloted;
}

ShownState shown_state(const FleetEntry& entry) {
  const Telemetry& told = *entry.telemetry;
  const ActivityDetail in_detail = told.detail;
  if (in_detail == ActivityDetail::avoiding_traffic && told.activity == Activity::holding) {
    if (entry.obeys == CommandKind::hold) return ShownState::holding_by_order;
    if (entry.obeys == CommandKind::return_home) return ShownState::returning;
  }
  return shown_state(told.activity, in_detail);
}

bool keeps_clear_besides(const FleetEntry& entry) {
  if (!entry.telemetry) return false;
  const ActivityDetail in_detail = entry.telemetry->detail;
  return in_detail == ActivityDetail::avoiding_traffic &&
         shown_state(entry) != ShownState::keeping_clear_of_traffic;
}

}  // namespace skein::mission
