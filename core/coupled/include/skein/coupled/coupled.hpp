// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "skein/base/geometry.hpp"
#include "skein/base/ids.hpp"
#include "skein/base/random.hpp"
#include "skein/base/result.hpp"
#include "skein/base/time.hpp"
#include "skein/coupled/criterion.hpp"
#include "skein/domain/hazard.hpp"
#include "skein/domain/path.hpp"
#include "skein/domain/site.hpp"
#include "skein/domain/task.hpp"
#include "skein/planning/avoidance.hpp"
#include "skein/planning/budget.hpp"

namespace skein::planning {

/// Several sites at once, several tasks for each vehicle one after another: who does what, in which
/// order and when. The sites are coupled because they share the vehicles, the vehicles because they
/// wait for each other. `allocate` (allocation.hpp) is one site with one task each.
///
/// The model. A vehicle flies at constant speed from its pose to the entry of its first task, flies
/// the task's run, goes from there to its next task. Each task has one vehicle that is capable of
/// it; a delivery uses up a load. A task has a time: for a delivery the moment over the site, for
/// survey and assess the start of the arc (as TaskAssignment). At each site
/// - deliveries come after the end of the survey, by `decide_wait` at least;
/// - deliveries are made together: each at one common moment plus its offset, by different
/// vehicles,
///   and nothing is fitted in between (no task both after one of them and before another);
/// - an assessment starts after the last delivery, by Site::assess_wait at least.
/// A vehicle that is early lengthens its path to the task. What a vehicle flies from the start to
/// the end of its last task, waiting included, is at most its range.
///
/// Waits: between near poses some lengths cannot be flown (length_gap, arrival.hpp). Every task has
/// the earliest time that can be flown after the task before it; none is delayed for the sake of a
/// later wait. With hazards more lengths than those of the gap may be missing: then the plan that
/// was found is mended, a task whose transit no path can fly is held until one can. The bound knows
/// nothing of that: a plan that had to be mended is not proven, and its gap says what it cost at
/// most.

/// What plans for and what bids: a vehicle where it is at CoupledProblem::start.
struct CoupledVehicle {
  VehicleId id;
  Pose2 pose;
  double speed_mps = 0.0;
  double planning_radius_m = 0.0;  ///< 0: it turns on the spot, and may wait anywhere
  double range_left_m = 0.0;
  double final_approach_m = 0.0;  ///< of a delivery
  double sensor_radius_m = 0.0;   ///< of the survey arc
  double assess_radius_m = 0.0;   ///< of the assessment arc
  Capabilities capabilities;
  std::uint8_t loads = 0;
  /// Where its range must still take it after its last task; none: it ends where that leaves it.
  std::optional<Vec2> home;
};

/// As ValueWeights (plan_value.hpp).
struct CoupledWeights {
  double reward = 1.0;
  double range = 1.0;
};

/// The length in metres of the shortest path between two poses with a least turn radius; infinite
/// where there is none.
using TransitLength = std::function<double(const Pose2& from, const Pose2& to, double radius_m)>;

/// What a vehicle may do, beside surveys.
enum class TaskShare : std::uint8_t {
  any,
  one_a_site,  ///< one task of each site, as in a coalition
  one,         ///< one task in all, so that each can be where its task begins
};

struct CoupledProblem {
  std::vector<CoupledVehicle> vehicles;  ///< at most kCoupledVehiclesMax
  std::vector<Site> sites;
  /// At most kCoupledTasksMax. A task of a site that is not named here was done before the start.
  std::vector<TaskId> open_tasks;
  /// Sites of which all open tasks are done, or none of them; by Criterion::value alone. The reward
  /// of what is left out is lost.
  std::vector<SiteId> optional_sites;
  /// Sites whose survey is a service: Site::survey.dwell over the site itself, entered and left on
  /// any heading, without an arc.
  std::vector<SiteId> service_sites;
  TaskShare share = TaskShare::any;
  Instant start{};
  Duration decide_wait{};  ///< from the end of a survey to the first delivery: the operator decides
  std::vector<Hazard> hazards;  ///< no run of a task enters one
  /// Where there is none: the shortest Dubins path, or shortest_clear_path if there are hazards.
  TransitLength transit_length_m;
  AvoidanceParams avoidance;
  bool flyable_waits = true;  ///< see above; false, or a transit_length_m: any wait can be flown
  /// Start angles tried, each in both senses, where a survey or assessment leaves it free; headings
  /// of a service, and of coming home.
  int free_starts = 8;
  /// A survey with a given start angle may be flown in either sense. Assessments are always flown
  /// counter-clockwise, so that vehicles on one circle keep their spacing.
  bool survey_in_both_senses = false;
  Criterion criterion = Criterion::value;
  CoupledWeights weights;
};
inline constexpr std::size_t kCoupledVehiclesMax = 64;
inline constexpr std::size_t kCoupledTasksMax = 128;

/// One task of a plan.
struct CoupledTask {
  TaskId task;
  VehicleId vehicle;
  double time_s = 0.0;  ///< after the problem's start, see above
  double end_s = 0.0;   ///< of its run
  Pose2 entry;
  Segment run;
  /// From the end of the vehicle's task before, or its pose at the start, to `entry`: what it
  /// flies, waiting included, and the least that it could.
  double transit_m = 0.0;
  double least_transit_m = 0.0;
};

struct CoupledPlan {
  std::vector<CoupledTask> tasks;  ///< by vehicle as in the problem, then by time
  std::vector<SiteId> left_out;    ///< of the optional sites
  double objective = 0.0;          ///< by the problem's criterion
  /// No plan is better than this: an upper bound of J, a lower bound of seconds. Equal to the
  /// objective when proven; nothing where the method has none.
  std::optional<double> bound;
  bool proven = false;  ///< optimal, to kCoupledTolerance of the objective
  std::uint64_t steps = 0;
  // The raw terms, whatever the criterion.
  double reward = 0.0;        ///< J1, decayed
  double range_left_m = 0.0;  ///< J2
  double completion_s = 0.0;
  double makespan_s = 0.0;

  /// |objective - bound| over |objective|; 1 without a bound.
  [[nodiscard]] double gap() const;
};
inline constexpr double kCoupledTolerance = 1e-9;

/// The baseline: tasks are tendered as soon as those before them are awarded, every able vehicle
/// bids the time at which it could end the task after all that it has been awarded, and the
/// earliest bid of all wins; the deliveries of a site are tendered one by one. As a contract net
/// does, it never takes back an award. Fails where it leaves a task that nobody can do.
[[nodiscard]] Result<CoupledPlan> greedy_awards(const CoupledProblem& problem);

/// Optimal, or the best so far with a bound when the budget is spent (a step is a node). Depth
/// first over plans built in the order of their times, from the plan of a short ruin and recreate.
/// A makespan is also proven by what routes single vehicles can have, and which fit together.
/// Deterministic; more steps never give a worse plan or a worse bound. Fails where there is no
/// plan, or none was found within the budget; the sentence tells which.
[[nodiscard]] Result<CoupledPlan> branch_and_bound(const CoupledProblem& problem,
                                                   const PlanningBudget& budget);

/// Ruin and recreate (Schrimpf 2000; operators chosen adaptively, Ropke and Pisinger 2006): tasks
/// are taken out of the plan and put back where they cost least; a step is one such change.
/// Anytime: more steps never give a worse plan. The same generator gives the same plan. A makespan
/// of up to 64 tasks is also sought by routes in between (branch_and_bound): they mostly prove it
/// where tasks are few, about twenty, which ends the search.
[[nodiscard]] Result<CoupledPlan> ruin_and_recreate(const CoupledProblem& problem, Random& random,
                                                    const PlanningBudget& budget);

}  // namespace skein::planning
