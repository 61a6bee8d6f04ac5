// SPDX-License-Identifier: Apache-2.0
#include "skein/domain/autopilot_notice.hpp"

#include <array>

namespace skein {

std::string_view to_string(AutopilotNews news) {
  static constexpr std::array<std::string_view, static_cast<std::size_t>(AutopilotNews::count)>
      kNames{"rebooted",        "looked_for",     "gone",           "found",
             "ready",           "disarmed",       "not_armed",      "launch_broken_off",
             "taking_off",      "landing",        "flying",         "mode_changed",
             "armed_by_others", "not_obeying",    "not_climbed",    "no_frames",
             "silent",          "duplicate_node", "not_given_back", "given_back_landed",
             "other_system",    "wrong_make",     "wrong_airframe", "old_firmware",
             "firmware",        "text",           "command_refused"};
  const auto i = static_cast<std::size_t>(news);
  return i < kNames.size() ? kNames[i] : "unknown";
}

std::string_view to_string(Given given) {
  static constexpr std::array<std::string_view, static_cast<std::size_t>(Given::count)> kNames{
      "yes", "taken_by_others", "launch_spent"};
  const auto i = static_cast<std::size_t>(given);
  return i < kNames.size() ? kNames[i] : "unknown";
}

std::string_view to_string(GiveBackRefusal why) {
  static constexpr std::array<std::string_view, static_cast<std::size_t>(GiveBackRefusal::count)>
      kNames{"none",        "node_still_duplicate", "wrong_state",
             "taken_since", "no_position",          "not_flying"};
  const auto i = static_cast<std::size_t>(why);
  return i < kNames.size() ? kNames[i] : "unknown";
}

}  // namespace skein
