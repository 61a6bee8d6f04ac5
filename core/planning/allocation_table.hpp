// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/planning/allocation.hpp"
#include "skein/planning/assignment.hpp"
#include "skein/planning/task_path.hpp"
#include "task_leg.hpp"
#include "transit_lengths.hpp"

namespace skein::planning {

/// The two moments that time every task of a coalition, seconds after the problem's start: each
/// delivery is flown at `delivery_s` plus its offset, every assessment begins at `assess_s`.
struct Moments {
  double delivery_s = 0.0;
  double assess_s = 0.0;
};

/// Row to column, complete, and when.
struct CoalitionPlan {
  std::vector<int> column_of;
  Moments at;
  double value = -std::numeric_limits<double>::infinity();  ///< J
};

/// What a method returns: a plan or none, and for how long it would have gone on.
struct MethodResult {
  std::optional<CoalitionPlan> plan;
  double bound = std::numeric_limits<double>::infinity();  ///< no plan has a greater J
  bool proven = false;  ///< nothing was left out: the plan is the best by the method's own measure
  bool cut = false;     ///< by the budget: it would have gone on
};

/// When a pair that is refused is said to be possible again: a moment at which it is, or, far
/// quicker, one before which it is not; who asks at that moment is refused until a later one.
enum class Resumption : std::uint8_t { exactly, at_the_earliest };

/// Who can do what, and when: rows are the open tasks (deliveries, then assessments), columns the
/// candidates by id. A pair is possible at a common moment from its `least_s` to its `greatest_s`,
/// but for gaps in the lengths of paths. Without hazards least_s is exact; with them it comes from
/// the plain Dubins length, a lower bound, until verify() has looked.
class AllocationTable {
 public:
  /// Fails where an open task is none of the site's.
  [[nodiscard]] static Result<AllocationTable> make(const AllocationParams& params,
                                                    const AllocationProblem& problem);

  [[nodiscard]] std::size_t rows() const { return rows_.size(); }
  [[nodiscard]] std::size_t columns() const { return candidates_.size(); }
  [[nodiscard]] std::size_t deliveries() const { return deliveries_; }
  [[nodiscard]] std::size_t assessments() const { return rows_.size() - deliveries_; }
  [[nodiscard]] bool is_delivery(std::size_t row) const { return row < deliveries_; }
  [[nodiscard]] const Candidate& candidate(std::size_t column) const { return candidates_[column]; }
  [[nodiscard]] const AllocationProblem& problem() const { return *problem_; }
  [[nodiscard]] const ValueWeights& weights() const { return params_->weights; }

  /// The least common moment of a pair; infinity where it is impossible.
  [[nodiscard]] double least_s(std::size_t row, std::size_t column) const {
    return least_s_[index(row, column)];
  }
  /// The greatest, by the vehicle's range.
  [[nodiscard]] double greatest_s(std::size_t row, std::size_t column) const {
    return greatest_s_[index(row, column)];
  }
  [[nodiscard]] double shortest_m(std::size_t row, std::size_t column) const {
    return pairs_[index(row, column)].shortest_m;
  }
  [[nodiscard]] bool possible(std::size_t row, std::size_t column) const {
    return least_s(row, column) < std::numeric_limits<double>::infinity();
  }
  /// As far as is known.
  [[nodiscard]] bool open(std::size_t row, std::size_t column, double common_s) const;
  /// True where the vehicle has a path of exactly the length that the moment asks for. Otherwise
  /// the pair is no longer open at that moment.
  [[nodiscard]] bool verify(std::size_t row, std::size_t column, double common_s,
                            Resumption resumption);
  /// As verify, for every row of the plan.
  [[nodiscard]] bool verify(const std::vector<int>& column_of, const Moments& at,
                            Resumption resumption);
  /// Makes every least_s exact.
  void measure_all();
  /// May J be greater for deliveries later than those at `delivery_s`, with the same vehicles?
  [[nodiscard]] bool waiting_pays(const Moments& at) const;
  /// Whichever delivery was said to be possible again at this moment is, or is refused.
  void settle_deliveries(double delivery_s);

  [[nodiscard]] double moment_of(std::size_t row, const Moments& at) const {
    return is_delivery(row) ? at.delivery_s : at.assess_s;
  }
  /// No delivery before it.
  [[nodiscard]] double first_moment_s() const { return first_moment_s_; }
  /// The assessments' required moment when the deliveries' is `delivery_s`.
  [[nodiscard]] double assess_after_s(double delivery_s) const;
  /// The latest moment of the deliveries with which the assessments are on time at `assess_s`.
  [[nodiscard]] double delivery_before_s(double assess_s) const;
  /// The next moment after `after_s` at which a pair of these rows becomes possible or stops to be.
  [[nodiscard]] std::optional<double> next_moment(std::size_t first, std::size_t last,
                                                  double after_s) const;

  /// J of the plan, as value_of gives it but for the rounding of times to nanoseconds.
  [[nodiscard]] double value(const std::vector<int>& column_of, const Moments& at) const;
  /// What of J the pair costs at the moments: metres flown.
  [[nodiscard]] double metres(std::size_t row, std::size_t column, const Moments& at) const {
    return candidates_[column].speed_mps * (moment_of(row, at) + rows_[row].complete_s);
  }
  /// J at these moments is at most this, for vehicles that are possible by `open`: as many of the
  /// slowest as there are tasks fly. -infinity where these are too few. Falls as either moment of
  /// `at` grows, but that late assessments are less late for later deliveries.
  [[nodiscard]] double bound(const Moments& at, const Moments& open) const;
  /// As bound, for all plans with moments not before these; never grows with either moment.
  [[nodiscard]] double bound_from(const Moments& at) const;

  /// What J may be greater by for arcs that begin elsewhere than these pairs, where their start is
  /// free, as far as lengths were measured; ranges and gaps aside.
  [[nodiscard]] double free_slack() const;
  /// Was an assessment of the plan refused by a gap that an arc from another start may not have?
  [[nodiscard]] bool may_start_elsewhere(const std::vector<int>& column_of, double assess_s) const;

  /// Completes a choice of vehicles to a plan at its best moments, verified; nothing where these
  /// vehicles cannot. `soonest`: the earliest moments, even where later deliveries had a greater J.
  [[nodiscard]] std::optional<CoalitionPlan> timed(const std::vector<int>& column_of,
                                                   bool soonest_only);

  [[nodiscard]] Allocation allocation(const CoalitionPlan& plan) const;
  /// What the candidates lack for the tasks, as far as it is known by now.
  [[nodiscard]] std::optional<Error> missing() const;

  [[nodiscard]] std::string name() const;

 private:
  struct Row {
    TaskId task;
    double offset_s = 0.0;    ///< from the common moment
    double complete_s = 0.0;  ///< from the common moment to the task's completion
  };
  struct Pair {
    Pose2 entry;
    double run_m = 0.0;
    double shortest_m = std::numeric_limits<double>::infinity();  ///< to the entry
    bool measured = false;     ///< shortest_m is no lower bound any more
    double verified_s = -1.0;  ///< the moment last found possible
    double refused_from_s = std::numeric_limits<double>::infinity();  ///< no path has the length
    double resumes_s = -std::numeric_limits<double>::infinity();      ///< until here
    std::unique_ptr<TransitLengths> lengths;  ///< where hazards are in reach, once it was needed
  };

  AllocationTable(const AllocationParams& params, const AllocationProblem& problem);
  [[nodiscard]] std::optional<Error> make_rows();
  void make_pairs();
  void make_deliveries();
  void make_assessments();
  void make_free_arcs(std::size_t column);
  [[nodiscard]] bool is_free(const Row& row) const;
  void add_slack(std::size_t row, std::size_t column, double slack_m);
  void make_bounds();
  void set_pair(std::size_t row, std::size_t column, const TaskPath& task, double shortest_m);
  void measure(std::size_t row, std::size_t column);
  [[nodiscard]] const Departure& departure(std::size_t column);
  [[nodiscard]] std::optional<double> flyable_from(std::size_t row, std::size_t column,
                                                   double wanted_m, Resumption resumption);
  [[nodiscard]] std::optional<Error> missing(TaskKind kind, std::size_t first,
                                             std::size_t last) const;
  [[nodiscard]] std::size_t index(std::size_t row, std::size_t column) const {
    return row * candidates_.size() + column;
  }
  [[nodiscard]] Instant time_of(std::size_t row, double common_s) const;
  [[nodiscard]] double least_metres(bool deliveries, double common_s, double open_s) const;
  [[nodiscard]] std::optional<double> soonest(const std::vector<int>& column_of, std::size_t first,
                                              std::size_t last, double from_s);

  const AllocationParams* params_;
  const AllocationProblem* problem_;
  std::vector<Candidate> candidates_;
  std::vector<Row> rows_;
  std::size_t deliveries_ = 0;
  std::vector<double> least_s_;
  std::vector<double> greatest_s_;
  std::vector<Pair> pairs_;
  std::vector<std::unique_ptr<Departure>> departures_;  ///< by column, once it was needed

  double first_moment_s_ = 0.0;
  double last_offset_s_ = 0.0;
  double free_slack_s_ = 0.0;  ///< what a start that was not looked at may be sooner by
  /// J = reward_scale_ (deliver_rewards_ exp(-beta t_d) + assess_rewards_ exp(-beta t_a))
  ///   + range_scale_ (range_m_ - metres) - timing_scale_ (t_a - required) assessments
  double reward_scale_ = 0.0;
  double deliver_rewards_ = 0.0;
  double assess_rewards_ = 0.0;
  double range_scale_ = 0.0;
  double range_m_ = 0.0;
  double timing_scale_ = 0.0;
  std::vector<std::size_t> by_speed_;      ///< columns, the slowest first
  std::vector<double> complete_latest_s_;  ///< of each kind's rows, the latest first
  std::vector<double> deliver_from_s_;     ///< by column: the least moment over the rows
  std::vector<double> assess_from_s_;
};

}  // namespace skein::planning
