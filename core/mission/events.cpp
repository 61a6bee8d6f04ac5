// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/events.hpp"

#include <array>
#include <utility>

#include "skein/base/assert.hpp"

namespace skein::mission {
namespace event {

std::string_view to_string(Lateness why) {
  static constexpr std::array<std::string_view, static_cast<std::size_t>(Lateness::count)> kNames{
      "no_decision", "not_authorised", "lease_too_short", "not_certain"};
  const auto i = static_cast<std::size_t>(why);
  return i < kNames.size() ? kNames[i] : "unknown";
}

std::string_view to_string(TaskFailure why) {
  static constexpr std::array<std::string_view, static_cast<std::size_t>(TaskFailure::count)>
      kNames{"no_plan", "out_of_range", "path_too_long", "off_path", "released_within"};
  const auto i = static_cast<std::size_t>(why);
  return i < kNames.size() ? kNames[i] : "unknown";
}

std::string_view to_string(Trouble trouble) {
  static constexpr std::array<std::string_view, static_cast<std::size_t>(Trouble::count)> kNames{
      "untimely", "route_not_flown", "id_in_use"};
  const auto i = static_cast<std::size_t>(trouble);
  return i < kNames.size() ? kNames[i] : "unknown";
}

std::string_view to_string(FleetNews news) {
  static constexpr std::array<std::string_view, static_cast<std::size_t>(FleetNews::count)> kNames{
      "stranger", "duplicate", "unique", "restarted", "silent", "heard_again"};
  const auto i = static_cast<std::size_t>(news);
  return i < kNames.size() ? kNames[i] : "unknown";
}

std::string_view to_string(ChangeRefusal why) {
  static constexpr std::array<std::string_view, static_cast<std::size_t>(ChangeRefusal::count)>
      kNames{"another_is_flown", "too_fast", "begins_elsewhere"};
  const auto i = static_cast<std::size_t>(why);
  return i < kNames.size() ? kNames[i] : "unknown";
}

std::string_view to_string(WaitsFor what) {
  static constexpr std::array<std::string_view, static_cast<std::size_t>(WaitsFor::count)> kNames{
      "order", "beginning", "passing"};
  const auto i = static_cast<std::size_t>(what);
  return i < kNames.size() ? kNames[i] : "unknown";
}

std::string_view to_string(FormationNews news) {
  static constexpr std::array<std::string_view, static_cast<std::size_t>(FormationNews::count)>
      kNames{"lost", "lost_on_its_way", "back", "not_begun", "drift_corrected", "awaited"};
  const auto i = static_cast<std::size_t>(news);
  return i < kNames.size() ? kNames[i] : "unknown";
}

}  // namespace event

std::string_view to_string(CommandKind kind) {
  static constexpr std::array<std::string_view, static_cast<std::size_t>(CommandKind::count)>
      kNames{"hold", "resume", "return_home", "give_back"};
  const auto i = static_cast<std::size_t>(kind);
  return i < kNames.size() ? kNames[i] : "unknown";
}

std::string_view to_string(OrderKind kind) {
  static constexpr std::array<std::string_view, static_cast<std::size_t>(OrderKind::count)> kNames{
      "take_off", "rally", "form", "land"};
  const auto i = static_cast<std::size_t>(kind);
  return i < kNames.size() ? kNames[i] : "unknown";
}

std::string_view to_string(EventKind kind) {
  static constexpr std::array<std::string_view, static_cast<std::size_t>(EventKind::count)> kNames{
      "site_detected",
      "survey_started",
      "survey_done",
      "announced",
      "bid_sent",
      "bid_declined",
      "allocation_done",
      "allocation_failed",
      "awarded",
      "confirmed",
      "refused",
      "coalition_formed",
      "cancelled",
      "released",
      "lease_granted",
      "lease_ended",
      "authorisation_requested",
      "authorised",
      "authorisation_refused",
      "authorisation_late",
      "task_started",
      "task_done",
      "task_failed",
      "commanded",
      "plan_retimed",
      "plan_detoured",
      "range_spent",
      "relief_begun",
      "hazard_known",
      "conflict_yielded",
      "monitoring",
      "leader_replaced",
      "site_done",
      "change_begun",
      "change_taken_up",
      "place_reached",
      "formation_held",
      "script_done",
      "task_lost",
      "task_unknown",
      "vehicle_trouble",
      "fleet_warning",
      "change_refused",
      "waiting",
      "formation_warning",
      "order_waits",
      "flight_warning"};
  const auto i = static_cast<std::size_t>(kind);
  return i < kNames.size() ? kNames[i] : "unknown";
}

namespace {
template <std::size_t Index = 0>
EventBody body_at(std::size_t kind) {
  if constexpr (Index + 1 < std::variant_size_v<EventBody>) {
    if (kind != Index) return body_at<Index + 1>(kind);
  }
  return EventBody{std::in_place_index<Index>};
}
}  // namespace

EventBody body_of(EventKind kind) {
  SKEIN_ASSERT(kind < EventKind::count);
  return body_at(static_cast<std::size_t>(kind));
}

}  // namespace skein::mission
