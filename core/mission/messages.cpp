// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/messages.hpp"

#include <array>

namespace skein::mission {

std::string_view to_string(Activity activity) {
  static constexpr std::array<std::string_view, 9> kNames{"searching", "surveying", "leading",
                                                          "bidding",   "executing", "monitoring",
                                                          "holding",   "forming",   "en_route"};
  static_assert(kNames.size() == static_cast<std::size_t>(Activity::count));
  const auto i = static_cast<std::size_t>(activity);
  return i < kNames.size() ? kNames[i] : "unknown";
}

std::string_view to_string(EventKind kind) {
  static constexpr std::array<std::string_view, 34> kNames{"site_detected",
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
                                                           "plan_changed",
                                                           "hazard_known",
                                                           "conflict_yielded",
                                                           "monitoring",
                                                           "leader_replaced",
                                                           "site_done",
                                                           "change_begun",
                                                           "place_reached",
                                                           "formation_held",
                                                           "script_done",
                                                           "warning"};
  static_assert(kNames.size() == static_cast<std::size_t>(EventKind::count));
  const auto i = static_cast<std::size_t>(kind);
  return i < kNames.size() ? kNames[i] : "unknown";
}

std::string_view to_string(CommandKind kind) {
  static constexpr std::array<std::string_view, 4> kNames{"hold", "resume", "return_home",
                                                          "give_back"};
  static_assert(kNames.size() == static_cast<std::size_t>(CommandKind::count));
  const auto i = static_cast<std::size_t>(kind);
  return i < kNames.size() ? kNames[i] : "unknown";
}

}  // namespace skein::mission
