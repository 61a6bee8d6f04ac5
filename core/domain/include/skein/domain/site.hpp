// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "skein/domain/task.hpp"
#include "skein/idl/domain.hpp"

namespace skein {

[[nodiscard]] std::size_t task_count(const Site& site, TaskKind kind);
/// Every task but the survey, in order: deliveries, then assessments.
[[nodiscard]] std::vector<TaskId> tasks_after_survey(const Site& site);

}  // namespace skein
