// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "skein/checks/run_record.hpp"
#include "skein/checks/task_runs.hpp"

/// Tasks as the tracks show them, for judging and for reports.
namespace skein::checks {

/// The pass over the site nearest to it, within Limits::delivery_window_s of the planned time.
struct DeliveryFlown {
  TaskRun run;
  Duration offset{};               ///< required, from the site's first delivery
  bool seen = false;               ///< false: the track does not cover the planned time
  Instant time{};                  ///< of the closest approach
  double miss_m = 0.0;             ///< horizontal
  double bearing_error_rad = 0.0;  ///< direction of travel there, less the required bearing
  [[nodiscard]] double time_error_s() const { return to_seconds(time - *run.planned); }
};
/// Of every delivery that was reported done with a planned time, by planned time.
[[nodiscard]] std::vector<DeliveryFlown> deliveries_flown(const RunRecord& record,
                                                          const Limits& limits);
/// The same deliveries, as others' tracks of these vehicles show them.
[[nodiscard]] std::vector<DeliveryFlown> deliveries_flown(
    const RunRecord& record, const std::vector<recording::Recording>& tracks, const Limits& limits);

/// A survey or assessment arc.
struct ArcFlown {
  TaskRun run;
  Duration dwell{};              ///< required
  double radius_m = 0.0;         ///< required
  std::optional<Instant> start;  ///< when the vehicle passed the start angle within the ring
  double dwell_s = 0.0;          ///< time from the start until it left the ring
  double radius_error_m = 0.0;   ///< largest over the required dwell, with sign
  /// Of the start; 0 where no time was planned or no start seen.
  [[nodiscard]] double time_error_s() const {
    return start && run.planned ? to_seconds(*start - *run.planned) : 0.0;
  }
};
/// Of every survey or assessment that was reported done, by begin.
[[nodiscard]] std::vector<ArcFlown> arcs_flown(const RunRecord& record, TaskKind kind,
                                               const Limits& limits);

/// A task that was done, as its track shows it; where that was not seen, as was planned.
struct TaskFlown {
  Instant begin{};  ///< of an arc
  Instant time{};   ///< over the site, or the end of the arc
};
/// The first time that each task was done.
[[nodiscard]] std::map<TaskId, TaskFlown> tasks_flown(const RunRecord& record,
                                                      const Limits& limits);

/// J1 of Wang 2022, eq. (9): of each task of the sites F exp(-beta t), t when it was done.
struct Reward {
  double flown = 0.0;
  double all = 0.0;  ///< the sum of F
};
[[nodiscard]] Reward reward_flown(const std::vector<Site>& sites,
                                  const std::map<TaskId, TaskFlown>& flown);

}  // namespace skein::checks
