// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "skein/base/ids.hpp"
#include "skein/base/time.hpp"
#include "skein/checks/run_record.hpp"
#include "skein/coalition/messages.hpp"
#include "skein/domain/task.hpp"

namespace skein::checks {

/// One vehicle at one task, once, as its events tell.
struct TaskRun {
  TaskId task;
  VehicleId vehicle;
  coalition::Round round;  ///< in force when it began
  std::optional<Instant> started;
  std::optional<Instant> done;
  bool failed = false;
  std::optional<Instant> planned;  ///< over the site (delivery) or start of the arc
  bool cut_off = false;            ///< its agent ended before it did
  bool lease_lost = false;         ///< an assessment's lease ended while it was flown

  /// Begun and not given up. A delivery of which no end was recorded counts as flown.
  [[nodiscard]] bool flown() const { return !failed; }
  /// The earliest moment that is known of it.
  [[nodiscard]] Instant begin() const { return started ? *started : *done; }
};

/// Every run of every vehicle, by begin, then vehicle.
[[nodiscard]] std::vector<TaskRun> task_runs(const RunRecord& record);

/// A vehicle's right and duty to do a task, from its grant to its end or expiry.
struct Lease {
  VehicleId vehicle;
  TaskId task;
  coalition::CoalitionId coalition;
  Instant from{};
  Instant until{};
};
/// Renewals joined. A lease ends early when the member says so, when its task is done or given up,
/// and when a new agent without memory starts on the vehicle.
[[nodiscard]] std::vector<Lease> leases(const RunRecord& record);

}  // namespace skein::checks
