// SPDX-License-Identifier: Apache-2.0
#include "skein/planning/plan_value.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "skein/base/assert.hpp"
#include "skein/planning/allocation.hpp"
#include "skein/planning/task_path.hpp"

namespace skein::planning {
namespace {

const Candidate& candidate_of(const AllocationProblem& problem, VehicleId id) {
  const auto found = std::find_if(problem.candidates.begin(), problem.candidates.end(),
                                  [id](const Candidate& c) { return c.id == id; });
  SKEIN_ASSERT(found != problem.candidates.end());
  return *found;
}

double completion_s(const AllocationProblem& problem, const TaskAssignment& a) {
  const double time_s = to_seconds(a.time - problem.start);
  if (a.task.kind != TaskKind::assess) return time_s;
  const Candidate& vehicle = candidate_of(problem, a.vehicle);
  const TaskPath arc = arc_path(problem.site, 0.0, problem.site.assessments.at(a.task.index).dwell,
                                vehicle.assess_radius_m, vehicle.speed_mps, 1);
  return time_s + arc.run.length_m / vehicle.speed_mps;
}

double ratio(double part, double whole) { return whole > 0.0 ? part / whole : 0.0; }

}  // namespace

PlanValue value_of(const ValueWeights& weights, const AllocationProblem& problem,
                   std::span<const TaskAssignment> assignments) {
  const Site& site = problem.site;
  std::optional<Instant> common;
  for (const TaskAssignment& a : assignments) {
    if (a.task.kind != TaskKind::deliver) continue;
    const Instant base = a.time - site.deliveries.at(a.task.index).offset;
    common = std::max(common.value_or(base), base);
  }
  Instant last_delivery = problem.deliveries_done;
  for (const TaskAssignment& a : assignments) {
    if (a.task.kind == TaskKind::deliver) last_delivery = std::max(last_delivery, a.time);
  }
  const Instant assess_at = std::max(problem.start, last_delivery + site.assess_wait);

  PlanValue value;
  double range_m = 0.0;
  for (const Candidate& c : problem.candidates) range_m += c.range_left_m;
  value.range_left_m = range_m;
  for (const TaskAssignment& a : assignments) {
    const double done_s = completion_s(problem, a);
    value.reward += site.reward * std::exp(-site.reward_decay_per_s * done_s);
    value.range_left_m -= candidate_of(problem, a.vehicle).speed_mps * done_s;
    const Instant required = a.task.kind == TaskKind::deliver
                                 ? *common + site.deliveries.at(a.task.index).offset
                                 : assess_at;
    value.timing_error_s += std::abs(to_seconds(a.time - required));
  }
  const auto tasks = static_cast<double>(problem.open_tasks.size());
  value.reward_share = ratio(value.reward, site.reward * tasks);
  value.range_share = ratio(value.range_left_m, range_m);
  value.timing_share = ratio(value.timing_error_s, to_seconds(weights.timing_reference) * tasks);
  value.total = weights.reward * value.reward_share + weights.range * value.range_share -
                weights.timing * value.timing_share;
  return value;
}

}  // namespace skein::planning
