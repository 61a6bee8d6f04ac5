// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "model.hpp"
#include "paths.hpp"

namespace skein::planning::coupled {

/// Ruin and recreate, one step at a time.
class Search {
 public:
  /// From the greedy plan, or what can be made where it has none.
  Search(const Model& model, Random& random);

  void step();
  /// A better plan that was found otherwise, which it goes on from.
  void take(const Orders& orders);

  /// Infinite, and no orders of use, while no plan with all tasks was found.
  [[nodiscard]] double best_cost() const { return best_cost_; }
  [[nodiscard]] const Orders& best() const { return best_.orders; }
  [[nodiscard]] std::uint64_t steps() const { return steps_; }

 private:
  struct Solution {
    Orders orders;
    std::vector<Index> missing;  ///< tasks, with those of sites left out
    double score = kInfinity;
  };
  struct Place {
    Index vehicle = kNone;
    std::size_t position = 0;
    Index visit = kNone;
    double score = kInfinity;
  };
  /// One of several ways to do something, the more often the more it has helped.
  class Choice {
   public:
    explicit Choice(std::size_t count) : merits_(count, 1.0) {}
    std::size_t draw(Random& random);
    void learn(double merit);

   private:
    std::vector<double> merits_;
    std::size_t last_ = 0;
  };

  [[nodiscard]] double score_of(const Orders& orders, double limit = kInfinity);
  void accept_best();
  void begin_cycle();

  void ruin(Solution& plan);
  void take_out(Solution& plan);
  [[nodiscard]] Index critical_task();
  void choose_any(Index first, int count);
  void choose_near(Index seed, int count);
  void choose_vehicles(const Solution& plan, int count);
  void choose_site();
  void choose_late(int count);
  [[nodiscard]] Index any_task() { return static_cast<Index>(random_.index(model_.tasks.size())); }

  void recreate(Solution& plan, double limit);
  void leave_out_dropped(Solution& plan);
  [[nodiscard]] std::vector<Index> missing_of(const Orders& orders) const;
  [[nodiscard]] std::size_t must(const Solution& plan) const;
  [[nodiscard]] bool is_optional(Index task) const {
    return model_.sites[at(model_.tasks[at(task)].site)].optional;
  }
  [[nodiscard]] Place best_place(Solution& plan, Index task);
  [[nodiscard]] Place best_place_by_paths(Solution& plan, Index task);
  [[nodiscard]] double detour_s(Index vehicle, Index before, Index visit, Index next) const;
  [[nodiscard]] bool may_take(const Solution& plan, Index vehicle, const Task& task) const;
  [[nodiscard]] double least_score_at(const Solution& plan, Index vehicle, std::size_t position,
                                      Index visit) const;

  const Model& model_;
  Random& random_;
  Timing timing_;
  Solution current_;
  Solution best_;
  Solution next_;
  double best_cost_ = kInfinity;
  std::uint64_t steps_ = 0;
  Choice ruins_;
  Choice sorts_;
  Paths paths_;
  double timed_cost_ = kInfinity;  ///< of the last orders that timing_ was asked for
  // While a step is made, by task.
  std::vector<Index> vehicle_of_;
  std::vector<double> time_s_;
  std::vector<double> end_s_;
  std::vector<char> chosen_;
  std::vector<char> dropped_;  ///< by site: optional, and left out
  std::vector<std::pair<double, Index>> sorted_;
  std::vector<Place> places_;  ///< each with the least that it could score
};

/// Says of a plan what is known of the best that could be.
void mark(const Model& model, double bound_cost, bool proven, CoupledPlan& plan);

}  // namespace skein::planning::coupled
