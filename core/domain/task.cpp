// SPDX-License-Identifier: Apache-2.0
#include "skein/domain/task.hpp"

namespace skein {

std::string to_string(const TaskId& task) {
  std::string text = "site " + std::to_string(task.site.value) + " ";
  text += to_string(task.kind);
  return task.kind == TaskKind::survey ? text : text + " " + std::to_string(task.index + 1);
}

}  // namespace skein
