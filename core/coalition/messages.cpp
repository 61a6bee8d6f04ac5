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

}  // namespace skein::coalition
