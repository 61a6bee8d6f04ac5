// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "model.hpp"
#include "partial.hpp"
#include "skein/planning/assignment.hpp"

namespace skein::planning::coupled {

/// What no plan that completes a partial plan can do better than.
class Bounds {
 public:
  explicit Bounds(const Model& model);

  /// By chains: every site alone with all vehicles where they are, as if no other site needed them.
  /// Its survey by one vehicle, its delivery by the same or another, its assessment by the same or
  /// another. O(open tasks x vehicles).
  [[nodiscard]] double chains(const PartialPlan& plan);
  /// Of the last chains(): no plan that completes it does an open task at an earlier time.
  [[nodiscard]] double head_s(Index task) const { return head_s_[at(task)]; }
  /// From the end of a task to that of what waits for it at its site, at least.
  [[nodiscard]] double tail_s(Index task) const { return tail_s_[at(task)]; }

  /// By places: could the open tasks have a place each, as the first, second, third ... of what a
  /// vehicle has still to do, for less than `limit`? `false` is certain. A task's time at a place
  /// is at least that of the shortest walk of so many open tasks that ends with it, and at least
  /// that of its chain; the places are given out by the assignment of the least sum (makespan: by
  /// any that is in time). What is not a vehicle's first also costs the leg to it, and the wait
  /// after it, or that the task before it was done as much later. Between groups only.
  /// O(vehicles x depth x tasks^2 + tasks^2 x places).
  [[nodiscard]] bool places_suffice(const PartialPlan& plan, double limit);

 private:
  /// The two least of a list, to know the least without one of them.
  struct TwoLeast {
    double least = kInfinity;
    double second = kInfinity;
    Index who = kNone;
    void take(double value, Index index);
    [[nodiscard]] double without(Index index) const { return index == who ? second : least; }
  };
  struct Open {
    Index task = 0;
    double cost = 0.0;               ///< by its chain
    double least_slope_per_s = 0.0;  ///< of its cost, as long as any task may have to wait
    double left_out = kInfinity;     ///< what it costs beyond `cost` not to be done
  };
  using PerTask = std::array<double, kCoupledTasksMax>;
  /// The open tasks that a class can do, side by side.
  struct Packed {
    std::size_t count = 0;
    std::array<std::size_t, kCoupledTasksMax> row{};  ///< of open_
    PerTask head_s{};
    PerTask after_s{};
    PerTask slope_per_s{};
    std::vector<double> leg_s;  ///< [from * count + to]
  };
  /// The next place of a vehicle, by packed task.
  struct Place {
    PerTask reach_s{};
    PerTask end_s{};
    PerTask wait_cost{};  ///< of range, from the end of the task before
  };

  void make_tails();
  void make_least_range_costs();
  double add_site(const PartialPlan& plan, double cost, Index site);
  double add_survey(const PartialPlan& plan, double cost, Index site);
  double add_deliveries(const PartialPlan& plan, double cost, Index site, double ready_s);
  double add_assessments(const PartialPlan& plan, double cost, Index site, double ready_s);
  [[nodiscard]] double arrival_s(const PartialPlan& plan, Index vehicle, Index task) const;
  [[nodiscard]] double between_s(Index vehicle, Index from, Index to) const;
  [[nodiscard]] bool in_time(Index vehicle, Index task, double end_s) const {
    return end_s <= model_.vehicles[at(vehicle)].latest_of_task_s[at(task)];
  }
  void find_open(const PartialPlan& plan);
  void pack();
  void make_places(const PartialPlan& plan, double room, double limit);
  [[nodiscard]] double penalty(const Open& open, const Vehicle& vehicle, double end_s,
                               double range_cost) const;
  void first_place(const PartialPlan& plan, const Packed& can, Index vehicle, Place& place) const;
  void next_place(const Packed& can, double weight_per_s, Place& place) const;
  [[nodiscard]] bool least_sum_is_below(double room);
  [[nodiscard]] bool give_places();
  [[nodiscard]] bool match(std::size_t row, Set128& tried);

  const Model& model_;
  std::vector<double> tail_s_;        ///< by task: from its end to the end of what waits for it
  std::vector<double> range_cost_;    ///< by task: the least that it adds, of the range used
  std::vector<double> least_into_s_;  ///< by class and task: the least leg from another task
  // Of the last chains(), by task.
  std::vector<double> head_s_;  ///< no plan has the task before
  double chains_cost_ = 0.0;
  // While a site is added, by vehicle.
  std::vector<double> survey_end_s_;
  std::vector<double> delivery_s_;
  TwoLeast surveyed_;
  TwoLeast delivered_;
  bool one_delivery_open_ = false;
  // Of the last places_suffice.
  std::array<Open, kCoupledTasksMax> open_{};
  std::size_t open_count_ = 0;
  std::vector<Packed> packed_;  ///< by class
  static constexpr std::size_t kPlacesMax = 128;
  std::size_t places_max_ = 64;  ///< more cost more than they prune
  double forgone_ = 0.0;         ///< cost of open tasks that can only be left out
  std::size_t places_ = 0;
  bool too_many_ = false;
  double row_sum_ = 0.0;         ///< of the least penalty of every task
  std::vector<double> penalty_;  ///< [row * kPlacesMax + place]
  std::vector<double> cost_;     ///< the part of it in use
  std::array<int, kCoupledTasksMax> place_of_{};
  AssignmentSolver solver_;
  std::array<Set128, kCoupledTasksMax> allowed_{};
  std::array<int, kPlacesMax> holder_{};
};

}  // namespace skein::planning::coupled
