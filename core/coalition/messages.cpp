// SPDX-License-Identifier: Apache-2.0
#include "skein/coalition/messages.hpp"

#include <array>

namespace skein::coalition {

std::string_view to_string(TaskState state) {
  static constexpr std::array<std::string_view, 5> kNames{"planned", "started", "done", "failed",
                                                          "unknown"};
  static_assert(kNames.size() == static_cast<std::size_t>(TaskState::count));
  return kNames.at(static_cast<std::size_t>(state));
}

std::string_view to_string(Reason reason) {
  static constexpr std::array<std::string_view, 37> kNames{"none",
                                                           "held_by_operator",
                                                           "id_in_use",
                                                           "surveying",
                                                           "leading",
                                                           "task_in_progress",
                                                           "out_of_range",
                                                           "incapable",
                                                           "out_of_reach",
                                                           "one_task_at_a_time",
                                                           "path_too_long",
                                                           "no_path",
                                                           "sent_home",
                                                           "path_barred",
                                                           "new_round",
                                                           "bid_again",
                                                           "not_needed",
                                                           "award_too_late",
                                                           "no_award",
                                                           "no_successor",
                                                           "lease_ran_out",
                                                           "task_done",
                                                           "task_failed",
                                                           "owners_silent",
                                                           "electors_silent",
                                                           "no_allocation",
                                                           "allocation_too_late",
                                                           "award_refused",
                                                           "not_confirmed",
                                                           "tasks_open",
                                                           "owner_failed",
                                                           "owner_silent",
                                                           "superseded",
                                                           "no_decision",
                                                           "refused_by_operator",
                                                           "yields",
                                                           "site_done"};
  static_assert(kNames.size() == static_cast<std::size_t>(Reason::count));
  return kNames.at(static_cast<std::size_t>(reason));
}

}  // namespace skein::coalition
