// SPDX-License-Identifier: Apache-2.0
#include "skein/domain/site.hpp"

namespace skein {

std::size_t task_count(const Site& site, TaskKind kind) {
  switch (kind) {
    case TaskKind::survey:
      return 1;
    case TaskKind::deliver:
      return site.deliveries.size();
    case TaskKind::assess:
      return site.assessments.size();
    case TaskKind::count:
      break;
  }
  return 0;
}

std::vector<TaskId> tasks_after_survey(const Site& site) {
  std::vector<TaskId> tasks;
  tasks.reserve(site.deliveries.size() + site.assessments.size());
  for (const TaskKind kind : {TaskKind::deliver, TaskKind::assess}) {
    for (std::size_t i = 0; i < task_count(site, kind); ++i) {
      tasks.push_back({site.id, kind, static_cast<std::uint8_t>(i)});
    }
  }
  return tasks;
}

}  // namespace skein
