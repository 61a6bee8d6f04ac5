// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/coupled/coupled.hpp"
#include "skein/planning/task_path.hpp"

/// What greedy_awards, branch_and_bound and ruin_and_recreate share: the problem in numbers, and
/// the times that follow from orders. Times are seconds after the problem's start.
namespace skein::planning::coupled {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr int kNone = -1;

/// A set of vehicles.
using Mask = std::uint64_t;
[[nodiscard]] constexpr Mask bit(int index) { return Mask{1} << static_cast<unsigned>(index); }

/// A set of 128 tasks, or places.
class Set128 {
 public:
  static constexpr int kNone = 128;
  [[nodiscard]] constexpr bool has(int i) const { return (word(i) >> (i & 63) & 1U) != 0; }
  constexpr void add(int i) { word(i) |= bit(i & 63); }
  constexpr void remove(int i) { word(i) &= ~bit(i & 63); }
  constexpr void clear() { low_ = high_ = 0; }
  [[nodiscard]] constexpr bool empty() const { return (low_ | high_) == 0; }
  /// The least that is not in `others`; kNone where there is none.
  [[nodiscard]] constexpr int first_without(const Set128& others) const {
    if (const std::uint64_t low = low_ & ~others.low_; low != 0) return std::countr_zero(low);
    return 64 + std::countr_zero(high_ & ~others.high_);
  }

 private:
  [[nodiscard]] constexpr const std::uint64_t& word(int i) const { return i < 64 ? low_ : high_; }
  [[nodiscard]] constexpr std::uint64_t& word(int i) { return i < 64 ? low_ : high_; }

  std::uint64_t low_ = 0;
  std::uint64_t high_ = 0;
};

/// An index of the problem in hand. Plain integers, because they count in flat arrays.
using Index = int;
[[nodiscard]] constexpr std::size_t at(Index i) { return static_cast<std::size_t>(i); }

struct Task {
  TaskId id;
  Index site = 0;
  double offset_s = 0.0;  ///< of a delivery, from the site's common moment; least 0
  double weight = 0.0;    ///< of its reward: F over the sum of F, times the weight of J1
  double decay_per_s = 0.0;
  Index first_visit = 0;  ///< its ways of being flown follow each other
  Index visits = 0;
  Index chords = 0;  ///< where those of its decay begin
};

/// The open tasks of a site.
struct SiteTasks {
  Index survey = kNone;
  std::vector<Index> deliveries;
  std::vector<Index> assessments;
  double assess_wait_s = 0.0;
  bool optional = false;
  int tasks = 0;             ///< of all kinds
  double reward_cost = 0.0;  ///< of leaving it out: all of its weights
};

/// From the end of a visit to the time of the next, the seconds between these two cannot be flown;
/// none where both are 0.
struct Gap {
  double low_s = 0.0;
  double high_s = 0.0;
};

/// Vehicles that fly alike. A visit is a task flown in one way.
struct VehicleClass {
  /// reach_s[from * visits + to]: from the end of a visit to the time of the next; infinite where
  /// it cannot be flown.
  std::vector<double> reach_s;
  std::vector<Gap> gaps;         ///< as reach_s
  std::vector<double> after_s;   ///< by visit: from its time to its end
  std::vector<TaskPath> paths;   ///< by visit
  std::vector<double> before_s;  ///< by visit: from the entry to its time
  /// Bounds of reach_s, by [from visit][task]: the best way, by way of other tasks too.
  std::vector<double> least_s;
  /// By [task][task]: the least over the ways of both.
  std::vector<double> least_between_s;
  std::vector<double> least_after_s;  ///< by task
};

struct Vehicle {
  Index kind = 0;                        ///< of Model::classes
  std::vector<double> reach_s;           ///< by visit: from its pose at the start
  std::vector<Gap> gaps;                 ///< as reach_s
  std::vector<double> least_s;           ///< by task, as VehicleClass::least_s
  double deadline_s = 0.0;               ///< its range
  std::vector<double> latest_s;          ///< by visit: its end, so that the range takes it home
  std::vector<double> latest_of_task_s;  ///< the latest of its visits
  int loads = 0;
  Capabilities capabilities;
  double range_weight_per_s = 0.0;  ///< cost of a second in flight
  /// The same for who searches: a little, where nothing else says that less is
  /// better.
  double search_weight_per_s = 0.0;
  Index twin = kNone;  ///< the vehicle before it that equals it in everything
};

class Model {
 public:
  [[nodiscard]] static Result<Model> make(const CoupledProblem& problem);

  std::vector<Task> tasks;
  std::vector<Index> task_of;  ///< by visit
  bool gaps = false;           ///< is there any?
  std::vector<SiteTasks> sites;
  std::vector<VehicleClass> classes;
  std::vector<Vehicle> vehicles;
  double decide_wait_s = 0.0;
  Criterion criterion = Criterion::value;
  bool offsets = false;  ///< is any offset not 0?
  bool any_optional = false;
  TaskShare share = TaskShare::any;
  static constexpr std::size_t kChords = 256;
  std::vector<double> chords;  ///< by decay and cell: the part of the reward that is lost
  double chords_per_s = 0.0;

  [[nodiscard]] Index task_count() const { return static_cast<Index>(tasks.size()); }
  [[nodiscard]] Index visit_count() const { return static_cast<Index>(task_of.size()); }
  [[nodiscard]] Index vehicle_count() const { return static_cast<Index>(vehicles.size()); }
  [[nodiscard]] const VehicleClass& class_of(Index vehicle) const {
    return classes[at(vehicles[at(vehicle)].kind)];
  }
  /// From where the vehicle is after `visit` (kNone: at the start), by visit.
  [[nodiscard]] const double* reach_from(Index vehicle, Index visit) const {
    const Vehicle& v = vehicles[at(vehicle)];
    if (visit == kNone) return v.reach_s.data();
    return classes[at(v.kind)].reach_s.data() + at(visit) * task_of.size();
  }
  [[nodiscard]] const Gap& gap_from(Index vehicle, Index visit, Index next) const {
    const Vehicle& v = vehicles[at(vehicle)];
    if (visit == kNone) return v.gaps[at(next)];
    return classes[at(v.kind)].gaps[at(visit) * task_of.size() + at(next)];
  }
  /// The earliest time from `time_s` on at which a vehicle that was free after `visit` can be at
  /// `next`, given that it can be there at some time until `time_s`.
  [[nodiscard]] double flyable_s(Index vehicle, Index visit, Index next, double free_s,
                                 double time_s) const {
    if (!gaps) return time_s;
    const Gap& gap = gap_from(vehicle, visit, next);
    return time_s > free_s + gap.low_s ? std::max(time_s, free_s + gap.high_s) : time_s;
  }
  [[nodiscard]] const double* least_from(Index vehicle, Index visit) const {
    const Vehicle& v = vehicles[at(vehicle)];
    if (visit == kNone) return v.least_s.data();
    return classes[at(v.kind)].least_s.data() + at(visit) * tasks.size();
  }

  /// What is minimised: the sum over the tasks (makespan: the largest) and, for `value`, the range
  /// used. It never falls when an end is later.
  [[nodiscard]] double cost_of(Index task, double end_s) const;
  /// A little less, and fast: chords of the decay, which is concave.
  [[nodiscard]] double least_cost_of(Index task, double end_s) const {
    if (criterion != Criterion::value) return cost_of(task, end_s);
    const Task& t = tasks[at(task)];
    const double cell = end_s * chords_per_s;
    if (!(cell < static_cast<double>(kChords))) return cost_of(task, end_s);
    const auto c = static_cast<std::size_t>(cell);
    const double* values = chords.data() + at(t.chords) + c;
    return t.weight * (values[0] + (values[1] - values[0]) * (cell - static_cast<double>(c)));
  }
  /// By how much at least `least_cost_of` grows in a second, up to a time; 0 where it is unknown.
  [[nodiscard]] double least_slope_of(Index task, double until_s) const {
    if (criterion != Criterion::value) return 0.0;
    const Task& t = tasks[at(task)];
    const double cell = until_s * chords_per_s;
    if (!(cell + 1.0 < static_cast<double>(kChords))) return 0.0;
    const double* values = chords.data() + at(t.chords) + static_cast<std::size_t>(cell) + 1;
    return t.weight * (values[1] - values[0]) * chords_per_s;
  }
  [[nodiscard]] double add(double cost, double more) const {
    return criterion == Criterion::makespan ? std::max(cost, more) : cost + more;
  }
  /// The criterion as people see it.
  [[nodiscard]] double objective(double cost) const {
    return criterion == Criterion::value ? best_value_ - cost : cost;
  }

 private:
  double best_value_ = 0.0;  ///< J if everything were done at once, without a metre flown
};

/// The visits of every vehicle, in order.
using Orders = std::vector<std::vector<Index>>;

/// May who has these orders not do that task, too?
[[nodiscard]] bool has_its_share(const Model& model, const std::vector<Index>& order,
                                 const Task& task);

/// By site: is it optional, and no task of it in the orders?
[[nodiscard]] std::vector<bool> left_out_of(const Model& model, const Orders& orders);
/// What that costs.
[[nodiscard]] double left_out_cost(const Model& model, const Orders& orders);

/// The earliest times for given orders. Tasks that are in no order are as if they did not exist.
class Timing {
 public:
  enum class Costs : std::uint8_t { exact, approximate };  ///< as Model::cost_of or least_cost_of
  explicit Timing(const Model& model, Costs costs = Costs::exact);

  /// The cost; infinite where the orders wait for each other in a circle, where a range does not
  /// suffice, or where the cost is more than `limit` (then it may stop early).
  double evaluate(const Orders& orders, double limit = kInfinity);
  /// From now on the task has no earlier time than this.
  void hold(Index task, double time_s);

  /// Of the last evaluate, when finite; by task.
  [[nodiscard]] const std::vector<double>& times_s() const { return time_s_; }
  [[nodiscard]] const std::vector<double>& ends_s() const { return end_s_; }
  /// One of the visits, and what its vehicle does next; kNone: nothing.
  struct Done {
    Index vehicle = kNone;
    Index visit = kNone;
    Index next = kNone;
  };
  /// All of them; what must follow another one comes after it.
  [[nodiscard]] const std::vector<Done>& done() const { return done_; }
  /// Of the tasks in the orders, over the number of all.
  [[nodiscard]] double mean_end_s() const {
    return end_sum_s_ / static_cast<double>(model_.tasks.size());
  }

 private:
  struct SiteState {
    bool survey_open = false;
    int deliveries_open = 0;
    int arrived = 0;
    double survey_end_s = 0.0;
    double common_s = 0.0;  ///< the moment of the deliveries
    double last_delivery_s = 0.0;
    Mask at_delivery = 0;  ///< vehicles that are there
    Mask for_survey = 0;   ///< vehicles that wait for its end
    Mask for_deliveries = 0;
  };
  struct VehicleState {
    const Index* next = nullptr;
    const Index* last = nullptr;
    Index before = kNone;  ///< the visit that it comes from
    double free_s = 0.0;
  };
  /// What is asked often, next to each other.
  struct Visit {
    Index task = kNone;
    Index site = kNone;
    TaskKind kind = TaskKind::survey;
    double offset_s = 0.0;
  };
  struct Flier {
    const double* after_s = nullptr;
    const double* latest_s = nullptr;
    double weight_per_s = 0.0;
  };
  void advance(Index vehicle);
  bool finish(Index vehicle, Index visit, double time_s);
  void release(Index index);
  [[nodiscard]] double common_of(const SiteState& site) const;
  void wake(Mask vehicles) { ready_ |= vehicles; }

  const Model& model_;
  Costs costs_;
  std::vector<Visit> visits_;
  std::vector<Flier> fliers_;
  std::vector<Done> done_;
  std::vector<SiteState> sites_;
  std::vector<VehicleState> vehicles_;
  std::vector<double> time_s_;
  std::vector<double> end_s_;
  std::vector<double> held_s_;  ///< by task; empty where none is held
  Mask ready_ = 0;
  int left_ = 0;
  double cost_ = 0.0;
  double end_sum_s_ = 0.0;
  double limit_ = kInfinity;
};

/// The plan of orders that Timing finds feasible. Where no path has the length of a transit that
/// waits, its task is held until one has, and what waits for that task too. Fails where the ranges
/// do not suffice for it.
[[nodiscard]] Result<CoupledPlan> make_plan(const Model& model, const CoupledProblem& problem,
                                            const Orders& orders);

/// Where a plan was sought, and there was none.
enum class Sought : std::uint8_t { everywhere, within_the_budget, in_one_way };

/// Why a problem has no plan, as far as is easily said; whether that is proven.
[[nodiscard]] Error no_plan(const Model& model, Sought sought);

/// The orders of greedy_awards; nothing where a task is left that is not of a
/// site left out.
[[nodiscard]] std::optional<Orders> greedy_orders(const Model& model);

}  // namespace skein::planning::coupled
