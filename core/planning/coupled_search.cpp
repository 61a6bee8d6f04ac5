// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "coupled_model.hpp"

namespace skein::planning::coupled {
namespace {

// Tuned on the instances of tests/benchmarks/coupled_benchmark.cpp.
constexpr double kBlink = 0.02;        ///< chance that a place is overlooked, for variety
constexpr int kRuinMost = 12;          ///< tasks taken out at once
constexpr double kRuinPart = 0.5;      ///< and the part of all
constexpr std::uint64_t kCycle = 400;  ///< steps from hot to cold, then hot again from the best
constexpr double kHot = 0.02;          ///< of the best score: what a worse plan may cost
constexpr double kCold = 0.0005;
constexpr double kMissing = 1e9;  ///< score of a task that nobody does
constexpr double kForget = 0.95;  ///< of the operators' merits, a step
constexpr double kMerit = 0.1;    ///< that every operator keeps
constexpr double kNewBest = 4.0;
constexpr double kBetter = 2.0;
constexpr double kAccepted = 0.5;

constexpr double kMeanEnd = 0.02;  ///< of the score, where the criterion is the makespan

struct Solution {
  Orders orders;
  std::vector<Index> missing;  ///< tasks
  double score = kInfinity;
};

struct Place {
  Index vehicle = kNone;
  std::size_t position = 0;
  Index visit = kNone;
  double score = kInfinity;
};

/// One operator chosen among several, the more often the more it has helped.
template <std::size_t Count>
class Choice {
 public:
  std::size_t draw(Random& random) {
    double sum = 0.0;
    for (const double m : merits_) sum += m;
    double x = random.uniform() * sum;
    last_ = 0;
    while (last_ + 1 < Count && x >= merits_[last_]) x -= merits_[last_++];
    return last_;
  }
  void learn(double merit) {
    merits_[last_] = kForget * merits_[last_] + (1.0 - kForget) * (kMerit + merit);
  }

 private:
  std::array<double, Count> merits_ = [] {
    std::array<double, Count> all{};
    all.fill(1.0);
    return all;
  }();
  std::size_t last_ = 0;
};

class Search {
 public:
  Search(const Model& model, Random& random)
      : model_{model}, random_{random}, timing_{model}, place_of_(model.tasks.size(), kNone) {}

  SearchResult run(const PlanningBudget& budget);

 private:
  void start();
  void step(std::uint64_t number);
  /// Of the orders as they are, without what is missing.
  [[nodiscard]] double score_of(const Orders& orders, double limit = kInfinity) {
    const double cost = timing_.evaluate(orders, limit);
    // Only the last task counts for a makespan: without more, most changes would look alike.
    return model_.criterion == Criterion::makespan ? cost + kMeanEnd * timing_.mean_end_s() : cost;
  }

  void ruin(Solution& plan);
  void take_out(Solution& plan, const std::vector<bool>& chosen);
  void choose_any(std::vector<bool>& chosen, int count);
  void choose_near(std::vector<bool>& chosen, int count);
  void choose_vehicles(const Solution& plan, std::vector<bool>& chosen, int count);
  void choose_site(std::vector<bool>& chosen);
  void choose_late(std::vector<bool>& chosen, int count);

  void recreate(Solution& plan, double limit);
  [[nodiscard]] Place best_place(Solution& plan, Index task);
  [[nodiscard]] Index any_task() { return static_cast<Index>(random_.index(model_.tasks.size())); }

  const Model& model_;
  Random& random_;
  Timing timing_;
  Solution current_;
  Solution best_;
  std::vector<Index> place_of_;  ///< vehicle by task, while ruining
  std::vector<double> time_s_;
  std::vector<double> end_s_;
  Choice<5> ruins_;
  Choice<3> sorts_;
};

void Search::start() {
  current_.orders.assign(model_.vehicles.size(), {});
  if (auto orders = greedy_orders(model_)) {
    current_.orders = std::move(*orders);
    current_.score = score_of(current_.orders);
  } else {
    for (Index t = 0; t < model_.task_count(); ++t) current_.missing.push_back(t);
    recreate(current_, kInfinity);
  }
  best_ = current_;
}

SearchResult Search::run(const PlanningBudget& budget) {
  start();
  std::uint64_t steps = 0;
  for (; !budget.is_spent(steps); ++steps) step(steps);
  SearchResult result;
  result.steps = steps;
  if (best_.missing.empty() && best_.score < kInfinity) {
    result.cost = timing_.evaluate(best_.orders);
    result.orders = std::move(best_.orders);
  }
  return result;
}

void Search::step(std::uint64_t number) {
  const std::uint64_t phase = number % kCycle;
  if (phase == 0) current_ = best_;
  const double part = static_cast<double>(phase) / static_cast<double>(kCycle);
  const double heat = best_.missing.empty() ? kHot * std::pow(kCold / kHot, part) : 0.0;
  const double limit = current_.score - heat * best_.score * std::log(1.0 - random_.uniform());
  Solution plan = current_;
  ruin(plan);
  recreate(plan, limit);
  double merit = 0.0;
  if (plan.score < limit) {
    merit = plan.score < current_.score ? kBetter : kAccepted;
    current_ = std::move(plan);
    if (current_.score < best_.score) {
      best_ = current_;
      merit = kNewBest;
    }
  }
  ruins_.learn(merit);
  sorts_.learn(merit);
}

void Search::ruin(Solution& plan) {
  // The times of the plan say what lies near what.
  timing_.evaluate(plan.orders);
  time_s_ = timing_.times_s();
  end_s_ = timing_.ends_s();
  std::fill(place_of_.begin(), place_of_.end(), kNone);
  for (std::size_t i = 0; i < plan.orders.size(); ++i) {
    for (const Index v : plan.orders[i]) {
      place_of_[at(model_.task_of[at(v)])] = static_cast<Index>(i);
    }
  }
  const int most = std::clamp(static_cast<int>(kRuinPart * model_.task_count()), 2, kRuinMost);
  const int count = 1 + static_cast<int>(random_.index(static_cast<std::uint64_t>(most)));
  std::vector<bool> chosen(model_.tasks.size(), false);
  switch (ruins_.draw(random_)) {
    case 0:
      choose_any(chosen, count);
      break;
    case 1:
      choose_near(chosen, count);
      break;
    case 2:
      choose_vehicles(plan, chosen, count);
      break;
    case 3:
      choose_site(chosen);
      break;
    default:
      choose_late(chosen, count);
      break;
  }
  take_out(plan, chosen);
}

void Search::take_out(Solution& plan, const std::vector<bool>& chosen) {
  for (auto& order : plan.orders) {
    order.erase(std::remove_if(order.begin(), order.end(),
                               [&](Index v) { return chosen[at(model_.task_of[at(v)])]; }),
                order.end());
  }
  for (Index t = 0; t < model_.task_count(); ++t) {
    if (chosen[at(t)] && place_of_[at(t)] != kNone) plan.missing.push_back(t);
  }
}

void Search::choose_any(std::vector<bool>& chosen, int count) {
  for (int k = 0; k < count; ++k) chosen[at(any_task())] = true;
}

/// Near in time to one task, and nearer on the same vehicle or site (Shaw 1998).
void Search::choose_near(std::vector<bool>& chosen, int count) {
  const Index seed = any_task();
  const double span_s = 1.0 + *std::max_element(end_s_.begin(), end_s_.end());
  std::vector<std::pair<double, Index>> nearest;
  for (Index t = 0; t < model_.task_count(); ++t) {
    double apart = std::abs(time_s_[at(t)] - time_s_[at(seed)]) / span_s;
    if (place_of_[at(t)] != place_of_[at(seed)]) apart += 0.2;
    if (model_.tasks[at(t)].site != model_.tasks[at(seed)].site) apart += 0.2;
    nearest.emplace_back(t == seed ? 0.0 : apart * random_.uniform(0.5, 1.0), t);
  }
  std::sort(nearest.begin(), nearest.end());
  for (std::size_t k = 0; k < std::min(nearest.size(), at(count)); ++k) {
    chosen[at(nearest[k].second)] = true;
  }
}

/// All that some vehicles do.
void Search::choose_vehicles(const Solution& plan, std::vector<bool>& chosen, int count) {
  while (count > 0) {
    const Index task = any_task();
    chosen[at(task)] = true;
    --count;
    if (place_of_[at(task)] == kNone) continue;
    for (const Index v : plan.orders[at(place_of_[at(task)])]) {
      chosen[at(model_.task_of[at(v)])] = true;
      --count;
    }
  }
}

void Search::choose_site(std::vector<bool>& chosen) {
  const Index site = model_.tasks[at(any_task())].site;
  // Of a large site a part, or nearly the whole plan would go.
  const int tasks = static_cast<int>(std::count_if(model_.tasks.begin(), model_.tasks.end(),
                                                   [&](const Task& t) { return t.site == site; }));
  const double part = std::min(1.0, static_cast<double>(kRuinMost) / tasks);
  for (std::size_t t = 0; t < model_.tasks.size(); ++t) {
    chosen[t] = model_.tasks[t].site == site && random_.chance(part);
  }
}

/// The tasks that end last, most of them.
void Search::choose_late(std::vector<bool>& chosen, int count) {
  std::vector<std::pair<double, Index>> latest;
  for (Index t = 0; t < model_.task_count(); ++t) {
    latest.emplace_back(-end_s_[at(t)] * random_.uniform(0.6, 1.0), t);
  }
  std::sort(latest.begin(), latest.end());
  for (std::size_t k = 0; k < std::min(latest.size(), at(count)); ++k) {
    chosen[at(latest[k].second)] = true;
  }
}

/// Puts back one task after the other, each where it costs least.
void Search::recreate(Solution& plan, double limit) {
  std::vector<std::pair<double, Index>> sorted;
  const std::size_t sort = sorts_.draw(random_);
  for (const Index t : plan.missing) {
    const Task& task = model_.tasks[at(t)];
    double key = random_.uniform();
    if (sort == 1) key += static_cast<double>(task.id.kind);
    if (sort == 2) {
      double soonest = kInfinity;
      for (const Vehicle& v : model_.vehicles) soonest = std::min(soonest, v.least_s[at(t)]);
      key = -soonest * (0.5 + key);
    }
    sorted.emplace_back(key, t);
  }
  std::sort(sorted.begin(), sorted.end());
  plan.missing.clear();
  plan.score = score_of(plan.orders);
  for (const auto& [key, task] : sorted) {
    const Place place = best_place(plan, task);
    if (place.vehicle == kNone) {
      plan.missing.push_back(task);
      if (limit < kMissing) break;
      continue;
    }
    auto& order = plan.orders[at(place.vehicle)];
    order.insert(order.begin() + static_cast<std::ptrdiff_t>(place.position), place.visit);
    plan.score = place.score;
    if (plan.score >= limit) break;  // it only grows
  }
  plan.score = plan.score >= limit
                   ? kInfinity
                   : plan.score + kMissing * static_cast<double>(plan.missing.size());
}

Place Search::best_place(Solution& plan, Index task) {
  const Task& its = model_.tasks[at(task)];
  Place best;
  // What is there keeps its times or is later, so that this much is certain of every place.
  timing_.evaluate(plan.orders);
  end_s_ = timing_.ends_s();
  const double base = plan.score;
  for (Index i = 0; i < model_.vehicle_count(); ++i) {
    const Vehicle& vehicle = model_.vehicles[at(i)];
    auto& order = plan.orders[at(i)];
    if (its.id.kind == TaskKind::deliver) {
      const auto used = std::count_if(order.begin(), order.end(), [&](Index v) {
        return model_.tasks[at(model_.task_of[at(v)])].id.kind == TaskKind::deliver;
      });
      if (used >= vehicle.loads) continue;
    }
    for (std::size_t p = 0; p <= order.size(); ++p) {
      const Index before = p == 0 ? kNone : order[p - 1];
      const double free_s = p == 0 ? 0.0 : end_s_[at(model_.task_of[at(before)])];
      const double* reach_s = model_.reach_from(i, before);
      for (Index v = its.first_visit; v < its.first_visit + its.visits; ++v) {
        const double end_s = free_s + reach_s[v] + model_.class_of(i).after_s[at(v)];
        if (!(end_s <= vehicle.deadline_s)) continue;
        if (model_.add(base, model_.cost_of(task, end_s)) >= best.score) continue;
        if (random_.chance(kBlink)) continue;
        order.insert(order.begin() + static_cast<std::ptrdiff_t>(p), v);
        const double score = score_of(plan.orders, best.score);
        order.erase(order.begin() + static_cast<std::ptrdiff_t>(p));
        if (score < best.score) best = {i, p, v, score};
      }
    }
  }
  return best;
}

}  // namespace

SearchResult search(const Model& model, Random& random, const PlanningBudget& budget) {
  return Search{model, random}.run(budget);
}

}  // namespace skein::planning::coupled

namespace skein::planning {

Result<CoupledPlan> ruin_and_recreate(const CoupledProblem& problem, Random& random,
                                      const PlanningBudget& budget) {
  const auto model = coupled::Model::make(problem);
  if (!model) return model.error();
  const auto found = coupled::search(*model, random, budget);
  if (found.cost == coupled::kInfinity) return coupled::no_plan(*model);
  CoupledPlan plan = coupled::make_plan(*model, problem, found.orders);
  plan.steps = found.steps;
  return plan;
}

}  // namespace skein::planning
