// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "model.hpp"

namespace skein::planning::coupled {

/// The longest paths through a plan: what a task more would make of its makespan, in O(1) a place,
/// as in the job shop (heads and tails, Mastrolilli and Gambardella 2000). Exact, but for gaps, for
/// deliveries with offsets and for places that would close a circle; those only Timing finds.
class Paths {
 public:
  explicit Paths(const Model& model);

  /// `timing` is that of the plan.
  void find(const Timing& timing);

  /// From the time of a task of the plan to the end of the last that must follow it.
  [[nodiscard]] double tail_s(Index task) const;

  /// A task that is not in the plan, as its site goes.
  struct Newcomer {
    double ready_s = 0.0;  ///< no earlier
    double tail_s = 0.0;   ///< from its end
    double group_s = 0.0;  ///< from its time, by way of the site's other deliveries
  };
  [[nodiscard]] Newcomer newcomer(const Task& task) const;
  /// The end of the longest path through a visit of it that is inserted into a vehicle's order;
  /// infinite where it would end after the vehicle's deadline.
  [[nodiscard]] double through_s(const Newcomer& task, const std::vector<Index>& order,
                                 const Timing& timing, Index vehicle, std::size_t position,
                                 Index visit) const;

 private:
  /// Of what of it is in the plan; kNever where nothing is.
  struct Site {
    double survey_end_s = kNever;
    double common_s = kNever;
    double last_delivery_s = kNever;
    double common_tail_s = kNever;  ///< from the common moment
    double assess_tail_s = kNever;
  };
  static constexpr double kNever = -1.0;

  [[nodiscard]] double site_tail_s(const Task& task) const;
  [[nodiscard]] double ready_s(const Task& task) const;

  const Model& model_;
  std::vector<Site> sites_;
  std::vector<double> tail_s_;  ///< by task
};

}  // namespace skein::planning::coupled
