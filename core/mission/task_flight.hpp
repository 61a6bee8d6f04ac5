// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "skein/coalition/messages.hpp"
#include "skein/domain/site.hpp"
#include "skein/domain/task.hpp"
#include "skein/planning/allocation.hpp"

namespace skein::mission {

/// An awarded task on its way: what is flown when, and how far it has come.
struct TaskFlight {
  coalition::Round round;
  Site site;
  TaskAssignment assignment;
  planning::TaskPlan plan;
  bool authorised = false;  ///< the operator has granted this round (deliveries only)
  bool committed = false;   ///< the flight plan now leads past the gate
  bool begun = false;       ///< the gate or the start of the arc has been passed
  bool late = false;        ///< the gate was reached without being committed
  bool untimely = false;    ///< it has been told that the wind does not let it be on time

  [[nodiscard]] bool is_delivery() const { return assignment.task.kind == TaskKind::deliver; }
  /// When the task's own run begins: the gate of a delivery, the entry of an arc.
  [[nodiscard]] Instant begin_time() const {
    return plan.timed.start_time + from_seconds(plan.gate_m / plan.timed.speed_mps);
  }
  [[nodiscard]] Instant end_time() const { return plan.timed.end_time(); }
};

/// A survey on its way, or (`relief`) a flight to a surveyed site whose leader is lost.
struct SurveyFlight {
  Site site;
  planning::TaskPlan plan;
  bool relief = false;
  bool begun = false;

  [[nodiscard]] Instant begin_time() const {
    return plan.timed.start_time + from_seconds(plan.gate_m / plan.timed.speed_mps);
  }
  [[nodiscard]] Instant end_time() const { return plan.timed.end_time(); }
};

}  // namespace skein::mission
