// SPDX-License-Identifier: Apache-2.0
#include "skein/planning/allocation.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "skein/base/angles.hpp"
#include "skein/base/assert.hpp"
#include "skein/planning/arrival.hpp"
#include "skein/planning/assignment.hpp"
#include "skein/planning/task_path.hpp"

namespace skein::planning {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLeft = 1.0;
constexpr int kArcStarts = 24;   ///< tried where the requirement leaves the start angle free
constexpr int kTrialsMax = 400;  ///< assignments tried before the allocation is given up
constexpr int kCounterClockwise = 1;
constexpr int kClockwise = -1;
/// Every assessment of a site is flown in the same sense, so that vehicles on one circle keep their
/// spacing.
constexpr int kAssessmentSense = kCounterClockwise;

std::string name(const Site& site) { return "site " + std::to_string(site.id.value); }

Result<TaskPath> fixed_arc(const Site& site, double start_rad, Duration dwell, double arc_radius_m,
                           double planning_radius_m, double speed_mps, int turn) {
  if (arc_radius_m < planning_radius_m) {
    return Error{"The arc around " + name(site) + " has a radius of " +
                 std::to_string(std::lround(arc_radius_m)) + " m, less than the turn radius of " +
                 std::to_string(std::lround(planning_radius_m)) + " m"};
  }
  return arc_path(site, start_rad, dwell, arc_radius_m, speed_mps, turn);
}

struct Leg {
  TaskPath task;
  double shortest_m = kInfinity;  ///< to the task's entry
};

Result<Leg> leg_to(const AvoidanceParams& params, const Pose2& from, double radius_m,
                   const TaskPath& task, std::span<const Hazard> hazards) {
  Path run{.start = task.entry, .segments = {}};
  SKEIN_ASSERT(run.append(task.run));
  if (!is_clear(run, hazards)) return Error{"The run itself enters a hazard"};
  const auto path = shortest_clear_path(params, from, task.entry, radius_m, hazards);
  if (!path) return path.error();
  return Leg{task, path->length_m()};
}

/// The arc that starts soonest where the start angle is free.
Result<Leg> leg_to_arc(const AvoidanceParams& params, const Pose2& from, double planning_radius_m,
                       double arc_radius_m, double speed_mps, const Site& site,
                       const ArcRequirement& arc, int turn, std::span<const Hazard> hazards) {
  const auto from_angle = [&](double start_rad) -> Result<Leg> {
    const auto task =
        fixed_arc(site, start_rad, arc.dwell, arc_radius_m, planning_radius_m, speed_mps, turn);
    if (!task) return task.error();
    return leg_to(params, from, planning_radius_m, *task, hazards);
  };
  if (arc.start_angle_rad) return from_angle(*arc.start_angle_rad);
  const Vec2 out = from.position() - site.position;
  const double nearest = out.norm() > 0.0 ? std::atan2(out.y(), out.x()) : 0.0;
  Result<Leg> best = from_angle(nearest);
  for (int i = 1; i < kArcStarts; ++i) {
    auto leg = from_angle(wrap_pi(nearest + i * kTwoPi / kArcStarts));
    if (leg && (!best || leg->shortest_m < best->shortest_m)) best = std::move(leg);
  }
  return best;
}

/// How the candidate flies the task, and the least that it takes. The one place that allocate and
/// plan_task share, so that what was promised is what is flown.
Result<Leg> leg_of(const AllocationParams& params, const Candidate& vehicle, const Site& site,
                   const TaskId& task, std::span<const Hazard> hazards) {
  if (task.kind == TaskKind::deliver && task.index < site.deliveries.size()) {
    return leg_to(params.avoidance, vehicle.pose, vehicle.planning_radius_m,
                  delivery_path(site, site.deliveries[task.index], vehicle.final_approach_m),
                  hazards);
  }
  if (task.kind == TaskKind::assess && task.index < site.assessments.size()) {
    return leg_to_arc(params.avoidance, vehicle.pose, vehicle.planning_radius_m,
                      vehicle.assess_radius_m, vehicle.speed_mps, site,
                      site.assessments[task.index], kAssessmentSense, hazards);
  }
  return Error{name(site) + " has no task '" + to_string(task) + "' to plan"};
}

/// What of the run lies before the moment that the task's time refers to.
double timed_run_m(TaskKind kind, const TaskPath& task) {
  return kind == TaskKind::deliver ? task.run.length_m : 0.0;
}

Transit transit_of(const Candidate& vehicle, const TaskPath& task,
                   std::span<const Hazard> hazards) {
  return {vehicle.pose, task.entry, vehicle.planning_radius_m,
          vehicle.range_left_m - task.run.length_m, hazards};
}

/// Length of the transit that brings the vehicle to the task at `time`.
double transit_length_m(const Candidate& vehicle, TaskKind kind, const TaskPath& task,
                        Instant start, Instant time) {
  return vehicle.speed_mps * to_seconds(time - start) - timed_run_m(kind, task);
}

TaskPlan assemble(const Path& transit, const TaskPath& task, Instant start, double speed_mps,
                  double radius_m) {
  TaskPlan plan{{start, speed_mps, kLeft / radius_m, transit}, transit.length_m()};
  SKEIN_ASSERT(plan.timed.path.append(task.run));
  return plan;
}

Instant later(Instant start, double seconds) {
  return start + Duration{static_cast<Duration::rep>(std::ceil(seconds * 1e9))};
}

/// The tasks of one kind, timed from one common moment: each at common + offset.
struct Row {
  TaskId task;
  double offset_s = 0.0;
};

class Allocator {
 public:
  Allocator(const AllocationParams& params, const AllocationProblem& problem)
      : params_{params}, problem_{problem}, candidates_{problem.candidates} {
    std::sort(candidates_.begin(), candidates_.end(),
              [](const Candidate& a, const Candidate& b) { return a.id < b.id; });
  }

  [[nodiscard]] Result<Allocation> run();

 private:
  /// A pair of row and column.
  struct Pair {
    std::optional<Leg> leg;
    double least_s = kInfinity;        ///< from the start to the common moment, margin included
    double greatest_s = -kInfinity;    ///< what the range allows
    double refused_at_s = -kInfinity;  ///< the common moment at which no path had the length,
    double resumes_s = kInfinity;      ///< and the next at which one has
  };

  [[nodiscard]] std::optional<Error> make_rows();
  void make_pairs();
  [[nodiscard]] std::optional<Error> missing(TaskKind kind, std::size_t first,
                                             std::size_t count) const;
  [[nodiscard]] std::size_t row_count() const { return rows_.size(); }
  [[nodiscard]] std::size_t assessments() const { return rows_.size() - deliveries_; }
  [[nodiscard]] Pair& pair(std::size_t row, std::size_t column) {
    return pairs_[row * candidates_.size() + column];
  }
  [[nodiscard]] const Pair& pair(std::size_t row, std::size_t column) const {
    return pairs_[row * candidates_.size() + column];
  }
  [[nodiscard]] bool is_delivery(std::size_t row) const { return row < deliveries_; }
  [[nodiscard]] double first_moment() const;
  [[nodiscard]] double assess_after(double delivery_s) const;
  [[nodiscard]] std::optional<double> next_moment(std::size_t first, std::size_t last,
                                                  double after_s) const;
  [[nodiscard]] std::optional<Assignment> assign(double delivery_s, double assess_s) const;
  [[nodiscard]] bool verify(const Assignment& assignment, double delivery_s, double assess_s);
  [[nodiscard]] std::optional<Allocation> try_moments(double delivery_s, double assess_s);
  [[nodiscard]] std::optional<Allocation> try_delivery(double delivery_s);
  [[nodiscard]] Instant time_of(std::size_t row, double common_s) const {
    return later(problem_.start, common_s + rows_[row].offset_s);
  }

  AllocationParams params_;
  const AllocationProblem& problem_;
  std::vector<Candidate> candidates_;
  std::vector<Row> rows_;  ///< deliveries, then assessments
  std::size_t deliveries_ = 0;
  std::vector<Pair> pairs_;
  int trials_ = 0;
};

std::optional<Error> Allocator::make_rows() {
  std::vector<TaskId> tasks = problem_.open_tasks;
  std::sort(tasks.begin(), tasks.end());
  for (const TaskId& task : tasks) {
    const bool known = task.site == problem_.site.id && task.kind != TaskKind::survey &&
                       task.index < problem_.site.task_count(task.kind);
    if (!known) return Error{name(problem_.site) + " has no open task '" + to_string(task) + "'"};
  }
  double first_offset_s = kInfinity;
  for (const TaskId& task : tasks) {
    if (task.kind != TaskKind::deliver) continue;
    const double offset_s = to_seconds(problem_.site.deliveries[task.index].offset);
    rows_.push_back({task, offset_s});
    first_offset_s = std::min(first_offset_s, offset_s);
  }
  deliveries_ = rows_.size();
  for (Row& row : rows_) row.offset_s -= first_offset_s;
  for (const TaskId& task : tasks) {
    if (task.kind == TaskKind::assess) rows_.push_back({task, 0.0});
  }
  return std::nullopt;
}

void Allocator::make_pairs() {
  pairs_.assign(rows_.size() * candidates_.size(), {});
  for (std::size_t r = 0; r < row_count(); ++r) {
    const TaskKind kind = rows_[r].task.kind;
    for (std::size_t c = 0; c < candidates_.size(); ++c) {
      const Candidate& vehicle = candidates_[c];
      if (!vehicle.capabilities.has(kind)) continue;
      if (kind == TaskKind::deliver && vehicle.loads == 0) continue;
      const auto leg = leg_of(params_, vehicle, problem_.site, rows_[r].task, problem_.hazards);
      if (!leg) continue;
      const double timed_m = timed_run_m(kind, leg->task);
      const double after_m = leg->task.run.length_m - timed_m;
      Pair& p = pair(r, c);
      p.least_s =
          (leg->shortest_m + timed_m) * params_.time_margin / vehicle.speed_mps - rows_[r].offset_s;
      p.greatest_s = (vehicle.range_left_m - after_m) / vehicle.speed_mps - rows_[r].offset_s;
      if (p.least_s <= p.greatest_s) p.leg = *leg;
    }
  }
}

std::optional<Error> Allocator::missing(TaskKind kind, std::size_t first, std::size_t count) const {
  std::size_t able = 0;
  for (std::size_t c = 0; c < candidates_.size(); ++c) {
    bool any = false;
    for (std::size_t r = first; r < first + count; ++r) any = any || pair(r, c).leg.has_value();
    able += any ? 1U : 0U;
  }
  if (able >= count) return std::nullopt;
  const bool deliver = kind == TaskKind::deliver;
  return Error{name(problem_.site) + " needs " + std::to_string(count) +
               (deliver ? " deliveries: " : " assessments: ") + std::to_string(able) + " of " +
               std::to_string(candidates_.size()) + " candidates can " +
               (deliver ? "deliver" : "assess")};
}

double Allocator::first_moment() const {
  return std::max(0.0, to_seconds(problem_.earliest_delivery - problem_.start));
}

double Allocator::assess_after(double delivery_s) const {
  double last_s = to_seconds(problem_.deliveries_done - problem_.start);
  for (std::size_t r = 0; r < deliveries_; ++r) {
    last_s = std::max(last_s, to_seconds(time_of(r, delivery_s) - problem_.start));
  }
  return std::max(0.0, last_s + to_seconds(problem_.site.assess_wait));
}

/// The next moment after `after_s` at which one more pair becomes possible.
std::optional<double> Allocator::next_moment(std::size_t first, std::size_t last,
                                             double after_s) const {
  double next_s = kInfinity;
  for (std::size_t r = first; r < last; ++r) {
    for (std::size_t c = 0; c < candidates_.size(); ++c) {
      const Pair& p = pair(r, c);
      if (!p.leg) continue;
      if (p.least_s > after_s) next_s = std::min(next_s, p.least_s);
      if (p.refused_at_s == after_s && p.resumes_s > after_s) {
        next_s = std::min(next_s, p.resumes_s);
      }
    }
  }
  return std::isfinite(next_s) ? std::optional{next_s} : std::nullopt;
}

std::optional<Assignment> Allocator::assign(double delivery_s, double assess_s) const {
  Eigen::MatrixXd cost =
      Eigen::MatrixXd::Constant(static_cast<Eigen::Index>(row_count()),
                                static_cast<Eigen::Index>(candidates_.size()), kInfinity);
  for (std::size_t r = 0; r < row_count(); ++r) {
    const double common_s = is_delivery(r) ? delivery_s : assess_s;
    for (std::size_t c = 0; c < candidates_.size(); ++c) {
      const Pair& p = pair(r, c);
      const bool possible =
          p.leg && p.least_s <= common_s && common_s <= p.greatest_s && p.refused_at_s != common_s;
      if (!possible) continue;
      cost(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) = p.leg->shortest_m;
    }
  }
  return least_sum_assignment(cost);
}

/// False where a vehicle has no path of the length that its time asks for; that pair is then
/// refused at this moment.
bool Allocator::verify(const Assignment& assignment, double delivery_s, double assess_s) {
  bool all = true;
  for (std::size_t r = 0; r < row_count(); ++r) {
    const auto c = static_cast<std::size_t>(assignment.column_of[r]);
    const Candidate& vehicle = candidates_[c];
    const double common_s = is_delivery(r) ? delivery_s : assess_s;
    Pair& p = pair(r, c);
    const TaskKind kind = rows_[r].task.kind;
    const Transit transit = transit_of(vehicle, p.leg->task, problem_.hazards);
    const double wanted_m =
        transit_length_m(vehicle, kind, p.leg->task, problem_.start, time_of(r, common_s));
    const auto reachable = least_length_from(params_.avoidance, transit, wanted_m);
    if (reachable && *reachable <= wanted_m) continue;
    all = false;
    p.refused_at_s = common_s;
    p.resumes_s = reachable ? (*reachable + timed_run_m(kind, p.leg->task)) / vehicle.speed_mps -
                                  rows_[r].offset_s
                            : kInfinity;
  }
  return all;
}

std::optional<Allocation> Allocator::try_moments(double delivery_s, double assess_s) {
  while (trials_ < kTrialsMax) {
    ++trials_;
    const auto assignment = assign(delivery_s, assess_s);
    if (!assignment) return std::nullopt;
    if (!verify(*assignment, delivery_s, assess_s)) continue;
    Allocation result;
    for (std::size_t r = 0; r < row_count(); ++r) {
      const auto c = static_cast<std::size_t>(assignment->column_of[r]);
      result.assignments.push_back(
          {rows_[r].task, candidates_[c].id, time_of(r, is_delivery(r) ? delivery_s : assess_s)});
    }
    if (deliveries_ > 0) result.first_delivery_s = delivery_s;
    return result;
  }
  return std::nullopt;
}

/// The soonest assessments that go with deliveries at this moment. They also decide who delivers:
/// whoever alone can assess must be left for it.
std::optional<Allocation> Allocator::try_delivery(double delivery_s) {
  std::optional<double> assess_s = assess_after(delivery_s);
  while (assess_s && trials_ < kTrialsMax) {
    if (auto result = try_moments(delivery_s, *assess_s)) return result;
    if (assessments() == 0) return std::nullopt;
    assess_s = next_moment(deliveries_, row_count(), *assess_s);
  }
  return std::nullopt;
}

Result<Allocation> Allocator::run() {
  if (auto error = make_rows()) return *error;
  if (rows_.empty()) return Error{name(problem_.site) + " has no open task"};
  make_pairs();
  if (auto error = missing(TaskKind::deliver, 0, deliveries_)) return *error;
  if (auto error = missing(TaskKind::assess, deliveries_, assessments())) return *error;
  if (rows_.size() > candidates_.size()) {
    return Error{name(problem_.site) + " has " + std::to_string(rows_.size()) + " open tasks for " +
                 std::to_string(candidates_.size()) + " candidates, and each takes one"};
  }
  double delivery_s = first_moment();
  if (deliveries_ > 0) {
    // No time before the bottleneck of the deliveries alone can do.
    Eigen::MatrixXd least(static_cast<Eigen::Index>(deliveries_),
                          static_cast<Eigen::Index>(candidates_.size()));
    for (std::size_t r = 0; r < deliveries_; ++r) {
      for (std::size_t c = 0; c < candidates_.size(); ++c) {
        const Pair& p = pair(r, c);
        least(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) =
            p.leg ? p.least_s : kInfinity;
      }
    }
    const auto bottleneck = bottleneck_assignment(least);
    if (!bottleneck) {
      return Error{name(problem_.site) + ": the candidates can fly some of its " +
                   std::to_string(deliveries_) + " deliveries, but not all of them together"};
    }
    for (std::size_t r = 0; r < deliveries_; ++r) {
      delivery_s =
          std::max(delivery_s, least(static_cast<Eigen::Index>(r), bottleneck->column_of[r]));
    }
  }
  std::optional<double> moment = delivery_s;
  while (moment && trials_ < kTrialsMax) {
    if (auto result = try_delivery(*moment)) return *result;
    if (deliveries_ == 0) break;
    moment = next_moment(0, deliveries_, *moment);
  }
  return Error{name(problem_.site) + ": no times were found at which " +
               std::to_string(candidates_.size()) + " candidates could fly its " +
               std::to_string(deliveries_) + " deliveries and " + std::to_string(assessments()) +
               " assessments within their ranges"};
}

}  // namespace

Result<Allocation> allocate(const AllocationParams& params, const AllocationProblem& problem) {
  SKEIN_ASSERT(params.time_margin >= 1.0);
  return Allocator{params, problem}.run();
}

Result<TaskPlan> plan_task(const AllocationParams& params, const Candidate& vehicle, Instant start,
                           const Site& site, const TaskAssignment& assignment,
                           std::span<const Hazard> hazards) {
  const auto leg = leg_of(params, vehicle, site, assignment.task, hazards);
  if (!leg) return leg.error();
  const TaskKind kind = assignment.task.kind;
  const auto path =
      path_of_length(params.avoidance, transit_of(vehicle, leg->task, hazards),
                     transit_length_m(vehicle, kind, leg->task, start, assignment.time));
  if (!path) return path.error();
  return assemble(*path, leg->task, start, vehicle.speed_mps, vehicle.planning_radius_m);
}

Result<TaskPlan> plan_survey(const AllocationParams& params, const VehicleSpec& vehicle,
                             const Pose2& from, Instant start, const Site& site,
                             std::span<const Hazard> hazards) {
  const double radius_m = vehicle.planning_radius_m();
  // A survey is flown alone: in the sense that gets there sooner.
  const auto leg_in = [&](int turn) {
    return leg_to_arc(params.avoidance, from, radius_m, vehicle.sensor_radius_m,
                      vehicle.cruise_speed_mps, site, site.survey, turn, hazards);
  };
  Result<Leg> leg = leg_in(kCounterClockwise);
  if (auto other = leg_in(kClockwise); other && (!leg || other->shortest_m < leg->shortest_m)) {
    leg = std::move(other);
  }
  if (!leg) return leg.error();
  const auto path = shortest_clear_path(params.avoidance, from, leg->task.entry, radius_m, hazards);
  if (!path) return path.error();
  TaskPlan plan = assemble(*path, leg->task, start, vehicle.cruise_speed_mps, radius_m);
  plan.timed.tail_curvature_per_m = leg->task.run.curvature_per_m;  // it stays around the site
  return plan;
}

}  // namespace skein::planning
