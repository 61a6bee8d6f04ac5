// SPDX-License-Identifier: Apache-2.0
#include "search.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "routes.hpp"

namespace skein::planning::coupled {
namespace {

// Tuned on the instances of tests/benchmarks/coupled.cpp.
constexpr double kBlink = 0.02;        ///< chance that a place is overlooked, for variety
constexpr int kRuinMost = 12;          ///< tasks taken out at once
constexpr double kRuinPart = 0.7;      ///< and the part of all
constexpr std::uint64_t kCycle = 400;  ///< steps from hot to cold, then hot again from the best
constexpr double kHot = 0.2;           ///< of the best score: what a worse plan may cost
constexpr double kCold = 0.0005;
constexpr double kMissing = 1e9;  ///< score of a task that nobody does
constexpr double kForget = 0.95;  ///< of the operators' merits, a step
constexpr double kMerit = 0.1;    ///< that every operator keeps
constexpr double kNewBest = 4.0;
constexpr double kBetter = 2.0;
constexpr double kAccepted = 0.5;

constexpr std::size_t kRuins = 5;
constexpr std::size_t kSorts = 3;
constexpr std::size_t kSortsOfOptional = 4;
constexpr double kLeaveOut = 0.03;  ///< chance that an optional site is not put back, for variety

// Where the criterion is the makespan.
constexpr double kMeanEnd = 0.1;  ///< of the score
constexpr double kPath = 0.02;    ///< of a place: how long the path through it is
constexpr double kDetour = 0.05;  ///< and how much more its vehicle flies
constexpr std::uint64_t kCycleOfPaths = 100;
constexpr double kAnew = 0.5;         ///< chance that a cycle does not go on from the best plan
constexpr int kRuinMostOfPaths = 15;  ///< tasks taken out at once, and not only a part of all
constexpr double kAny = 0.5;          ///< chance that they are any, not near to each other
constexpr double kCritical = 0.8;     ///< chance that the first is on a longest path
// Plans made of routes, in between: after so many steps, then each time that there are twice as
// many.
constexpr std::uint64_t kStepsBeforeRoutes = 200;
constexpr std::uint64_t kRoutesPerStep = 20;
constexpr std::uint64_t kNodesPerStep = 5;
constexpr std::uint64_t kNodesLeast = 5000;
constexpr double kOnPath = 1.0 - 1e-9;  ///< of the makespan: the length of a longest path

}  // namespace

std::size_t Search::Choice::draw(Random& random) {
  double sum = 0.0;
  for (const double m : merits_) sum += m;
  double x = random.uniform() * sum;
  last_ = 0;
  while (last_ + 1 < merits_.size() && x >= merits_[last_]) x -= merits_[last_++];
  return last_;
}

void Search::Choice::learn(double merit) {
  merits_[last_] = kForget * merits_[last_] + (1.0 - kForget) * (kMerit + merit);
}

Search::Search(const Model& model, Random& random)
    : model_{model},
      random_{random},
      timing_{model, Timing::Costs::approximate},
      ruins_{kRuins},
      sorts_{model.any_optional ? kSortsOfOptional : kSorts},
      paths_{model},
      vehicle_of_(model.tasks.size(), kNone),
      chosen_(model.tasks.size(), 0),
      dropped_(model.sites.size(), 0) {
  current_.orders.assign(model_.vehicles.size(), {});
  if (auto orders = greedy_orders(model_)) {
    current_.orders = std::move(*orders);
    current_.missing = missing_of(current_.orders);
    current_.score = score_of(current_.orders) + left_out_cost(model_, current_.orders);
  } else {
    for (Index t = 0; t < model_.task_count(); ++t) current_.missing.push_back(t);
    recreate(current_, kInfinity);
  }
  best_ = current_;
  accept_best();
}

double Search::score_of(const Orders& orders, double limit) {
  const double cost = timing_.evaluate(orders, limit);
  timed_cost_ = cost;
  // Only the last task counts for a makespan: without more, most changes would look alike.
  return model_.criterion == Criterion::makespan ? cost + kMeanEnd * timing_.mean_end_s() : cost;
}

/// Keeps `current_` if it is the best; by its true cost, so that more steps are never worse.
void Search::accept_best() {
  if (must(current_) > 0 || current_.score == kInfinity) {
    if (best_cost_ == kInfinity) best_ = current_;
    return;
  }
  const double cost =
      Timing{model_}.evaluate(current_.orders) + left_out_cost(model_, current_.orders);
  if (cost > best_cost_) return;
  best_cost_ = cost;
  best_ = current_;
}

std::vector<Index> Search::missing_of(const Orders& orders) const {
  std::vector<char> done(model_.tasks.size(), 0);
  for (const auto& order : orders) {
    for (const Index v : order) done[at(model_.task_of[at(v)])] = 1;
  }
  std::vector<Index> missing;
  for (Index t = 0; t < model_.task_count(); ++t) {
    if (done[at(t)] == 0) missing.push_back(t);
  }
  return missing;
}

/// How many tasks are missing that cannot be left out.
std::size_t Search::must(const Solution& plan) const {
  return static_cast<std::size_t>(std::count_if(plan.missing.begin(), plan.missing.end(),
                                                [this](Index t) { return !is_optional(t); }));
}

/// Hot again, from the best plan or, as what is near that may be worse than what is far, anew.
void Search::begin_cycle() {
  current_ = best_;
  if (model_.criterion != Criterion::makespan || steps_ == 1 || !random_.chance(kAnew)) return;
  next_ = best_;
  for (auto& order : next_.orders) order.clear();
  next_.missing = missing_of(next_.orders);
  recreate(next_, kInfinity);
  if (must(next_) == 0 && next_.score < kInfinity) std::swap(current_, next_);
}

void Search::step() {
  const std::uint64_t cycle = model_.criterion == Criterion::makespan ? kCycleOfPaths : kCycle;
  const std::uint64_t phase = steps_++ % cycle;
  if (phase == 0) begin_cycle();
  const double part = static_cast<double>(phase) / static_cast<double>(cycle);
  const double heat = best_cost_ < kInfinity ? kHot * std::pow(kCold / kHot, part) : 0.0;
  const double limit = current_.score - heat * best_.score * std::log(1.0 - random_.uniform());
  next_ = current_;
  ruin(next_);
  recreate(next_, limit);
  double merit = 0.0;
  if (next_.score < limit) {
    merit = next_.score < current_.score ? kBetter : kAccepted;
    std::swap(current_, next_);
    if (current_.score < best_.score) {
      merit = kNewBest;
      accept_best();
    }
  }
  ruins_.learn(merit);
  sorts_.learn(merit);
}

void Search::take(const Orders& orders) {
  current_.orders = orders;
  current_.missing = missing_of(orders);
  current_.score = score_of(orders) + left_out_cost(model_, orders);
  accept_best();
}

void Search::ruin(Solution& plan) {
  // The times of the plan say what lies near what.
  timing_.evaluate(plan.orders);
  time_s_ = timing_.times_s();
  end_s_ = timing_.ends_s();
  std::fill(vehicle_of_.begin(), vehicle_of_.end(), kNone);
  for (std::size_t i = 0; i < plan.orders.size(); ++i) {
    for (const Index v : plan.orders[i]) {
      vehicle_of_[at(model_.task_of[at(v)])] = static_cast<Index>(i);
    }
  }
  const bool by_paths = model_.criterion == Criterion::makespan;
  const int most =
      by_paths ? std::min(model_.task_count(), kRuinMostOfPaths)
               : std::clamp(static_cast<int>(kRuinPart * model_.task_count()), 2, kRuinMost);
  const int count = 1 + static_cast<int>(random_.index(static_cast<std::uint64_t>(most)));
  std::fill(chosen_.begin(), chosen_.end(), 0);
  if (by_paths) {
    // Only a longest path can be shortened; whole sites or vehicles help less often.
    const Index first = random_.chance(kCritical) ? critical_task() : any_task();
    if (random_.chance(kAny)) {
      choose_any(first, count);
    } else {
      choose_near(first, count);
    }
    take_out(plan);
    return;
  }
  switch (ruins_.draw(random_)) {
    case 0:
      choose_any(any_task(), count);
      break;
    case 1:
      choose_near(any_task(), count);
      break;
    case 2:
      choose_vehicles(plan, count);
      break;
    case 3:
      choose_site();
      break;
    default:
      choose_late(count);
      break;
  }
  take_out(plan);
}

void Search::take_out(Solution& plan) {
  for (auto& order : plan.orders) {
    order.erase(std::remove_if(order.begin(), order.end(),
                               [&](Index v) { return chosen_[at(model_.task_of[at(v)])] != 0; }),
                order.end());
  }
  for (Index t = 0; t < model_.task_count(); ++t) {
    if (chosen_[at(t)] != 0 && vehicle_of_[at(t)] != kNone) plan.missing.push_back(t);
  }
}

Index Search::critical_task() {
  paths_.find(timing_);
  const double longest_s = *std::max_element(end_s_.begin(), end_s_.end());
  sorted_.clear();
  for (Index t = 0; t < model_.task_count(); ++t) {
    if (vehicle_of_[at(t)] == kNone) continue;
    if (time_s_[at(t)] + paths_.tail_s(t) >= kOnPath * longest_s) sorted_.emplace_back(0.0, t);
  }
  return sorted_.empty() ? any_task() : sorted_[random_.index(sorted_.size())].second;
}

void Search::choose_any(Index first, int count) {
  chosen_[at(first)] = 1;
  for (int k = 1; k < count; ++k) chosen_[at(any_task())] = 1;
}

/// Near in time to one task, and nearer on the same vehicle or site (Shaw 1998).
void Search::choose_near(Index seed, int count) {
  const double span_s = 1.0 + *std::max_element(end_s_.begin(), end_s_.end());
  sorted_.clear();
  for (Index t = 0; t < model_.task_count(); ++t) {
    double apart = std::abs(time_s_[at(t)] - time_s_[at(seed)]) / span_s;
    if (vehicle_of_[at(t)] != vehicle_of_[at(seed)]) apart += 0.2;
    if (model_.tasks[at(t)].site != model_.tasks[at(seed)].site) apart += 0.2;
    sorted_.emplace_back(t == seed ? 0.0 : apart * random_.uniform(0.5, 1.0), t);
  }
  std::sort(sorted_.begin(), sorted_.end());
  for (std::size_t k = 0; k < std::min(sorted_.size(), at(count)); ++k) {
    chosen_[at(sorted_[k].second)] = 1;
  }
}

/// All that some vehicles do.
void Search::choose_vehicles(const Solution& plan, int count) {
  while (count > 0) {
    const Index task = any_task();
    chosen_[at(task)] = 1;
    --count;
    if (vehicle_of_[at(task)] == kNone) continue;
    for (const Index v : plan.orders[at(vehicle_of_[at(task)])]) {
      chosen_[at(model_.task_of[at(v)])] = 1;
      --count;
    }
  }
}

void Search::choose_site() {
  const Index site = model_.tasks[at(any_task())].site;
  // Of a large site a part, or nearly the whole plan would go.
  const int tasks = static_cast<int>(std::count_if(model_.tasks.begin(), model_.tasks.end(),
                                                   [&](const Task& t) { return t.site == site; }));
  const double part = std::min(1.0, static_cast<double>(kRuinMost) / tasks);
  for (std::size_t t = 0; t < model_.tasks.size(); ++t) {
    chosen_[t] = model_.tasks[t].site == site && random_.chance(part) ? 1 : 0;
  }
}

/// The tasks that end last, most of them.
void Search::choose_late(int count) {
  sorted_.clear();
  for (Index t = 0; t < model_.task_count(); ++t) {
    sorted_.emplace_back(-end_s_[at(t)] * random_.uniform(0.6, 1.0), t);
  }
  std::sort(sorted_.begin(), sorted_.end());
  for (std::size_t k = 0; k < std::min(sorted_.size(), at(count)); ++k) {
    chosen_[at(sorted_[k].second)] = 1;
  }
}

/// Puts back one task after the other, each where it costs least.
void Search::recreate(Solution& plan, double limit) {
  sorted_.clear();
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
    if (sort == 3) key = -task.weight * (0.5 + key);
    sorted_.emplace_back(key, t);
  }
  std::sort(sorted_.begin(), sorted_.end());
  plan.missing.clear();
  plan.score = score_of(plan.orders);
  std::fill(dropped_.begin(), dropped_.end(), 0);
  for (const auto& [key, task] : sorted_) {
    const Index site = model_.tasks[at(task)].site;
    if (is_optional(task) && random_.chance(kLeaveOut)) dropped_[at(site)] = 1;
    if (dropped_[at(site)] != 0) continue;
    const Place place = best_place(plan, task);
    if (place.vehicle == kNone) {
      if (is_optional(task)) {
        dropped_[at(site)] = 1;
        continue;
      }
      plan.missing.push_back(task);
      if (limit < kMissing) break;
      continue;
    }
    auto& order = plan.orders[at(place.vehicle)];
    order.insert(order.begin() + static_cast<std::ptrdiff_t>(place.position), place.visit);
    plan.score = place.score;
    if (plan.score >= limit) break;  // it only grows
  }
  if (model_.any_optional && plan.score < limit) leave_out_dropped(plan);
  plan.score =
      plan.score >= limit ? kInfinity : plan.score + kMissing * static_cast<double>(must(plan));
}

/// What could not be put back is left out with all of its site.
void Search::leave_out_dropped(Solution& plan) {
  bool any = false;
  for (auto& order : plan.orders) {
    any = std::erase_if(order,
                        [this](Index v) {
                          return dropped_[at(model_.tasks[at(model_.task_of[at(v)])].site)] != 0;
                        }) > 0 ||
          any;
  }
  if (any) plan.score = score_of(plan.orders);
  plan.score += left_out_cost(model_, plan.orders);
  plan.missing = missing_of(plan.orders);
}

bool Search::may_take(const Solution& plan, Index vehicle, const Task& task) const {
  const auto& order = plan.orders[at(vehicle)];
  if (has_its_share(model_, order, task)) return false;
  if (task.id.kind != TaskKind::deliver) return true;
  const auto used = std::count_if(order.begin(), order.end(), [&](Index v) {
    return model_.tasks[at(model_.task_of[at(v)])].id.kind == TaskKind::deliver;
  });
  return used < model_.vehicles[at(vehicle)].loads;
}

/// What a vehicle has more to fly with a visit between two others; kNone: the start, or no more.
double Search::detour_s(Index vehicle, Index before, Index visit, Index next) const {
  const double* const from_s = model_.reach_from(vehicle, before);
  const double there_s = from_s[visit] + model_.class_of(vehicle).after_s[at(visit)];
  if (next == kNone) return there_s;
  return there_s + model_.reach_from(vehicle, visit)[next] - from_s[next];
}

/// The place where the longest path through the task is shortest, of those that can be flown; where
/// that is of little difference, the one that keeps its vehicle the least busy.
/// Precondition: `timing_` is that of the plan.
Search::Place Search::best_place_by_paths(Solution& plan, Index task) {
  const Task& its = model_.tasks[at(task)];
  const double cost = timed_cost_;
  paths_.find(timing_);
  const Paths::Newcomer newcomer = paths_.newcomer(its);
  places_.clear();
  for (Index i = 0; i < model_.vehicle_count(); ++i) {
    if (!may_take(plan, i, its)) continue;
    const auto& order = plan.orders[at(i)];
    for (Index v = its.first_visit; v < its.first_visit + its.visits; ++v) {
      for (std::size_t p = 0; p <= order.size(); ++p) {
        if (random_.chance(kBlink)) continue;
        const double path_s = paths_.through_s(newcomer, order, timing_, i, p, v);
        if (path_s == kInfinity) continue;
        const double score = std::max(cost, path_s) + kPath * path_s +
                             kDetour * detour_s(i, p == 0 ? kNone : order[p - 1], v,
                                                p < order.size() ? order[p] : kNone);
        places_.push_back({i, p, v, score});
      }
    }
  }
  while (!places_.empty()) {
    const auto least =
        std::min_element(places_.begin(), places_.end(),
                         [](const Place& a, const Place& b) { return a.score < b.score; });
    Place place = *least;
    auto& order = plan.orders[at(place.vehicle)];
    const auto position = static_cast<std::ptrdiff_t>(place.position);
    order.insert(order.begin() + position, place.visit);
    place.score = score_of(plan.orders);
    order.erase(order.begin() + position);
    if (place.score < kInfinity) return place;
    *least = places_.back();
    places_.pop_back();
  }
  plan.score = score_of(plan.orders);
  return {};
}

/// Places in the order of what they cost at least, until no better one can follow.
Search::Place Search::best_place(Solution& plan, Index task) {
  if (model_.criterion == Criterion::makespan) return best_place_by_paths(plan, task);
  const Task& its = model_.tasks[at(task)];
  Place best;
  timing_.evaluate(plan.orders);
  end_s_ = timing_.ends_s();
  places_.clear();
  for (Index i = 0; i < model_.vehicle_count(); ++i) {
    const auto& order = plan.orders[at(i)];
    if (!may_take(plan, i, its)) continue;
    for (std::size_t p = 0; p <= order.size(); ++p) {
      for (Index v = its.first_visit; v < its.first_visit + its.visits; ++v) {
        const double least = least_score_at(plan, i, p, v);
        if (least < kInfinity) places_.push_back({i, p, v, least});
      }
    }
  }
  std::sort(places_.begin(), places_.end(),
            [](const Place& a, const Place& b) { return a.score < b.score; });
  for (const Place& place : places_) {
    if (place.score >= best.score) break;
    if (random_.chance(kBlink)) continue;
    auto& order = plan.orders[at(place.vehicle)];
    const auto position = static_cast<std::ptrdiff_t>(place.position);
    order.insert(order.begin() + position, place.visit);
    const double score = score_of(plan.orders, best.score);
    order.erase(order.begin() + position);
    if (score < best.score) best = {place.vehicle, place.position, place.visit, score};
  }
  return best;
}

/// What is in the plan keeps its times or is later (but where a gap opens or closes, which is
/// rare): so what the task and those after it on the same vehicle cost, as if they waited for
/// nobody else.
double Search::least_score_at(const Solution& plan, Index vehicle, std::size_t position,
                              Index visit) const {
  const Vehicle& its = model_.vehicles[at(vehicle)];
  const std::vector<double>& after_s = model_.class_of(vehicle).after_s;
  const auto& order = plan.orders[at(vehicle)];
  const Index before = position == 0 ? kNone : order[position - 1];
  const double free_s = position == 0 ? 0.0 : end_s_[at(model_.task_of[at(before)])];
  double end_s = free_s + model_.reach_from(vehicle, before)[visit] + after_s[at(visit)];
  if (!(end_s <= its.latest_s[at(visit)])) return kInfinity;
  double score = model_.add(plan.score, model_.least_cost_of(model_.task_of[at(visit)], end_s));
  Index last = visit;
  double last_end_s = free_s;
  for (std::size_t p = position; p < order.size(); ++p) {
    const Index next = model_.task_of[at(order[p])];
    last_end_s = end_s_[at(next)];
    end_s += model_.reach_from(vehicle, last)[order[p]] + after_s[at(order[p])];
    if (end_s <= last_end_s) return score;
    if (!(end_s <= its.latest_s[at(order[p])])) return kInfinity;
    score += model_.least_cost_of(next, end_s) - model_.least_cost_of(next, last_end_s);
    last = order[p];
  }
  return score + its.search_weight_per_s * (end_s - last_end_s);
}

namespace {

/// Makespans: searches and, in between, enumerates routes. True when the best is proven.
bool search_and_cover(const Model& model, Search& search, const PlanningBudget& budget) {
  Routes routes{model};
  for (std::uint64_t due = kStepsBeforeRoutes; !budget.is_spent(search.steps());) {
    search.step();
    if (search.steps() < due || search.best_cost() == kInfinity) continue;
    due = 2 * search.steps();
    Orders orders = search.best();
    double cost = search.best_cost();
    const Routes::Effort effort{kRoutesPerStep * search.steps(),
                                std::max(kNodesLeast, kNodesPerStep * search.steps())};
    const auto outcome = routes.improve(orders, cost, effort, budget);
    if (cost < search.best_cost()) search.take(orders);
    if (outcome == Routes::Outcome::done) return true;
  }
  return false;
}

}  // namespace
}  // namespace skein::planning::coupled

namespace skein::planning {

Result<CoupledPlan> ruin_and_recreate(const CoupledProblem& problem, Random& random,
                                      const PlanningBudget& budget) {
  const auto model = coupled::Model::make(problem);
  if (!model) return model.error();
  coupled::Search search{*model, random};
  bool proven = false;
  if (coupled::can_cover(*model)) {
    proven = coupled::search_and_cover(*model, search, budget);
  } else {
    while (!budget.is_spent(search.steps())) search.step();
  }
  if (search.best_cost() == coupled::kInfinity) {
    return coupled::no_plan(*model, coupled::Sought::within_the_budget);
  }
  auto plan = coupled::make_plan(*model, problem, search.best());
  if (!plan) return plan;
  plan->steps = search.steps();
  if (proven) coupled::mark(*model, search.best_cost(), true, *plan);
  return plan;
}

}  // namespace skein::planning
