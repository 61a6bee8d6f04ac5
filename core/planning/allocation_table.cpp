// SPDX-License-Identifier: Apache-2.0
#include "allocation_table.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

#include "free_start.hpp"
#include "skein/base/assert.hpp"
#include "skein/planning/arrival.hpp"
#include "skein/planning/dubins_batch.hpp"

namespace skein::planning {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kRounding_s = 2e-9;  ///< more than what times are rounded up by
constexpr double kRounding_m = 1e-7;  ///< of lengths, well within what path_of_length allows
constexpr int kTimingsMax = 64;       ///< moments tried for one choice of vehicles

Instant later(Instant start, double seconds) {
  return start + Duration{static_cast<Duration::rep>(std::ceil(seconds * 1e9))};
}

/// Candidates that turn on one radius and fly one kind of task to one and the same pose.
struct Alike {
  double radius_m = 0.0;
  double extent_m = 0.0;  ///< of the final approach, or of the arc
  std::vector<std::size_t> columns;
  PoseBatch from;

  void lengths_to(const Pose2& entry, std::span<double> lengths_m) const {
    const PoseColumns to{{&entry.x_m, 1}, {&entry.y_m, 1}, {&entry.heading_rad, 1}, {}, {}};
    shortest_dubins_lengths(from.columns(), to, radius_m, lengths_m.first(columns.size()));
  }
};

/// `extent_of` gives nothing for who cannot do the kind of task.
template <class ExtentOf>
std::vector<Alike> alike(const std::vector<Candidate>& candidates, const ExtentOf& extent_of) {
  std::vector<Alike> groups;
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    const std::optional<double> extent_m = extent_of(candidates[c]);
    if (!extent_m) continue;
    const double radius_m = candidates[c].planning_radius_m;
    auto group = std::find_if(groups.begin(), groups.end(), [&](const Alike& g) {
      return g.radius_m == radius_m && g.extent_m == *extent_m;
    });
    if (group == groups.end()) {
      group = groups.insert(groups.end(), Alike{radius_m, *extent_m, {}, {}});
      group->columns.reserve(candidates.size());
      group->from.reserve(candidates.size());
    }
    group->columns.push_back(c);
    group->from.push_back(candidates[c].pose);
  }
  return groups;
}

}  // namespace

AllocationTable::AllocationTable(const AllocationParams& params, const AllocationProblem& problem)
    : params_{&params}, problem_{&problem}, candidates_{problem.candidates} {
  std::sort(candidates_.begin(), candidates_.end(),
            [](const Candidate& a, const Candidate& b) { return a.id < b.id; });
}

Result<AllocationTable> AllocationTable::make(const AllocationParams& params,
                                              const AllocationProblem& problem) {
  SKEIN_ASSERT(params.time_margin >= 1.0);
  AllocationTable table{params, problem};
  if (auto error = table.make_rows()) return *error;
  table.make_pairs();
  table.make_bounds();
  return table;
}

std::string AllocationTable::name() const {
  return "site " + std::to_string(problem_->site.id.value);
}

std::optional<Error> AllocationTable::make_rows() {
  const Site& site = problem_->site;
  std::vector<TaskId> tasks = problem_->open_tasks;
  std::sort(tasks.begin(), tasks.end());
  rows_.reserve(tasks.size());
  for (const TaskId& task : tasks) {
    const bool known = task.site == site.id && task.kind != TaskKind::survey &&
                       task.index < task_count(site, task.kind);
    if (!known) return Error{name() + " has no open task '" + to_string(task) + "'"};
  }
  double first_offset_s = kInfinity;
  for (const TaskId& task : tasks) {
    if (task.kind != TaskKind::deliver) continue;
    const double offset_s = to_seconds(site.deliveries[task.index].offset);
    rows_.push_back({task, offset_s, offset_s});
    first_offset_s = std::min(first_offset_s, offset_s);
  }
  deliveries_ = rows_.size();
  for (Row& row : rows_) {
    row.offset_s -= first_offset_s;
    row.complete_s = row.offset_s;
    last_offset_s_ = std::max(last_offset_s_, row.offset_s);
  }
  for (const TaskId& task : tasks) {
    if (task.kind != TaskKind::assess) continue;
    // The arc takes as long at any speed and radius.
    const TaskPath arc = arc_path(site, 0.0, site.assessments[task.index].dwell, 1.0, 1.0, 1);
    rows_.push_back({task, 0.0, arc.run.length_m});
  }
  return std::nullopt;
}

void AllocationTable::set_pair(std::size_t row, std::size_t column, const TaskPath& task,
                               double shortest_m) {
  const Candidate& vehicle = candidates_[column];
  const TaskKind kind = rows_[row].task.kind;
  const std::size_t i = index(row, column);
  const double timed_m = timed_run_m(kind, task);
  const double offset_s = rows_[row].offset_s;
  const double least_s =
      (shortest_m + timed_m) * params_->time_margin / vehicle.speed_mps - offset_s;
  const double greatest_s =
      (vehicle.range_left_m - (task.run.length_m - timed_m)) / vehicle.speed_mps - offset_s;
  pairs_[i].entry = task.entry;
  pairs_[i].run_m = task.run.length_m;
  pairs_[i].shortest_m = shortest_m;
  least_s_[i] = least_s <= greatest_s ? least_s : kInfinity;
  greatest_s_[i] = greatest_s;
}

void AllocationTable::make_deliveries() {
  if (deliveries_ == 0) return;
  const auto groups = alike(candidates_, [](const Candidate& c) -> std::optional<double> {
    if (!c.capabilities.has(TaskKind::deliver) || c.loads == 0) return std::nullopt;
    return c.final_approach_m;
  });
  std::vector<double> lengths_m(columns());
  for (std::size_t row = 0; row < deliveries_; ++row) {
    const DeliveryRequirement& delivery = problem_->site.deliveries[rows_[row].task.index];
    for (const Alike& group : groups) {
      const TaskPath task = delivery_path(problem_->site, delivery, group.extent_m);
      group.lengths_to(task.entry, lengths_m);
      for (std::size_t i = 0; i < group.columns.size(); ++i) {
        set_pair(row, group.columns[i], task, lengths_m[i]);
      }
    }
  }
}

void AllocationTable::make_assessments() {
  if (assessments() == 0) return;
  const auto groups = alike(candidates_, [](const Candidate& c) -> std::optional<double> {
    const bool can = c.capabilities.has(TaskKind::assess);
    if (!can || c.assess_radius_m < c.planning_radius_m) return std::nullopt;
    return c.assess_radius_m;
  });
  std::vector<double> lengths_m(columns());
  const bool any_free = std::any_of(rows_.begin() + static_cast<std::ptrdiff_t>(deliveries_),
                                    rows_.end(), [this](const Row& row) { return is_free(row); });
  for (const Alike& group : groups) {
    for (std::size_t i = 0; any_free && i < group.columns.size(); ++i) {
      make_free_arcs(group.columns[i]);
    }
  }
  for (std::size_t row = deliveries_; row < rows(); ++row) {
    if (is_free(rows_[row])) continue;
    const ArcRequirement& arc = problem_->site.assessments[rows_[row].task.index];
    for (const Alike& group : groups) {
      TaskPath task = arc_path(problem_->site, *arc.start_angle_rad, arc.dwell, group.extent_m, 1.0,
                               kAssessmentSense);
      group.lengths_to(task.entry, lengths_m);
      const double arc_s = task.run.length_m;
      for (std::size_t i = 0; i < group.columns.size(); ++i) {
        task.run.length_m = arc_s * candidates_[group.columns[i]].speed_mps;
        set_pair(row, group.columns[i], task, lengths_m[i]);
      }
    }
  }
}

bool AllocationTable::is_free(const Row& row) const {
  return row.task.kind == TaskKind::assess &&
         !problem_->site.assessments[row.task.index].start_angle_rad;
}

/// As leg_to_arc, without hazards.
void AllocationTable::make_free_arcs(std::size_t column) {
  const Candidate& vehicle = candidates_[column];
  const FreeStart start =
      shortest_to_circle(vehicle.pose, vehicle.planning_radius_m, problem_->site.position,
                         vehicle.assess_radius_m, kAssessmentSense);
  for (std::size_t row = deliveries_; row < rows(); ++row) {
    if (!is_free(rows_[row])) continue;
    const ArcRequirement& arc = problem_->site.assessments[rows_[row].task.index];
    const TaskPath task = arc_path(problem_->site, start.start_rad, arc.dwell,
                                   vehicle.assess_radius_m, vehicle.speed_mps, kAssessmentSense);
    // Around hazards all starts are looked at again: until then it is a bound.
    const bool measured = problem_->hazards.empty();
    set_pair(row, column, task, measured ? start.length_m : start.least_m);
    if (measured) add_slack(row, column, start.length_m - start.least_m);
  }
}

void AllocationTable::add_slack(std::size_t row, std::size_t column, double slack_m) {
  if (!possible(row, column)) return;
  const double seconds = slack_m * params_->time_margin / candidates_[column].speed_mps;
  free_slack_s_ = std::max(free_slack_s_, seconds);
}

/// A plan whose assessments begin somewhat sooner, by other starts of their arcs, is one of these
/// pairs once all of them wait for so long. J has no greater slope there.
double AllocationTable::free_slack() const {
  if (free_slack_s_ == 0.0) return 0.0;
  double speeds_mps = 0.0;
  for (std::size_t k = 0; k < assessments(); ++k) {
    speeds_mps += candidates_[by_speed_[columns() - 1 - k]].speed_mps;
  }
  const double slope_per_s = reward_scale_ * assess_rewards_ * problem_->site.reward_decay_per_s +
                             range_scale_ * speeds_mps +
                             timing_scale_ * static_cast<double>(assessments());
  return free_slack_s_ * slope_per_s;
}

bool AllocationTable::may_start_elsewhere(const std::vector<int>& column_of,
                                          double assess_s) const {
  for (std::size_t row = deliveries_; row < rows(); ++row) {
    const std::size_t pair = index(row, static_cast<std::size_t>(column_of[row]));
    if (!is_free(rows_[row]) || assess_s < least_s_[pair] || assess_s > greatest_s_[pair]) continue;
    if (!open(row, static_cast<std::size_t>(column_of[row]), assess_s)) return true;
  }
  return false;
}

void AllocationTable::make_pairs() {
  pairs_.resize(rows() * columns());
  for (Pair& pair : pairs_) pair.measured = problem_->hazards.empty();
  least_s_.assign(pairs_.size(), kInfinity);
  greatest_s_.assign(pairs_.size(), -kInfinity);
  make_deliveries();
  make_assessments();
}

void AllocationTable::make_bounds() {
  const Site& site = problem_->site;
  const ValueWeights& w = params_->weights;
  const auto tasks = static_cast<double>(rows());
  first_moment_s_ = std::max(0.0, to_seconds(problem_->earliest_delivery - problem_->start));
  if (site.reward > 0.0 && !rows_.empty()) reward_scale_ = w.reward / tasks;
  for (std::size_t row = 0; row < rows(); ++row) {
    (is_delivery(row) ? deliver_rewards_ : assess_rewards_) +=
        std::exp(-site.reward_decay_per_s * rows_[row].complete_s);
  }
  for (const Candidate& c : candidates_) range_m_ += c.range_left_m;
  if (range_m_ > 0.0) range_scale_ = w.range / range_m_;
  const double reference_s = to_seconds(w.timing_reference) * tasks;
  if (reference_s > 0.0) timing_scale_ = w.timing / reference_s;

  by_speed_.resize(columns());
  std::iota(by_speed_.begin(), by_speed_.end(), std::size_t{0});
  std::stable_sort(by_speed_.begin(), by_speed_.end(), [this](std::size_t a, std::size_t b) {
    return candidates_[a].speed_mps < candidates_[b].speed_mps;
  });
  complete_latest_s_.reserve(rows());
  for (const Row& row : rows_) complete_latest_s_.push_back(row.complete_s);
  const auto middle = complete_latest_s_.begin() + static_cast<std::ptrdiff_t>(deliveries_);
  std::sort(complete_latest_s_.begin(), middle, std::greater<>{});
  std::sort(middle, complete_latest_s_.end(), std::greater<>{});
  deliver_from_s_.assign(columns(), kInfinity);
  assess_from_s_.assign(columns(), kInfinity);
  for (std::size_t row = 0; row < rows(); ++row) {
    std::vector<double>& from = is_delivery(row) ? deliver_from_s_ : assess_from_s_;
    for (std::size_t c = 0; c < columns(); ++c) from[c] = std::min(from[c], least_s(row, c));
  }
}

bool AllocationTable::open(std::size_t row, std::size_t column, double common_s) const {
  const std::size_t i = index(row, column);
  if (common_s < least_s_[i] || common_s > greatest_s_[i]) return false;
  return common_s < pairs_[i].refused_from_s || common_s >= pairs_[i].resumes_s;
}

const Departure& AllocationTable::departure(std::size_t column) {
  if (departures_.empty()) departures_.resize(columns());
  auto& its = departures_[column];
  if (!its) {
    its = std::make_unique<Departure>(departure_of(candidates_[column], problem_->hazards));
  }
  return *its;
}

/// Replaces the lower bound by the length around the hazards.
void AllocationTable::measure(std::size_t row, std::size_t column) {
  Pair& pair = pairs_[index(row, column)];
  if (std::exchange(pair.measured, true) || !possible(row, column)) return;
  const Candidate& vehicle = candidates_[column];
  auto leg =
      leg_of(params_->avoidance, vehicle, departure(column), problem_->site, rows_[row].task);
  if (!leg) {
    least_s_[index(row, column)] = kInfinity;
    return;
  }
  set_pair(row, column, leg->task, leg->shortest_m);
  add_slack(row, column, leg->slack_m);
  if (!leg->around) return;
  pair.lengths = std::make_unique<TransitLengths>(transit_of(vehicle, leg->task, problem_->hazards),
                                                  std::move(*leg->around));
}

/// The least length >= `wanted_m` that can be flown; none within the range.
std::optional<double> AllocationTable::flyable_from(std::size_t row, std::size_t column,
                                                    double wanted_m, Resumption resumption) {
  Pair& pair = pairs_[index(row, column)];
  const TaskPath task{pair.entry, {0.0, pair.run_m}};
  const Transit transit = transit_of(candidates_[column], task, problem_->hazards);
  const AvoidanceParams& params = params_->avoidance;
  if (transit.hazards.empty()) {
    if (surely_flyable(params, transit, pair.shortest_m, wanted_m)) return wanted_m;
    const auto gap = length_gap(transit.from, transit.to, transit.radius_m);
    if (gap && wanted_m > gap->low_m && wanted_m < gap->high_m) {
      if (wanted_m > gap->high_m - kRounding_m) return wanted_m;
      return gap->high_m <= transit.length_max_m ? std::optional{gap->high_m} : std::nullopt;
    }
  }
  if (!pair.lengths) {
    // The shortest way is a direct one.
    const auto open_m = least_without_hazards(params, transit, pair.shortest_m, wanted_m);
    if (open_m) return *open_m <= transit.length_max_m ? open_m : std::nullopt;
    auto found = find_clear_path(params, transit.from, transit.to, transit.radius_m,
                                 transit.hazards, departure(column).ways);
    if (!found) return std::nullopt;
    pair.lengths = std::make_unique<TransitLengths>(transit, std::move(*found));
  }
  const double least_m = pair.lengths->none_before_m(wanted_m, resumption == Resumption::exactly);
  return least_m < kInfinity ? std::optional{least_m} : std::nullopt;
}

void AllocationTable::measure_all() {
  for (std::size_t row = 0; row < rows(); ++row) {
    for (std::size_t c = 0; c < columns(); ++c) measure(row, c);
  }
}

void AllocationTable::settle_deliveries(double delivery_s) {
  for (std::size_t row = 0; row < deliveries_; ++row) {
    for (std::size_t c = 0; c < columns(); ++c) {
      if (pairs_[index(row, c)].resumes_s != delivery_s) continue;
      (void)verify(row, c, delivery_s, Resumption::exactly);
    }
  }
}

bool AllocationTable::verify(std::size_t row, std::size_t column, double common_s,
                             Resumption resumption) {
  measure(row, column);
  if (!open(row, column, common_s)) return false;
  Pair& pair = pairs_[index(row, column)];
  if (pair.verified_s == common_s) return true;
  const Candidate& vehicle = candidates_[column];
  const TaskKind kind = rows_[row].task.kind;
  const TaskPath task{pair.entry, {0.0, pair.run_m}};
  const double wanted_m =
      transit_length_m(vehicle, kind, task, problem_->start, time_of(row, common_s));
  const auto reachable_m = flyable_from(row, column, wanted_m, resumption);
  if (!reachable_m || *reachable_m > wanted_m) {
    const double resumes_s =
        reachable_m
            ? (*reachable_m + timed_run_m(kind, task)) / vehicle.speed_mps - rows_[row].offset_s
            : kInfinity;
    // A gap that is met twice is one gap, also at what was thought to be its end.
    const double until_s = std::max(resumes_s, std::nextafter(common_s, kInfinity));
    const bool same = pair.resumes_s == until_s || pair.resumes_s == common_s;
    pair.refused_from_s = same ? std::min(pair.refused_from_s, common_s) : common_s;
    pair.resumes_s = until_s;
    return false;
  }
  pair.verified_s = common_s;
  return true;
}

bool AllocationTable::verify(const std::vector<int>& column_of, const Moments& at,
                             Resumption resumption) {
  const auto column = [&](std::size_t row) { return static_cast<std::size_t>(column_of[row]); };
  bool all = true;
  for (std::size_t row = 0; row < rows(); ++row) {
    measure(row, column(row));
    all = all && open(row, column(row), moment_of(row, at));
  }
  for (std::size_t row = 0; row < rows() && all; ++row) {
    all = verify(row, column(row), moment_of(row, at), resumption);
  }
  return all;
}

Instant AllocationTable::time_of(std::size_t row, double common_s) const {
  return later(problem_->start, common_s + rows_[row].offset_s);
}

double AllocationTable::assess_after_s(double delivery_s) const {
  double last_s = to_seconds(problem_->deliveries_done - problem_->start);
  if (deliveries_ > 0) {
    const Instant last = later(problem_->start, delivery_s + last_offset_s_);
    last_s = std::max(last_s, to_seconds(last - problem_->start));
  }
  return std::max(0.0, last_s + to_seconds(problem_->site.assess_wait));
}

double AllocationTable::delivery_before_s(double assess_s) const {
  return assess_s - to_seconds(problem_->site.assess_wait) - last_offset_s_ - kRounding_s;
}

std::optional<double> AllocationTable::next_moment(std::size_t first, std::size_t last,
                                                   double after_s) const {
  double next_s = kInfinity;
  const auto consider = [&](double moment_s) {
    if (moment_s > after_s) next_s = std::min(next_s, moment_s);
  };
  for (std::size_t i = first * columns(); i < last * columns(); ++i) {
    if (least_s_[i] == kInfinity) continue;
    consider(least_s_[i]);
    consider(greatest_s_[i]);
    consider(pairs_[i].resumes_s);
  }
  return std::isfinite(next_s) ? std::optional{next_s} : std::nullopt;
}

double AllocationTable::value(const std::vector<int>& column_of, const Moments& at) const {
  double metres_flown = 0.0;
  for (std::size_t row = 0; row < rows(); ++row) {
    metres_flown += metres(row, static_cast<std::size_t>(column_of[row]), at);
  }
  const double beta = problem_->site.reward_decay_per_s;
  const double late_s = at.assess_s - assess_after_s(at.delivery_s);
  return reward_scale_ * (deliver_rewards_ * std::exp(-beta * at.delivery_s) +
                          assess_rewards_ * std::exp(-beta * at.assess_s)) +
         range_scale_ * (range_m_ - metres_flown) -
         timing_scale_ * std::max(0.0, late_s) * static_cast<double>(assessments());
}

double AllocationTable::least_metres(bool deliveries, double common_s, double open_s) const {
  const std::vector<double>& from = deliveries ? deliver_from_s_ : assess_from_s_;
  std::size_t task = deliveries ? 0 : deliveries_;
  const std::size_t last = deliveries ? deliveries_ : rows();
  double metres_flown = 0.0;
  for (const std::size_t c : by_speed_) {
    if (task == last) break;
    if (from[c] > open_s || from[c] == kInfinity) continue;
    metres_flown += candidates_[c].speed_mps * (common_s + complete_latest_s_[task]);
    ++task;
  }
  return task == last ? metres_flown : kInfinity;
}

double AllocationTable::bound(const Moments& at, const Moments& open) const {
  const double metres_flown = least_metres(true, at.delivery_s, open.delivery_s) +
                              least_metres(false, at.assess_s, open.assess_s);
  if (metres_flown == kInfinity) return -kInfinity;
  const double beta = problem_->site.reward_decay_per_s;
  const double late_s = assessments() > 0 ? at.assess_s - assess_after_s(at.delivery_s) : 0.0;
  return reward_scale_ * (deliver_rewards_ * std::exp(-beta * at.delivery_s) +
                          assess_rewards_ * std::exp(-beta * at.assess_s)) +
         range_scale_ * (range_m_ - metres_flown) -
         timing_scale_ * std::max(0.0, late_s) * static_cast<double>(assessments());
}

double AllocationTable::bound_from(const Moments& at) const {
  const double on_time_s = assess_after_s(at.delivery_s);
  if (at.assess_s <= on_time_s) {
    return bound({at.delivery_s, on_time_s}, {kInfinity, kInfinity});
  }
  // Later deliveries would make these assessments less late: as if they were not.
  const double late = timing_scale_ * (at.assess_s - on_time_s);
  return bound(at, {kInfinity, kInfinity}) + late * static_cast<double>(assessments());
}

/// What late assessments gain by a second of delay, over what the deliveries' rewards lose by it,
/// which is the less the later they are; at the latest the assessments are on time.
bool AllocationTable::waiting_pays(const Moments& at) const {
  const double latest_s = delivery_before_s(at.assess_s);
  const double beta = problem_->site.reward_decay_per_s;
  return latest_s > at.delivery_s &&
         timing_scale_ * static_cast<double>(assessments()) >
             reward_scale_ * deliver_rewards_ * beta * std::exp(-beta * latest_s);
}

std::optional<double> AllocationTable::soonest(const std::vector<int>& column_of, std::size_t first,
                                               std::size_t last, double from_s) {
  double moment_s = from_s;
  for (std::size_t row = first; row < last; ++row) {
    moment_s = std::max(moment_s, least_s(row, static_cast<std::size_t>(column_of[row])));
  }
  for (int i = 0; i < kTimingsMax && std::isfinite(moment_s); ++i) {
    double next_s = moment_s;
    for (std::size_t row = first; row < last; ++row) {
      const auto column = static_cast<std::size_t>(column_of[row]);
      if (verify(row, column, moment_s, Resumption::exactly)) continue;
      const std::size_t pair = index(row, column);
      if (moment_s > greatest_s_[pair]) return std::nullopt;
      next_s =
          std::max(next_s, least_s_[pair] > moment_s ? least_s_[pair] : pairs_[pair].resumes_s);
    }
    if (next_s == moment_s) return moment_s;
    moment_s = next_s;
  }
  return std::nullopt;
}

std::optional<CoalitionPlan> AllocationTable::timed(const std::vector<int>& column_of,
                                                    bool soonest_only) {
  const auto delivery_s = soonest(column_of, 0, deliveries_, first_moment_s_);
  if (!delivery_s) return std::nullopt;
  const auto assess_s = soonest(column_of, deliveries_, rows(), assess_after_s(*delivery_s));
  if (!assess_s) return std::nullopt;
  CoalitionPlan plan{column_of, {*delivery_s, *assess_s}, 0.0};
  plan.value = value(column_of, plan.at);
  if (soonest_only || deliveries_ == 0 || assessments() == 0) return plan;
  // The required moment of late assessments can be moved to them.
  const Moments on_time{delivery_before_s(*assess_s), *assess_s};
  if (on_time.delivery_s <= *delivery_s || assess_after_s(on_time.delivery_s) > *assess_s) {
    return plan;
  }
  const double on_time_value = value(column_of, on_time);
  if (on_time_value > plan.value && verify(column_of, on_time, Resumption::exactly)) {
    plan.at = on_time;
    plan.value = on_time_value;
  }
  return plan;
}

Allocation AllocationTable::allocation(const CoalitionPlan& plan) const {
  Allocation result;
  result.assignments.reserve(rows());
  for (std::size_t row = 0; row < rows(); ++row) {
    const auto column = static_cast<std::size_t>(plan.column_of[row]);
    result.assignments.push_back(
        {rows_[row].task, candidates_[column].id, time_of(row, moment_of(row, plan.at))});
  }
  if (deliveries_ > 0) result.first_delivery_s = plan.at.delivery_s;
  result.value = value_of(params_->weights, *problem_, result.assignments);
  return result;
}

std::optional<Error> AllocationTable::missing(TaskKind kind, std::size_t first,
                                              std::size_t last) const {
  std::size_t able = 0;
  for (std::size_t c = 0; c < columns(); ++c) {
    bool any = false;
    for (std::size_t row = first; row < last; ++row) any = any || possible(row, c);
    able += any ? 1U : 0U;
  }
  if (able >= last - first) return std::nullopt;
  const bool deliver = kind == TaskKind::deliver;
  return Error{name() + " needs " + std::to_string(last - first) +
               (deliver ? " deliveries: " : " assessments: ") + std::to_string(able) + " of " +
               std::to_string(columns()) + " candidates can " + (deliver ? "deliver" : "assess")};
}

std::optional<Error> AllocationTable::missing() const {
  if (auto error = missing(TaskKind::deliver, 0, deliveries_)) return error;
  if (auto error = missing(TaskKind::assess, deliveries_, rows())) return error;
  if (rows() > columns()) {
    return Error{name() + " has " + std::to_string(rows()) + " open tasks for " +
                 std::to_string(columns()) + " candidates, and each takes one"};
  }
  return std::nullopt;
}

}  // namespace skein::planning
