// SPDX-License-Identifier: Apache-2.0
#include "skein/hindsight/hindsight.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

#include "skein/checks/flown.hpp"
#include "skein/coupled/coupled.hpp"
#include "skein/coupled/intentions.hpp"
#include "skein/domain/site.hpp"

namespace skein::hindsight {
namespace {

using planning::CoupledProblem;
using planning::CoupledVehicle;
using planning::Criterion;

/// Where each vehicle was when the mission began.
std::vector<CoupledVehicle> vehicles_of(const checks::RunRecord& record) {
  std::vector<CoupledVehicle> vehicles;
  for (const VehicleSpec& spec : record.vehicles) {
    const auto* const recorded = checks::recording_of(record, spec.id);
    if (recorded == nullptr || recorded->track.empty()) continue;
    if (spec.capabilities == Capabilities{}) continue;
    const auto in_mission = std::ranges::find_if(
        recorded->track, [](const auto& point) { return point.state.time >= Instant{}; });
    const auto& first = in_mission == recorded->track.end() ? recorded->track.back() : *in_mission;
    vehicles.push_back(planning::coupled_vehicle(spec, first.state.pose()));
  }
  return vehicles;
}

CoupledProblem problem_of(const checks::RunRecord& record, const std::vector<Site>& sites) {
  CoupledProblem problem;
  problem.vehicles = vehicles_of(record);
  problem.sites = sites;
  problem.open_tasks = planning::tasks_of(sites);
  // One that appears later was in nobody's way before: no bound of all flights may heed it.
  problem.hazards = hazards_known_at(record.hazards, Instant{});
  problem.weights = {1.0, 0.0};
  return problem;
}

Result<Figure> best_of(CoupledProblem problem, Criterion criterion, std::uint64_t steps) {
  problem.criterion = criterion;
  const auto plan = planning::branch_and_bound(problem, planning::PlanningBudget{steps, {}});
  if (!plan) return plan.error();
  return Figure{{}, plan->objective, plan->bound, plan->proven};
}

/// The end of the last task of those sites; none where one is not done.
std::optional<double> flown_end_s(const std::map<TaskId, checks::TaskFlown>& done,
                                  const std::vector<Site>& sites) {
  double end_s = 0.0;
  for (const TaskId& task : planning::tasks_of(sites)) {
    const auto flown = done.find(task);
    if (flown == done.end()) return std::nullopt;
    end_s = std::max(end_s, to_seconds(flown->second.time));
  }
  return end_s;
}

Row row_of(std::string what, const Figure& f, const char* unit, int digits) {
  const auto number = [digits, unit](double value) {
    return fmt::format("{:.{}f}{}", value, digits, unit);
  };
  const bool compares = f.flown && *f.flown > 0.0 && f.best > 0.0;
  return {std::move(what), f.flown ? number(*f.flown) : "-", number(f.best),
          f.proven  ? "proven"
          : f.bound ? number(*f.bound)
                    : "-",
          compares ? fmt::format("{:.2f}", *f.flown / f.best) : "-"};
}

}  // namespace

Result<Hindsight> look_back(const checks::RunRecord& record, const checks::Limits& limits,
                            std::uint64_t steps) {
  if (record.sites.empty()) return Error{"the mission has no sites"};
  const auto done = checks::tasks_flown(record, limits);
  const CoupledProblem whole = problem_of(record, record.sites);
  if (whole.vehicles.empty()) return Error{"no vehicle's track was recorded"};
  Hindsight all;
  auto end = best_of(whole, Criterion::makespan, steps);
  if (!end) return end.error();
  auto reward = best_of(whole, Criterion::value, steps);
  if (!reward) return reward.error();
  all.end_s = *end;
  all.end_s.flown = flown_end_s(done, record.sites);
  all.reward = *reward;
  const checks::Reward earned = checks::reward_flown(record.sites, done);
  all.reward.flown = earned.all > 0.0 ? earned.flown / earned.all : 0.0;
  for (const Site& site : record.sites) {
    auto alone = best_of(problem_of(record, {site}), Criterion::makespan, steps);
    if (!alone) return alone.error();
    alone->flown = flown_end_s(done, {site});
    all.sites.push_back({site.id, *alone});
  }
  return all;
}

std::vector<Row> table_of(const Hindsight& hindsight) {
  std::vector<Row> rows{row_of("last task done", hindsight.end_s, " s", 1),
                        row_of("reward, share of all", hindsight.reward, "", 3)};
  for (const SiteFigure& site : hindsight.sites) {
    rows.push_back(row_of(fmt::format("site {} alone", site.site.value), site.end_s, " s", 1));
  }
  return rows;
}

std::string text_of(const Hindsight& hindsight) {
  const auto line = [](const Row& row) {
    return fmt::format("{:<24}{:>10}{:>12}{:>10}{:>8}\n", row.what, row.flown, row.best, row.bound,
                       row.ratio);
  };
  std::string text = line({"knowing all from the start", "flown", "best found", "bound", "ratio"});
  for (const Row& row : table_of(hindsight)) text += line(row);
  return text + "A ratio of 1 is the best: times are over it, rewards under it.\n";
}

std::string comparison_text(const Result<Hindsight>& looked) {
  return looked ? text_of(*looked) : "not compared with the best: " + looked.error().message + "\n";
}

}  // namespace skein::hindsight
