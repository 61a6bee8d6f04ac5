// SPDX-License-Identifier: Apache-2.0
#include "skein/domain/task.hpp"

#include <array>

namespace skein {

std::string_view to_string(TaskKind kind) {
  static constexpr std::array<std::string_view, 3> kNames{"survey", "deliver", "assess"};
  static_assert(kNames.size() == static_cast<std::size_t>(TaskKind::count));
  const auto i = static_cast<std::size_t>(kind);
  return i < kNames.size() ? kNames[i] : "unknown";
}

std::string to_string(const TaskId& task) {
  std::string text = "site " + std::to_string(task.site.value) + " ";
  text += to_string(task.kind);
  return task.kind == TaskKind::survey ? text : text + " " + std::to_string(task.index + 1);
}

}  // namespace skein
