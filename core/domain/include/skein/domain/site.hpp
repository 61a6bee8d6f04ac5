// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "skein/base/geometry.hpp"
#include "skein/base/ids.hpp"
#include "skein/base/time.hpp"
#include "skein/domain/task.hpp"

namespace skein {

/// An arc around the site for at least `dwell` (Wang 2022, eq. 16), from `start_angle_rad`: the
/// direction of the vehicle as seen from the site. Without an angle the vehicle starts where it
/// gets there soonest.
struct ArcRequirement {
  std::optional<double> start_angle_rad;
  Duration dwell{};
};

/// One overflight of the site: `bearing_rad` is the direction of travel on arrival, `offset` counts
/// from the first delivery of the site (all zero: simultaneous arrival).
struct DeliveryRequirement {
  double bearing_rad = 0.0;
  Duration offset{};
};

inline constexpr std::size_t kTasksPerKindMax = 16;  ///< per site

/// A fixed place with tasks to do (Wang 2022, eq. 5), reported by an operator or a survey sensor.
struct Site {
  SiteId id;
  Vec2 position{0.0, 0.0};
  ArcRequirement survey;
  std::vector<DeliveryRequirement> deliveries;  ///< at most kTasksPerKindMax
  Duration assess_wait{};                       ///< from the last delivery to the first assessment
  std::vector<ArcRequirement> assessments;      ///< at most kTasksPerKindMax
  double reward = 1.0;                          ///< F of each task (eq. 9)
  double reward_decay_per_s = 0.0;              ///< beta (eq. 9)

  [[nodiscard]] std::size_t task_count(TaskKind kind) const;
  /// The reward of all its tasks together, as announced (eq. 19).
  [[nodiscard]] double total_reward() const;
  /// Every task but the survey, in order: deliveries, then assessments.
  [[nodiscard]] std::vector<TaskId> tasks_after_survey() const;
};

}  // namespace skein
