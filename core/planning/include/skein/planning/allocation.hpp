// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/domain/hazard.hpp"
#include "skein/domain/site.hpp"
#include "skein/domain/task.hpp"
#include "skein/domain/vehicle.hpp"
#include "skein/planning/avoidance.hpp"
#include "skein/planning/budget.hpp"
#include "skein/planning/plan_value.hpp"

namespace skein::planning {

/// A vehicle that may be given tasks, as its bid describes it.
struct Candidate {
  VehicleId id;
  Pose2 pose;  ///< predicted for AllocationProblem::start
  double speed_mps = 0.0;
  double planning_radius_m = 0.0;
  double range_left_m = 0.0;
  double final_approach_m = 0.0;
  double assess_radius_m = 0.0;
  Capabilities capabilities;
  std::uint8_t loads = 0;
};

struct AllocationProblem {
  Site site;
  std::vector<TaskId> open_tasks;  ///< of that site, none of them surveys
  std::vector<Candidate> candidates;
  std::vector<Hazard> hazards;
  Instant start{};              ///< t_e: when the candidates are at their predicted poses
  Instant earliest_delivery{};  ///< no delivery before it (the operator needs time to decide)
  /// When the last delivery of the site was or will be flown by somebody outside this problem;
  /// assessments wait for it too.
  Instant deliveries_done{};
  std::uint64_t seed = 1;  ///< of the methods that draw lots
};

/// How the tasks of one coalition are given to its candidates (docs/methods.md). All of them work
/// on one table of lengths and are judged by value_of.
enum class AllocationMethod : std::uint8_t {
  best,        ///< exact; where that could not finish, the best of all that the budget allowed
  exact,       ///< the greatest J, proven
  earliest,    ///< the earliest deliveries, then the earliest assessments, then the least lengths
  colony,      ///< division-of-labour ant colony (Wang 2022, eq. 26-32)
  polynomial,  ///< earliest completion, then the smallest coalition (Sujit, Manathara, Ghose 2014)
  greedy,      ///< contract net: task after task, each to whoever is there first
  count
};
[[nodiscard]] std::string_view to_string(AllocationMethod method);
[[nodiscard]] std::optional<AllocationMethod> allocation_method(std::string_view name);

/// Of the colony. The paper gives none of them; these are tuned (docs/methods.md).
struct ColonyParams {
  int generations = 60;              ///< at most
  int ants = 32;                     ///< m: ants of a subgroup, and plans of a generation
  double alpha = 1.0;                ///< weight of the pheromone tau
  double beta = 2.0;                 ///< weight of the visibility eta
  double q0 = 0.3;                   ///< how often the best move is taken without drawing
  double tau0 = 0.02;                ///< first and least pheromone of a move, times eta^beta
  double local_evaporation = 0.3;    ///< of a move that was taken, back to its first pheromone
  double global_evaporation = 0.02;  ///< rho: of every move, and what the best plan's moves get
  double distance_weight = 1.0;      ///< w1 of a move's cost
  double time_weight = 3.0;          ///< w2 of a move's cost
};

struct AllocationParams {
  AvoidanceParams avoidance;
  /// Lengths are raised by this factor before a time is promised, so that the wind can be paid for.
  double time_margin = 1.01;
  AllocationMethod method = AllocationMethod::best;
  ValueWeights weights;
  ColonyParams colony;
};

struct Allocation {
  std::vector<TaskAssignment> assignments;  ///< by task, each open task once
  double first_delivery_s = 0.0;            ///< after the problem's start; 0 without deliveries
  AllocationMethod method = AllocationMethod::best;  ///< whose plan it is; never best
  PlanValue value;
  double value_bound = 0.0;  ///< no plan has a greater J
  bool proven = false;       ///< no plan has a J greater by more than kValueTolerance

  [[nodiscard]] double gap() const { return value_bound - value.total; }
};
/// Plans whose J differs by less are of one value to exact; it takes the least sum of shortest
/// lengths.
inline constexpr double kValueTolerance = 1e-6;

/// Vehicles to tasks, one task each: all deliveries at one common time plus their offsets, all
/// assessments together, after the wait. Every time is one that the vehicle can fly exactly
/// (path_of_length succeeds), within its range. Deterministic but for budget.expired: ties by id.
/// More budget never gives a plan of a smaller J. A step is an assignment problem that exact
/// solves, or a plan that the colony builds. A spent budget stops exact, earliest and colony even
/// where they have no plan yet; best then still has that of greedy, which is quick. Fails with what
/// is missing ("site 2 needs 6 deliveries: 4 of 9 candidates can deliver"); the sentence tells
/// whether it is proven that there is no plan, or none was found within the budget.
[[nodiscard]] Result<Allocation> allocate(const AllocationParams& params,
                                          const AllocationProblem& problem,
                                          const PlanningBudget& budget = {});

/// The same, a metre larger: around an arc that touches a hazard an aircraft is flown some
/// centimetres into it.
[[nodiscard]] std::vector<Hazard> with_room_for_arcs(std::span<const Hazard> hazards);

/// The path of one assignment, from where the vehicle is at `start`: to the task's entry, timed,
/// and the task's run. `gate_m` is where the run begins: a delivery does not pass it unauthorised.
struct TaskPlan {
  TimedPath timed;      ///< transit + run, tail = orbit of the planning radius to the left
  double gate_m = 0.0;  ///< distance along timed.path at which the task's run begins
};
[[nodiscard]] Result<TaskPlan> plan_task(const AllocationParams& params, const Candidate& vehicle,
                                         Instant start, const Site& site,
                                         const TaskAssignment& assignment,
                                         std::span<const Hazard> hazards);

/// The path that surveys the site soonest, in either sense; its start angle is the required one, or
/// the best. After the arc it goes on around the site.
[[nodiscard]] Result<TaskPlan> plan_survey(const AllocationParams& params,
                                           const VehicleSpec& vehicle, const Pose2& from,
                                           Instant start, const Site& site,
                                           std::span<const Hazard> hazards);

}  // namespace skein::planning
