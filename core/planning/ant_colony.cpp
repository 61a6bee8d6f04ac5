// SPDX-License-Identifier: Apache-2.0
#include "ant_colony.hpp"

#include <algorithm>
#include <cmath>

#include "exact_allocation.hpp"
#include "skein/base/assert.hpp"

namespace skein::planning {
namespace {

constexpr double kLeastVisibleCost = 0.02;  ///< so that eta = 1/V stays finite

/// How many vehicles are left that can deliver, that can assess, that can do either; and tasks.
struct Supply {
  int deliver = 0;
  int assess = 0;
  int either = 0;
};

class Colony {
 public:
  Colony(const ColonyParams& params, AllocationTable& table, const PlanningBudget& budget,
         Random random)
      : params_{params}, table_{table}, budget_{budget}, random_{random} {
    make_moves();
  }

  [[nodiscard]] MethodResult run();

 private:
  void make_moves();
  void begin_plan();
  [[nodiscard]] bool build_plan();
  [[nodiscard]] bool allowed(std::size_t row, std::size_t column) const;
  [[nodiscard]] std::size_t choose_vehicle();
  [[nodiscard]] std::size_t choose_task(std::size_t column);
  void take(std::size_t row, std::size_t column);
  [[nodiscard]] double expected_value() const;
  void reward_best();
  [[nodiscard]] std::size_t index(std::size_t row, std::size_t column) const {
    return column * table_.rows() + row;
  }
  [[nodiscard]] bool can(std::size_t column, bool deliver) const {
    return deliver ? can_deliver_[column] != 0 : can_assess_[column] != 0;
  }

  const ColonyParams& params_;
  AllocationTable& table_;
  const PlanningBudget& budget_;
  Random random_;

  std::vector<double> visibility_;  ///< eta^beta, by column then row; 0 where impossible
  std::vector<double> pheromone_;
  std::vector<double> initial_pheromone_;
  std::vector<double> range_share_;  ///< by column
  std::vector<char> can_deliver_;
  std::vector<char> can_assess_;
  Supply supply_;  ///< of all candidates

  // Of the plan that is being built.
  std::vector<int> column_of_;
  std::vector<char> free_;
  std::vector<double> capability_;  ///< by column
  std::vector<double> attraction_;  ///< by row
  Supply left_;
  int deliveries_left_ = 0;
  int assessments_left_ = 0;

  std::optional<CoalitionPlan> best_;
};

/// V = w1 Cd + w2 Ct (eq. 29): the length of the move and how much later than necessary it is, both
/// scaled to [0, 1] over the moves of its kind (eq. 30-31).
void Colony::make_moves() {
  const std::size_t rows = table_.rows();
  const std::size_t columns = table_.columns();
  visibility_.assign(rows * columns, 0.0);
  can_deliver_.assign(columns, 0);
  can_assess_.assign(columns, 0);
  const auto needed = least_moments(table_);
  double range_max_m = 0.0;
  for (std::size_t c = 0; c < columns; ++c) {
    range_max_m = std::max(range_max_m, table_.candidate(c).range_left_m);
  }
  for (std::size_t c = 0; c < columns; ++c) {
    range_share_.push_back(table_.candidate(c).range_left_m / range_max_m);
  }
  for (const bool deliver : {true, false}) {
    const std::size_t first = deliver ? 0 : table_.deliveries();
    const std::size_t last = deliver ? table_.deliveries() : rows;
    const double needed_s = !needed ? 0.0 : deliver ? needed->delivery_s : needed->assess_s;
    double length_max_m = 1e-9;
    double late_max_s = 1e-9;
    const auto late_s = [&](std::size_t row, std::size_t c) {
      return std::max(0.0, table_.least_s(row, c) - needed_s);
    };
    for (std::size_t row = first; row < last; ++row) {
      for (std::size_t c = 0; c < columns; ++c) {
        if (!table_.possible(row, c)) continue;
        (deliver ? can_deliver_ : can_assess_)[c] = 1;
        length_max_m = std::max(length_max_m, table_.shortest_m(row, c));
        late_max_s = std::max(late_max_s, late_s(row, c));
      }
    }
    for (std::size_t row = first; row < last; ++row) {
      for (std::size_t c = 0; c < columns; ++c) {
        if (!table_.possible(row, c)) continue;
        const double cost = params_.distance_weight * table_.shortest_m(row, c) / length_max_m +
                            params_.time_weight * late_s(row, c) / late_max_s;
        visibility_[index(row, c)] =
            std::pow(kLeastVisibleCost / (kLeastVisibleCost + cost), params_.beta);
      }
    }
  }
  for (std::size_t c = 0; c < columns; ++c) {
    supply_.deliver += can_deliver_[c];
    supply_.assess += can_assess_[c];
    supply_.either += can_deliver_[c] | can_assess_[c];
  }
  initial_pheromone_.reserve(visibility_.size());
  for (const double v : visibility_) initial_pheromone_.push_back(v > 0.0 ? params_.tau0 : 0.0);
  pheromone_ = initial_pheromone_;
}

void Colony::begin_plan() {
  column_of_.assign(table_.rows(), -1);
  free_.assign(table_.columns(), 1);
  left_ = supply_;
  deliveries_left_ = static_cast<int>(table_.deliveries());
  assessments_left_ = static_cast<int>(table_.assessments());
}

/// The vehicles that stay must be enough for the tasks that stay.
bool Colony::allowed(std::size_t row, std::size_t column) const {
  if (column_of_[row] >= 0 || visibility_[index(row, column)] == 0.0) return false;
  const bool deliver = table_.is_delivery(row);
  const int deliveries = deliveries_left_ - (deliver ? 1 : 0);
  const int assessments = assessments_left_ - (deliver ? 0 : 1);
  return left_.deliver - can_deliver_[column] >= deliveries &&
         left_.assess - can_assess_[column] >= assessments &&
         left_.either - 1 >= deliveries + assessments;
}

std::size_t draw(Random& random, const std::vector<double>& weights) {
  double sum = 0.0;
  for (const double w : weights) sum += w;
  double lot = random.uniform() * sum;
  std::size_t last = weights.size();
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (weights[i] <= 0.0) continue;
    last = i;
    lot -= weights[i];
    if (lot < 0.0) break;
  }
  return last;
}

/// In proportion to capability (eq. 26-27); columns() where nobody can act any more.
std::size_t Colony::choose_vehicle() {
  const auto rows = static_cast<double>(table_.rows());
  for (std::size_t c = 0; c < table_.columns(); ++c) {
    capability_[c] = 0.0;
    if (free_[c] == 0) continue;
    double strongest = 0.0;
    int count = 0;
    for (std::size_t row = 0; row < table_.rows(); ++row) {
      if (!allowed(row, c)) continue;
      ++count;
      strongest = std::max(strongest, pheromone_[index(row, c)]);
    }
    capability_[c] = range_share_[c] * strongest * static_cast<double>(count) / rows;
  }
  return draw(random_, capability_);
}

/// The best with probability q0, else in proportion to tau^alpha eta^beta (eq. 28).
std::size_t Colony::choose_task(std::size_t column) {
  std::size_t best = 0;
  for (std::size_t row = 0; row < table_.rows(); ++row) {
    const std::size_t i = index(row, column);
    attraction_[row] = 0.0;
    if (!allowed(row, column)) continue;
    attraction_[row] = std::pow(pheromone_[i], params_.alpha) * visibility_[i];
    if (attraction_[row] > attraction_[best]) best = row;
  }
  return random_.chance(params_.q0) ? best : draw(random_, attraction_);
}

void Colony::take(std::size_t row, std::size_t column) {
  column_of_[row] = static_cast<int>(column);
  free_[column] = 0;
  --(table_.is_delivery(row) ? deliveries_left_ : assessments_left_);
  left_.deliver -= can_deliver_[column];
  left_.assess -= can_assess_[column];
  left_.either -= 1;
  const std::size_t i = index(row, column);
  pheromone_[i] += params_.local_evaporation * (initial_pheromone_[i] - pheromone_[i]);
}

bool Colony::build_plan() {
  begin_plan();
  for (std::size_t step = 0; step < table_.rows(); ++step) {
    const std::size_t column = choose_vehicle();
    if (column == table_.columns()) return false;
    const std::size_t row = choose_task(column);
    if (!allowed(row, column)) return false;
    take(row, column);
  }
  return true;
}

/// J at the least moments of the pairs: no more than this can come of the plan, waiting aside.
double Colony::expected_value() const {
  Moments at{table_.first_moment_s(), 0.0};
  for (std::size_t row = 0; row < table_.deliveries(); ++row) {
    at.delivery_s =
        std::max(at.delivery_s, table_.least_s(row, static_cast<std::size_t>(column_of_[row])));
  }
  const double after_s = table_.assess_after_s(at.delivery_s);
  at.assess_s = after_s;
  for (std::size_t row = table_.deliveries(); row < table_.rows(); ++row) {
    at.assess_s =
        std::max(at.assess_s, table_.least_s(row, static_cast<std::size_t>(column_of_[row])));
  }
  double value = table_.value(column_of_, at);
  if (at.assess_s > after_s && table_.deliveries() > 0) {
    at.delivery_s = std::max(at.delivery_s, table_.delivery_before_s(at.assess_s));
    value = std::max(value, table_.value(column_of_, at));
  }
  return value;
}

void Colony::reward_best() {
  for (std::size_t i = 0; i < pheromone_.size(); ++i) {
    pheromone_[i] = std::max(params_.tau_least * initial_pheromone_[i],
                             (1.0 - params_.global_evaporation) * pheromone_[i]);
  }
  for (std::size_t row = 0; row < table_.rows(); ++row) {
    pheromone_[index(row, static_cast<std::size_t>(best_->column_of[row]))] +=
        params_.global_evaporation;
  }
}

MethodResult Colony::run() {
  MethodResult result;
  capability_.assign(table_.columns(), 0.0);
  attraction_.assign(table_.rows(), 0.0);
  std::uint64_t built = 0;
  const auto spent = [&] { return best_ && budget_.is_spent(built); };
  for (int generation = 0; generation < params_.generations && !spent(); ++generation) {
    for (int cluster = 0; cluster < params_.ants && !spent(); ++cluster) {
      ++built;
      if (!build_plan()) continue;
      if (best_ && expected_value() <= best_->value) continue;
      auto plan = table_.timed(column_of_, false);
      if (plan && (!best_ || plan->value > best_->value)) best_ = std::move(plan);
    }
    if (best_) reward_best();
  }
  result.plan = std::move(best_);
  return result;
}

}  // namespace

MethodResult ant_colony(const ColonyParams& params, AllocationTable& table,
                        const PlanningBudget& budget, Random random) {
  SKEIN_ASSERT(params.ants > 0 && params.q0 >= 0.0 && params.q0 <= 1.0);
  return Colony{params, table, budget, random}.run();
}

}  // namespace skein::planning
