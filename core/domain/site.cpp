// SPDX-License-Identifier: Apache-2.0
#include "skein/domain/site.hpp"

namespace skein {

std::size_t Site::task_count(TaskKind kind) const {
  switch (kind) {
    case TaskKind::survey:
      return 1;
    case TaskKind::deliver:
      return deliveries.size();
    case TaskKind::assess:
      return assessments.size();
    case TaskKind::count:
      break;
  }
  return 0;
}

double Site::total_reward() const {
  return reward * static_cast<double>(1 + deliveries.size() + assessments.size());
}

std::vector<TaskId> Site::tasks_after_survey() const {
  std::vector<TaskId> tasks;
  tasks.reserve(deliveries.size() + assessments.size());
  for (const TaskKind kind : {TaskKind::deliver, TaskKind::assess}) {
    for (std::size_t i = 0; i < task_count(kind); ++i) {
      tasks.push_back({id, kind, static_cast<std::uint8_t>(i)});
    }
  }
  return tasks;
}

}  // namespace skein
