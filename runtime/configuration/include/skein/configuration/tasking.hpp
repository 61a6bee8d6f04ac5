// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "skein/base/geometry.hpp"
#include "skein/base/ids.hpp"
#include "skein/base/result.hpp"
#include "skein/coupled/criterion.hpp"
#include "skein/domain/task.hpp"

namespace skein::configuration {

struct Scenario;

inline constexpr std::array<std::string_view, 3> kCriteria{"reward", "completion", "makespan"};

/// What of a mission is tasked before take-off (docs/tasking.md).
struct TaskingConfig {
  std::vector<SiteId> known;     ///< none: nothing is
  std::vector<SiteId> optional;  ///< of those, what may be left out
  planning::Criterion criterion = planning::Criterion::makespan;
};

/// A task as planned; mission time. It is no award: who does it is found out by bids.
struct PlannedTask {
  TaskId task;
  double begins_s = 0.0;
  double ends_s = 0.0;
};

/// One vehicle's part of a plan.
struct VehicleTasks {
  VehicleId vehicle;
  std::vector<Vec2> search;  ///< in place of its search route; where it is when its tasks begin
  std::vector<PlannedTask> tasks;
};

/// A plan of tasks, as a file.
struct TaskingPlan {
  std::string title;
  planning::Criterion criterion = planning::Criterion::makespan;
  double objective = 0.0;  ///< by the criterion: a share of all reward, or seconds
  double bound = 0.0;      ///< no plan is better
  bool proven = false;     ///< it is the best
  std::vector<SiteId> left_out;
  std::vector<VehicleTasks> vehicles;
};

/// Gives the vehicles the plan's search routes. Fails for a plan of vehicles or sites that the
/// scenario does not have.
[[nodiscard]] Result<void> give_tasks(const TaskingPlan& plan, Scenario& scenario);

/// As load_route_plan() and those after it (routes_config.hpp).
[[nodiscard]] Result<TaskingPlan> load_tasking_plan(const std::filesystem::path& file);
[[nodiscard]] Result<TaskingPlan> parse_tasking_plan(std::string_view yaml,
                                                     const std::string& name);
[[nodiscard]] std::string to_yaml(const TaskingPlan& plan);

}  // namespace skein::configuration
