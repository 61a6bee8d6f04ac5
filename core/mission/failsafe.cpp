// SPDX-License-Identifier: Apache-2.0
#include "failsafe.hpp"

namespace skein::mission {

std::string_view to_string(Failsafe::Action action) {
  static constexpr std::array<std::string_view, 4> kNames{"none", "take_up_nothing", "come_home",
                                                          "obey"};
  static_assert(kNames.size() == static_cast<std::size_t>(Failsafe::Action::count));
  return kNames.at(static_cast<std::size_t>(action));
}

std::string failsafe_document() {
  std::string text = "| fact | action | it neither bids nor leads: |\n|---|---|---|\n";
  for (const Failsafe::Rule& rule : Failsafe::kRules) {
    text += "| `" + std::string{rule.fact} + "` | `" + std::string{to_string(rule.action)} +
            "` | `" + std::string{coalition::to_string(rule.reason)} + "` |\n";
  }
  return text;
}

}  // namespace skein::mission
