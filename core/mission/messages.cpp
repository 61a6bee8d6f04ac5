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

}  // namespace skein::mission
