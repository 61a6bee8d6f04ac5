// SPDX-License-Identifier: Apache-2.0
#include "task_flight.hpp"

namespace skein::mission {

std::string_view to_string(TaskFlight::State state) {
  static constexpr std::array<std::string_view, 6> kNames{"planned", "authorised", "committed",
                                                          "begun",   "late",       "over"};
  static_assert(kNames.size() == static_cast<std::size_t>(TaskFlight::State::count));
  return kNames.at(static_cast<std::size_t>(state));
}

std::string_view to_string(TaskFlight::Event event) {
  static constexpr std::array<std::string_view, 7> kNames{
      "granted", "passed_on", "committed", "began", "missed", "finished", "dropped"};
  static_assert(kNames.size() == static_cast<std::size_t>(TaskFlight::Event::count));
  return kNames.at(static_cast<std::size_t>(event));
}

}  // namespace skein::mission
