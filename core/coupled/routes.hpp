// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "model.hpp"
#include "paths.hpp"
#include "skein/planning/budget.hpp"

namespace skein::planning::coupled {

/// Makespans by routes: all that one vehicle could do, in which order, in a plan that ends before a
/// limit; then plans of one route a vehicle that do every task once. A vehicle is hardly ever idle
/// in a good plan, so that routes are few, and those that fit together fewer. Set partitioning
/// (Balinski and Quandt 1964), enumerated: the task that the fewest routes do first; prices and the
/// times of the routes chosen rule out most of the others.
class Routes {
 public:
  explicit Routes(const Model& model);
  Routes(const Routes&) = delete;
  Routes(Routes&&) = delete;
  Routes& operator=(const Routes&) = delete;
  Routes& operator=(Routes&&) = delete;
  ~Routes() = default;

  struct Effort {
    std::uint64_t routes = 0;  ///< at most, of all vehicles
    std::uint64_t nodes = 0;   ///< plans begun, at most
  };
  enum class Outcome : std::uint8_t {
    too_many,  ///< routes for the effort, or for the time: not all are known, and none was tried
    cut_off,   ///< there may be a better plan
    done       ///< there is none
  };
  /// From the best plan known to a better one, as far as there is one within the effort.
  /// Precondition: can_cover(model).
  Outcome improve(Orders& orders, double& cost, const Effort& effort, const PlanningBudget& budget);

 private:
  /// A set of tasks.
  using Tasks = std::uint64_t;
  struct Route {
    Tasks tasks = 0;
    double end_s = 0.0;  ///< of the longest path through it, at least
    Index vehicle = 0;
    std::size_t first = 0;  ///< of visits_
    std::size_t count = 0;
    double worth = 0.0;  ///< the prices of its tasks
  };
  /// What of a site is in the route that is being made says when it goes on.
  struct Ready {
    double deliver_s = 0.0;
    double assess_s = 0.0;
  };
  [[nodiscard]] static constexpr Tasks bit_of(Index task) {
    return Tasks{1} << static_cast<unsigned>(task);
  }

  void make_bounds();
  Outcome search_below(double limit, const Effort& effort);
  bool make_routes();
  bool extend(Index vehicle, Tasks tasks, int loads, double free_s, double end_s);
  bool add_task(Index vehicle, Tasks tasks, int loads, double free_s, double end_s, Index task);
  [[nodiscard]] double ready_s(const Task& task) const;
  void set_ready(const Task& task, double time_s, double end_s);
  [[nodiscard]] Index hardest_task(const std::vector<std::size_t>& list, Tasks open);
  [[nodiscard]] bool is_below_limit(Tasks tasks);
  [[nodiscard]] bool tighten(std::size_t depth, Tasks open, int steps);
  double weigh(std::size_t depth, Tasks open);
  void drop_cheap(std::size_t depth, double room);
  bool move_prices(std::size_t depth, Tasks open, double room);
  void find_windows(std::size_t depth, Tasks open);
  [[nodiscard]] bool is_in_time(const Route& route, std::size_t depth) const;
  [[nodiscard]] bool goes_on(std::size_t list);
  void cover(std::size_t depth, Tasks open);
  void take_plan();

  const Model& model_;
  Model free_of_gaps_;  ///< as bounds must be: with gaps a later start may end earlier
  Timing timing_;
  Timing bound_timing_;
  Paths paths_;
  Tasks all_ = 0;
  std::vector<Tasks> excluded_;   ///< by task: what must not be before it in a route
  std::vector<double> head_s_;    ///< by task: its least time
  std::vector<double> tail_s_;    ///< from its end to that of what must follow it, at least
  std::vector<double> offset_s_;  ///< by site: the greatest
  // While routes are made, and plans of them.
  std::vector<Route> routes_;
  std::vector<Index> visits_;
  std::vector<Index> route_;
  std::vector<Ready> ready_;                     ///< by site
  std::vector<std::vector<std::size_t>> lists_;  ///< by depth: routes that may be added
  std::vector<std::vector<std::pair<double, std::size_t>>> choices_;  ///< by depth
  std::vector<int> counts_;
  /// By depth, by task: as head_s_ and tail_s_, with the routes chosen.
  std::vector<std::vector<double>> heads_s_;
  std::vector<std::vector<double>> tails_s_;
  std::vector<std::vector<double>> prices_;  ///< by depth, by task
  std::vector<double> most_;                 ///< by vehicle: what its dearest route is worth
  std::vector<std::size_t> dearest_;         ///< by vehicle: that route
  Orders orders_;
  Orders best_;
  double best_cost_ = kInfinity;
  double limit_ = kInfinity;
  std::uint64_t nodes_ = 0;
  std::uint64_t nodes_max_ = 0;
  std::uint64_t next_clock_ = 0;
  std::uint64_t routes_max_ = 0;
  const PlanningBudget* budget_ = nullptr;
  bool stopped_ = false;
};

/// A makespan, of no more tasks than a set holds.
[[nodiscard]] bool can_cover(const Model& model);

}  // namespace skein::planning::coupled
