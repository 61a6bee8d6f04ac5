// SPDX-License-Identifier: Apache-2.0
#include "skein/experiments/measures.hpp"

#include <algorithm>
#include <cmath>

#include "skein/checks/flown.hpp"

namespace skein::experiments {
namespace {

using mission::EventKind;

using DoneTasks = std::map<TaskId, checks::TaskFlown>;

/// J3 of one site.
double timing_error_s(const Site& site, const DoneTasks& done) {
  const auto offset = [&](const TaskId& task) { return site.deliveries.at(task.index).offset; };
  std::optional<Instant> first;
  for (const auto& [task, run] : done) {
    if (task.site != site.id || task.kind != TaskKind::deliver) continue;
    const Instant base = run.time - offset(task);
    first = std::min(first.value_or(base), base);
  }
  double sum = 0.0;
  for (const auto& [task, run] : done) {
    if (task.site != site.id || task.kind == TaskKind::survey) continue;
    if (task.kind == TaskKind::deliver) {
      sum += to_seconds(run.time - offset(task) - *first);
      continue;
    }
    std::optional<Instant> last;
    for (const auto& [other, delivery] : done) {
      const bool before =
          other.site == site.id && other.kind == TaskKind::deliver && delivery.time <= run.begin;
      if (before) last = std::max(last.value_or(delivery.time), delivery.time);
    }
    if (last) sum += std::abs(to_seconds(run.begin - *last - site.assess_wait));
  }
  return sum;
}

double share(double part, double whole) { return whole > 0.0 ? part / whole : 0.0; }

planning::PlanValue value_of(const hil::TeamMission& mission, const hil::TeamResult& result,
                             const DoneTasks& done) {
  planning::PlanValue value;
  const checks::Reward reward = checks::reward_flown(mission.sites, done);
  value.reward = reward.flown;
  double tasks = 0.0;
  for (const Site& site : mission.sites) {
    tasks += static_cast<double>(1 + tasks_after_survey(site).size());
    value.timing_error_s += timing_error_s(site, done);
  }
  double range_m = 0.0;
  for (const auto& v : mission.vehicles) range_m += v.spec.range_m;
  for (const auto& end : result.vehicles) value.range_left_m += std::max(0.0, end.range_left_m);

  const planning::ValueWeights& weights = mission.planning.weights;
  value.reward_share = share(value.reward, reward.all);
  value.range_share = share(value.range_left_m, range_m);
  value.timing_share = share(value.timing_error_s, to_seconds(weights.timing_reference) * tasks);
  value.total = weights.reward * value.reward_share + weights.range * value.range_share -
                weights.timing * value.timing_share;
  return value;
}

}  // namespace

const std::array<MeasureColumn, kMeasureColumns>& measure_columns() {
  using M = const Measures&;
  using O = std::optional<double>;
  static constexpr std::array<MeasureColumn, kMeasureColumns> kColumns{{
      {"value", "value J", [](M m) -> O { return m.value.total; }},
      {"reward_share", "reward J1, share of all", [](M m) -> O { return m.value.reward_share; }},
      {"range_share", "range left J2, share of all", [](M m) -> O { return m.value.range_share; }},
      {"timing_share", "timing error J3, share", [](M m) -> O { return m.value.timing_share; }},
      {"reward", "reward J1", [](M m) -> O { return m.value.reward; }},
      {"range_left_m", "range left J2, m", [](M m) -> O { return m.value.range_left_m; }},
      {"timing_error_s", "timing error J3, s", [](M m) -> O { return m.value.timing_error_s; }},
      {"mission_s", "mission time, s (of missions with every task done)",
       [](M m) { return m.mission_s; }},
      {"last_done_s", "last task done, s", [](M m) { return m.last_done_s; }},
      {"tasks_done", "tasks done", [](M m) -> O { return m.tasks_done; }},
      {"sites_done", "sites done", [](M m) -> O { return m.sites_done; }},
      {"coalitions", "coalitions formed", [](M m) -> O { return m.coalitions; }},
      {"attempts_failed", "attempts failed", [](M m) -> O { return m.attempts_failed; }},
      {"messages", "messages sent", [](M m) -> O { return m.messages; }},
      {"safe", "share of missions with every check but completion held",
       [](M m) -> O { return m.safe ? 1.0 : 0.0; }},
  }};
  return kColumns;
}

Measures measures_of(const hil::TeamMission& mission, const checks::RunRecord& record,
                     const checks::Limits& limits, const hil::JudgedRun& run) {
  Measures m;
  const auto done = checks::tasks_flown(record, limits);
  m.value = value_of(mission, run.result, done);
  m.tasks_done = static_cast<double>(done.size());
  for (const Site& site : mission.sites)
    m.tasks += static_cast<double>(1 + tasks_after_survey(site).size());
  for (const auto& [task, flown] : done)
    m.last_done_s = std::max(m.last_done_s.value_or(0.0), to_seconds(flown.time));
  if (m.tasks_done == m.tasks) m.mission_s = m.last_done_s;
  m.sites_done = static_cast<double>(run.result.sites_done);
  m.messages = static_cast<double>(run.result.messages);
  for (const auto& recorded : record.recordings) {
    for (const auto& event : recorded.events) {
      if (event.kind() == EventKind::monitoring) m.attempts_failed += 1.0;
      if (event.kind() != EventKind::coalition_formed) continue;
      m.coalitions += 1.0;
      const auto [known, is_new] = m.formed_s.emplace(event.task.site, to_seconds(event.time));
      if (!is_new) known->second = std::min(known->second, to_seconds(event.time));
    }
  }
  m.safe = true;
  for (const auto& check : run.broken) {
    m.broken.push_back(check.name);
    m.safe = m.safe && check.name == "completion";
  }
  return m;
}

Measures measure(const hil::TeamMission& mission, const checks::Limits& limits) {
  checks::RunRecord record;
  const hil::JudgedRun run = hil::fly_judged(mission, limits, {}, &record);
  return measures_of(mission, record, limits, run);
}

}  // namespace skein::experiments
