// SPDX-License-Identifier: Apache-2.0
#include "ant_colony.hpp"

#include <algorithm>
#include <cmath>

#include "exact_allocation.hpp"
#include "skein/base/assert.hpp"

namespace skein::planning {
namespace {

constexpr double kLeastCost = 0.02;  ///< added to V, so that eta = 1/V stays finite

class Colony {
 public:
  Colony(const ColonyParams& params, AllocationTable& table, const PlanningBudget& budget,
         Random random)
      : params_{params}, table_{table}, budget_{budget}, random_{random} {
    make_moves();
  }

  [[nodiscard]] MethodResult run();

 private:
  /// Tasks of one kind: the rows [first, last).
  struct Kind {
    std::size_t first = 0;
    std::size_t last = 0;
    std::vector<char> can;  ///< by column
    int vehicles = 0;       ///< that can
    // Of the plan that is being built.
    int vehicles_left = 0;
    int tasks_left = 0;
    std::vector<std::size_t> strongest;  ///< by column: the row of its strongest move
  };

  void make_moves();
  void find_able(Kind& kind) const;
  void look_at(const Moments& required);
  [[nodiscard]] double soonest_s(const Kind& kind, double from_s) const;
  void begin_plan();
  [[nodiscard]] bool build_plan();
  void find_strongest(Kind& kind, std::size_t column);
  [[nodiscard]] bool may(const Kind& kind, const Kind& other, std::size_t column) const;
  [[nodiscard]] std::size_t choose_vehicle();
  [[nodiscard]] std::size_t choose_task(std::size_t column);
  void take(std::size_t row, std::size_t column);
  [[nodiscard]] double expected_value() const;
  void reward_best();
  [[nodiscard]] std::size_t index(std::size_t row, std::size_t column) const {
    return column * table_.rows() + row;
  }

  const ColonyParams& params_;
  AllocationTable& table_;
  const PlanningBudget& budget_;
  Random random_;

  std::vector<double> visibility_;  ///< eta^beta, by column, then row; 0 where impossible
  std::vector<double> pheromone_;
  std::vector<double> first_pheromone_;
  std::vector<double> range_share_;  ///< by column
  Kind deliver_;
  Kind assess_;

  // Of the plan that is being built.
  std::vector<int> column_of_;
  std::vector<char> free_;
  std::vector<double> capability_;  ///< by column
  std::vector<double> attraction_;  ///< by row

  std::optional<CoalitionPlan> best_;
};

/// When each task of the kind had the vehicle that is there first, all of them could be flown.
double Colony::soonest_s(const Kind& kind, double from_s) const {
  double needed_s = from_s;
  for (std::size_t row = kind.first; row < kind.last; ++row) {
    double first_s = table_.least_s(row, 0);
    for (std::size_t c = 1; c < table_.columns(); ++c) {
      first_s = std::min(first_s, table_.least_s(row, c));
    }
    needed_s = std::max(needed_s, first_s);
  }
  return needed_s;
}

void Colony::find_able(Kind& kind) const {
  kind.can.assign(table_.columns(), 0);
  kind.strongest.assign(table_.columns(), kind.first);
  for (std::size_t row = kind.first; row < kind.last; ++row) {
    for (std::size_t c = 0; c < table_.columns(); ++c) {
      if (table_.possible(row, c)) kind.can[c] = 1;
    }
  }
  for (const char can : kind.can) kind.vehicles += can;
}

/// V = w1 Cd + w2 Ct (eq. 29): the length of the move, and how much later it is than its required
/// moment, both scaled to [0, 1] over the moves of its kind (eq. 30-31).
void Colony::look_at(const Moments& required) {
  for (const Kind* const one : {&deliver_, &assess_}) {
    const Kind& kind = *one;
    double length_max_m = 1e-9;
    double late_max_s = 1e-9;
    const auto late_s = [&](std::size_t row, std::size_t c) {
      return std::max(0.0, table_.least_s(row, c) - table_.moment_of(row, required));
    };
    const auto for_moves = [&](const auto& visit) {
      for (std::size_t row = kind.first; row < kind.last; ++row) {
        for (std::size_t c = 0; c < table_.columns(); ++c) {
          if (table_.possible(row, c)) visit(row, c);
        }
      }
    };
    for_moves([&](std::size_t row, std::size_t c) {
      length_max_m = std::max(length_max_m, table_.shortest_m(row, c));
      late_max_s = std::max(late_max_s, late_s(row, c));
    });
    for_moves([&](std::size_t row, std::size_t c) {
      const double cost = params_.distance_weight * table_.shortest_m(row, c) / length_max_m +
                          params_.time_weight * late_s(row, c) / late_max_s;
      visibility_[index(row, c)] = std::pow(kLeastCost / (kLeastCost + cost), params_.beta);
    });
  }
}

void Colony::make_moves() {
  visibility_.assign(table_.rows() * table_.columns(), 0.0);
  first_pheromone_ = visibility_;
  deliver_.last = assess_.first = table_.deliveries();
  assess_.last = table_.rows();
  find_able(deliver_);
  find_able(assess_);
  const double delivery_s = soonest_s(deliver_, table_.first_moment_s());
  look_at({delivery_s, soonest_s(assess_, table_.assess_after_s(delivery_s))});
  for (std::size_t i = 0; i < visibility_.size(); ++i) {
    first_pheromone_[i] = params_.tau0 * visibility_[i];
  }
  pheromone_ = first_pheromone_;
  double range_max_m = 0.0;
  for (std::size_t c = 0; c < table_.columns(); ++c) {
    range_max_m = std::max(range_max_m, table_.candidate(c).range_left_m);
  }
  for (std::size_t c = 0; c < table_.columns(); ++c) {
    range_share_.push_back(table_.candidate(c).range_left_m / range_max_m);
  }
  capability_.assign(table_.columns(), 0.0);
  attraction_.assign(table_.rows(), 0.0);
}

void Colony::find_strongest(Kind& kind, std::size_t column) {
  double strongest = -1.0;
  for (std::size_t row = kind.first; row < kind.last; ++row) {
    const double tau = pheromone_[index(row, column)];
    if (column_of_[row] >= 0 || tau <= strongest) continue;
    strongest = tau;
    kind.strongest[column] = row;
  }
}

void Colony::begin_plan() {
  column_of_.assign(table_.rows(), -1);
  free_.assign(table_.columns(), 1);
  for (Kind* kind : {&deliver_, &assess_}) {
    kind->vehicles_left = kind->vehicles;
    kind->tasks_left = static_cast<int>(kind->last - kind->first);
    for (std::size_t c = 0; c < table_.columns(); ++c) {
      if (kind->can[c] != 0) find_strongest(*kind, c);
    }
  }
}

/// Who can do both must be left to the other kind where that has no vehicle to spare.
bool Colony::may(const Kind& kind, const Kind& other, std::size_t column) const {
  if (kind.tasks_left == 0 || kind.can[column] == 0) return false;
  return other.can[column] == 0 || other.vehicles_left > other.tasks_left;
}

std::size_t draw(Random& random, const std::vector<double>& weights, double sum) {
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

/// In proportion to capability (eq. 26-27): the share of the range that is left, the strongest
/// pheromone of the next moves, the share of tasks that are allowed. Nobody acts twice, so the
/// count of tasks that remain to a vehicle is one. columns() where nobody can act.
std::size_t Colony::choose_vehicle() {
  double sum = 0.0;
  for (std::size_t c = 0; c < table_.columns(); ++c) {
    double strongest = 0.0;
    int allowed = 0;
    if (free_[c] != 0) {
      if (may(deliver_, assess_, c)) {
        strongest = pheromone_[index(deliver_.strongest[c], c)];
        allowed += deliver_.tasks_left;
      }
      if (may(assess_, deliver_, c)) {
        strongest = std::max(strongest, pheromone_[index(assess_.strongest[c], c)]);
        allowed += assess_.tasks_left;
      }
    }
    capability_[c] = range_share_[c] * strongest * allowed;
    sum += capability_[c];
  }
  return draw(random_, capability_, sum);
}

/// The best with probability q0, else in proportion to tau^alpha eta^beta (eq. 28).
std::size_t Colony::choose_task(std::size_t column) {
  const bool deliver = may(deliver_, assess_, column);
  const bool assess = may(assess_, deliver_, column);
  std::size_t best = 0;
  double sum = 0.0;
  for (std::size_t row = 0; row < table_.rows(); ++row) {
    const std::size_t i = index(row, column);
    attraction_[row] = 0.0;
    if (column_of_[row] >= 0 || !(table_.is_delivery(row) ? deliver : assess)) continue;
    const double tau =
        params_.alpha == 1.0 ? pheromone_[i] : std::pow(pheromone_[i], params_.alpha);
    attraction_[row] = tau * visibility_[i];
    sum += attraction_[row];
    if (attraction_[row] > attraction_[best]) best = row;
  }
  if (sum <= 0.0) return table_.rows();
  return random_.chance(params_.q0) ? best : draw(random_, attraction_, sum);
}

void Colony::take(std::size_t row, std::size_t column) {
  column_of_[row] = static_cast<int>(column);
  free_[column] = 0;
  deliver_.vehicles_left -= deliver_.can[column];
  assess_.vehicles_left -= assess_.can[column];
  Kind& kind = table_.is_delivery(row) ? deliver_ : assess_;
  --kind.tasks_left;
  const std::size_t i = index(row, column);
  pheromone_[i] += params_.local_evaporation * (first_pheromone_[i] - pheromone_[i]);
  for (std::size_t c = 0; c < table_.columns(); ++c) {
    if (free_[c] != 0 && kind.can[c] != 0 && kind.strongest[c] == row) find_strongest(kind, c);
  }
}

bool Colony::build_plan() {
  begin_plan();
  for (std::size_t step = 0; step < table_.rows(); ++step) {
    const std::size_t column = choose_vehicle();
    if (column == table_.columns()) return false;
    const std::size_t row = choose_task(column);
    if (row == table_.rows()) return false;
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
    pheromone_[i] =
        std::max(first_pheromone_[i], (1.0 - params_.global_evaporation) * pheromone_[i]);
  }
  for (std::size_t row = 0; row < table_.rows(); ++row) {
    pheromone_[index(row, static_cast<std::size_t>(best_->column_of[row]))] +=
        params_.global_evaporation;
  }
}

MethodResult Colony::run() {
  MethodResult result;
  std::uint64_t built = 0;
  const auto spent = [&] { return budget_.is_spent(built); };
  for (int generation = 0; generation < params_.generations && !spent(); ++generation) {
    for (int cluster = 0; cluster < params_.ants && !spent(); ++cluster) {
      ++built;
      if (!build_plan()) continue;
      if (best_ && expected_value() <= best_->value) continue;
      auto plan = table_.timed(column_of_, false);
      if (!plan || (best_ && plan->value <= best_->value)) continue;
      best_ = std::move(plan);
      look_at(best_->at);
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
