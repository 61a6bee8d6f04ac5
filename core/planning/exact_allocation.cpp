// SPDX-License-Identifier: Apache-2.0
#include "exact_allocation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace skein::planning {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Weight of the shortest length against the flown one, so that it decides ties only.
constexpr double kTieBreak = 1e-7;
constexpr std::uint64_t kAssignmentsMax = 20000;  ///< solved before the sweep is given up

enum class Goal { value, earliest };

class Sweep {
 public:
  Sweep(AllocationTable& table, const PlanningBudget& budget, Goal goal)
      : table_{table}, budget_{budget}, goal_{goal} {}

  [[nodiscard]] MethodResult run();

 private:
  void visit(double delivery_s);
  [[nodiscard]] std::optional<double> soonest_assessments(double delivery_s);
  [[nodiscard]] bool solve(const Moments& at);
  [[nodiscard]] bool waits(const Moments& at) const;
  [[nodiscard]] std::optional<double> next_delivery(double after_s) const;
  [[nodiscard]] std::optional<double> next_visit(double after_s);
  [[nodiscard]] std::optional<double> next_assessment(double after_s) const {
    return table_.next_moment(table_.deliveries(), table_.rows(), after_s);
  }
  [[nodiscard]] bool improves(double bound) const {
    return !result_.plan || bound > result_.plan->value + kValueTolerance / 2.0;
  }
  [[nodiscard]] bool exhausted() const {
    return assignments_ >= kAssignmentsMax || budget_.is_spent(assignments_);
  }

  AllocationTable& table_;
  const PlanningBudget& budget_;
  Goal goal_;
  AssignmentSolver solver_;
  Moments least_;
  std::vector<double> cost_;
  std::vector<int> column_of_;
  MethodResult result_;
  double left_out_ = -kInfinity;  ///< bound of what a gap may have hidden
  bool grown_ = false;            ///< lengths were found to be greater than what least_ was made of
  std::uint64_t assignments_ = 0;
};

/// Deliveries may also wait until the assessments that need longer are just on time.
std::optional<double> Sweep::next_delivery(double after_s) const {
  if (table_.deliveries() == 0) return std::nullopt;
  const auto own = table_.next_moment(0, table_.deliveries(), after_s);
  if (goal_ == Goal::earliest || table_.assessments() == 0) return own;
  // The least assessment moment whose delivery moment lies beyond after_s.
  double assess_s = table_.assess_after_s(after_s);
  while (const auto next = next_assessment(assess_s)) {
    const double on_time_s = table_.delivery_before_s(*next);
    if (on_time_s > after_s) return own ? std::min(*own, on_time_s) : on_time_s;
    assess_s = *next;
  }
  return own;
}

/// The least moment at which assessments go with these deliveries, gaps and ranges aside.
std::optional<double> Sweep::soonest_assessments(double delivery_s) {
  const double after_s = table_.assess_after_s(delivery_s);
  cost_.clear();
  for (std::size_t row = 0; row < table_.rows(); ++row) {
    for (std::size_t c = 0; c < table_.columns(); ++c) {
      if (table_.is_delivery(row)) {
        cost_.push_back(table_.open(row, c, delivery_s) ? -kInfinity : kInfinity);
      } else {
        cost_.push_back(table_.least_s(row, c));
      }
    }
  }
  ++assignments_;
  const auto least_s = solver_.bottleneck(cost_, table_.columns(), column_of_);
  if (!least_s) return std::nullopt;
  return std::max(after_s, *least_s);
}

/// The best assignment at these moments; true when it is a plan (better than before, or not).
bool Sweep::solve(const Moments& at) {
  while (!exhausted()) {
    ++assignments_;
    cost_.assign(table_.rows() * table_.columns(), kInfinity);
    std::size_t i = 0;
    for (std::size_t row = 0; row < table_.rows(); ++row) {
      const double common_s = table_.moment_of(row, at);
      for (std::size_t c = 0; c < table_.columns(); ++c, ++i) {
        if (!table_.open(row, c, common_s)) continue;
        cost_[i] = goal_ == Goal::earliest
                       ? table_.shortest_m(row, c)
                       : table_.metres(row, c, at) + kTieBreak * table_.shortest_m(row, c);
      }
    }
    if (!solver_.least_sum(cost_, table_.columns(), column_of_)) return false;
    const double value = table_.value(column_of_, at);
    if (goal_ == Goal::value && !improves(value)) return true;
    if (!table_.verify(column_of_, at, Resumption::at_the_earliest)) {
      grown_ = true;
      if (waits(at) || table_.may_start_elsewhere(column_of_, at.assess_s))
        left_out_ = std::max(left_out_, value);
      continue;
    }
    result_.plan = CoalitionPlan{column_of_, at, value};
    return true;
  }
  result_.cut = true;
  return false;
}

/// Could these vehicles, refused at these moments, deliver somewhat sooner, just before a gap? That
/// moment is not known, and would be better only where deliveries wait for assessments.
bool Sweep::waits(const Moments& at) const {
  if (table_.assessments() == 0) return false;
  double least_s = table_.first_moment_s();
  for (std::size_t row = 0; row < table_.deliveries(); ++row) {
    least_s = std::max(least_s, table_.least_s(row, static_cast<std::size_t>(column_of_[row])));
  }
  if (least_s >= at.delivery_s) return false;
  bool refused = false;
  for (std::size_t row = 0; row < table_.deliveries(); ++row) {
    const auto column = static_cast<std::size_t>(column_of_[row]);
    if (!table_.open(row, column, least_s)) return false;
    refused = refused || !table_.open(row, column, at.delivery_s);
  }
  return refused;
}

void Sweep::visit(double delivery_s) {
  std::optional<double> assess_s = soonest_assessments(delivery_s);
  while (assess_s) {
    if (exhausted()) {
      result_.cut = true;
      return;
    }
    const Moments at{delivery_s, *assess_s};
    bool solved = true;
    if (goal_ == Goal::earliest) {
      solved = solve(at);
      if (solved) return;
    } else {
      if (!improves(table_.bound(at, {kInfinity, kInfinity}))) return;
      if (improves(table_.bound(at, at))) {
        // Elsewhere no plan is better at the end of a gap than all are that could be flown in it.
        if (table_.waiting_pays(at)) table_.settle_deliveries(delivery_s);
        solved = solve(at);
      }
    }
    if (table_.assessments() == 0) return;
    assess_s = next_assessment(*assess_s);
    if (solved || !assess_s) continue;
    const auto possible_s = soonest_assessments(delivery_s);
    assess_s = possible_s ? std::optional{std::max(*assess_s, *possible_s)} : std::nullopt;
  }
}

/// The moment after `after_s` to be visited, once more is known of the lengths.
std::optional<double> Sweep::next_visit(double after_s) {
  const auto next_s = next_delivery(after_s);
  if (!next_s || !std::exchange(grown_, false)) return next_s;
  const auto least = least_moments(table_);
  if (!least) return std::nullopt;
  least_ = *least;
  return std::max(*next_s, least_.delivery_s);
}

MethodResult Sweep::run() {
  const auto least = least_moments(table_);
  if (!least) return result_;
  least_ = *least;
  column_of_.assign(table_.rows(), -1);
  std::optional<double> delivery_s = least_.delivery_s;
  double unexplored = -kInfinity;
  while (delivery_s) {
    const double bound = table_.bound_from({*delivery_s, least_.assess_s});
    if (result_.plan && (goal_ == Goal::earliest || !improves(bound))) break;
    visit(*delivery_s);
    if (result_.cut) {
      unexplored = bound;
      break;
    }
    delivery_s = next_visit(*delivery_s);
  }
  const double value = result_.plan ? result_.plan->value + kValueTolerance / 2.0 : -kInfinity;
  result_.bound = std::max({value, unexplored, left_out_});
  result_.proven = !result_.cut && left_out_ <= value;
  return result_;
}

}  // namespace

MethodResult exact_allocation(AllocationTable& table, const PlanningBudget& budget) {
  return Sweep{table, budget, Goal::value}.run();
}

MethodResult earliest_allocation(AllocationTable& table, const PlanningBudget& budget) {
  MethodResult result = Sweep{table, budget, Goal::earliest}.run();
  result.bound = quick_bound(table);
  return result;
}

std::optional<Moments> least_moments(const AllocationTable& table) {
  AssignmentSolver solver;
  std::vector<double> least;
  std::vector<int> column_of;
  const auto bottleneck = [&](std::size_t first, std::size_t last) {
    least.clear();
    for (std::size_t row = first; row < last; ++row) {
      for (std::size_t c = 0; c < table.columns(); ++c) least.push_back(table.least_s(row, c));
    }
    column_of.resize(last - first);
    return solver.bottleneck(least, table.columns(), column_of);
  };
  const auto delivery_s = bottleneck(0, table.deliveries());
  const auto assess_s = bottleneck(table.deliveries(), table.rows());
  if (!delivery_s || !assess_s) return std::nullopt;
  const double first_s = std::max(table.first_moment_s(), *delivery_s);
  return Moments{first_s, std::max(table.assess_after_s(first_s), *assess_s)};
}

double quick_bound(const AllocationTable& table) {
  const auto least = least_moments(table);
  return least ? table.bound_from(*least) : -kInfinity;
}

}  // namespace skein::planning
