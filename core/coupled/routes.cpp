// SPDX-License-Identifier: Apache-2.0
#include "routes.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "bounds.hpp"
#include "partial.hpp"

namespace skein::planning::coupled {
namespace {

constexpr Index kTasksMax = 64;
constexpr std::uint64_t kRoutesMax = 50'000;  ///< more are not looked through in time
// Of the cost known. What is far better is found first, as so low a limit leaves few routes.
constexpr std::array kAims{0.97, 1.0};
constexpr int kFirstSteps = 20;               ///< of prices, before any route is chosen
constexpr int kSteps = 8;                     ///< and after one was
constexpr double kRounding = 1e-9;            ///< of sums of prices, amply
constexpr std::uint64_t kRoutesToClock = 64;  ///< made before the clock is asked again
constexpr std::uint64_t kNodesToClock = 8;
constexpr std::size_t kRoutesOfNode = 50;

}  // namespace

bool can_cover(const Model& model) {
  return model.criterion == Criterion::makespan && model.task_count() <= kTasksMax;
}

Routes::Routes(const Model& model)
    : model_{model},
      free_of_gaps_{model},
      timing_{model},
      bound_timing_{free_of_gaps_},
      paths_{free_of_gaps_},
      excluded_(model.tasks.size(), 0),
      offset_s_(model.sites.size(), 0.0),
      ready_(model.sites.size()),
      lists_(model.vehicles.size() + 1),
      choices_(model.vehicles.size() + 1),
      counts_(model.tasks.size(), 0),
      prices_(model.vehicles.size() + 1, std::vector<double>(model.tasks.size(), 1.0)),
      most_(model.vehicles.size(), 0.0),
      dearest_(model.vehicles.size(), 0),
      orders_(model.vehicles.size()) {
  free_of_gaps_.gaps = false;
  for (Index t = 0; t < model.task_count(); ++t) {
    const Task& task = model.tasks[at(t)];
    offset_s_[at(task.site)] = std::max(offset_s_[at(task.site)], task.offset_s);
    for (Index other = 0; other < model.task_count(); ++other) {
      const Task& its = model.tasks[at(other)];
      const bool together = task.id.kind == TaskKind::deliver && its.id.kind == TaskKind::deliver;
      if (its.site == task.site && (together || its.id.kind > task.id.kind)) {
        excluded_[at(t)] |= bit_of(other);
      }
    }
  }
  make_bounds();
  heads_s_.assign(model.vehicles.size() + 1, head_s_);
  tails_s_.assign(model.vehicles.size() + 1, tail_s_);
}

void Routes::make_bounds() {
  Bounds bounds{model_};
  const double least = bounds.chains(PartialPlan{model_});
  for (Index t = 0; t < model_.task_count(); ++t) {
    head_s_.push_back(least < kInfinity ? bounds.head_s(t) : 0.0);
    tail_s_.push_back(bounds.tail_s(t));
    bound_timing_.hold(t, head_s_.back());
    all_ |= bit_of(t);
  }
}

Routes::Outcome Routes::improve(Orders& orders, double& cost, const Effort& effort,
                                const PlanningBudget& budget) {
  best_ = orders;
  best_cost_ = cost;
  budget_ = &budget;
  Outcome outcome = Outcome::done;
  for (const double part : kAims) {
    outcome = search_below(part * cost - kCoupledTolerance * std::abs(cost), effort);
    if (outcome != Outcome::done || best_cost_ < cost) break;
  }
  orders = best_;
  cost = best_cost_;
  return outcome;
}

/// `best_` becomes the best of all plans below the limit, if it is done.
Routes::Outcome Routes::search_below(double limit, const Effort& effort) {
  limit_ = limit;
  nodes_ = next_clock_ = 0;
  nodes_max_ = effort.nodes;
  routes_max_ = std::min(effort.routes, kRoutesMax);
  stopped_ = false;
  if (!make_routes()) return Outcome::too_many;
  auto& list = lists_.front();
  list.resize(routes_.size());
  for (std::size_t r = 0; r < list.size(); ++r) list[r] = r;
  for (auto& order : orders_) order.clear();
  std::fill(prices_.front().begin(), prices_.front().end(), 1.0);
  cover(0, all_);
  return stopped_ ? Outcome::cut_off : Outcome::done;
}

bool Routes::make_routes() {
  routes_.clear();
  visits_.clear();
  for (Index i = 0; i < model_.vehicle_count(); ++i) {
    std::fill(ready_.begin(), ready_.end(), Ready{});
    route_.clear();
    if (!extend(i, 0, model_.vehicles[at(i)].loads, 0.0, 0.0)) return false;
  }
  // What ends early leaves room for the others.
  std::stable_sort(routes_.begin(), routes_.end(),
                   [](const Route& a, const Route& b) { return a.end_s < b.end_s; });
  return true;
}

/// False where there are too many.
bool Routes::extend(Index vehicle, Tasks tasks, int loads, double free_s, double end_s) {
  for (Index t = 0; t < model_.task_count(); ++t) {
    if ((tasks & (excluded_[at(t)] | bit_of(t))) != 0) continue;
    if (!add_task(vehicle, tasks, loads, free_s, end_s, t)) return false;
  }
  return true;
}

bool Routes::add_task(Index vehicle, Tasks tasks, int loads, double free_s, double end_s,
                      Index index) {
  const Task& task = model_.tasks[at(index)];
  const bool deliver = task.id.kind == TaskKind::deliver;
  if ((deliver && loads == 0) || has_its_share(model_, route_, task)) return true;
  const double* const reach_s = model_.reach_from(vehicle, route_.empty() ? kNone : route_.back());
  const auto& after_s = model_.class_of(vehicle).after_s;
  const auto& latest_s = model_.vehicles[at(vehicle)].latest_s;
  const double from_s = std::max(head_s_[at(index)], ready_s(task));
  for (Index v = task.first_visit; v < task.first_visit + task.visits; ++v) {
    const double time_s = std::max(free_s + reach_s[v], from_s);
    const double visit_end_s = time_s + after_s[at(v)];
    if (!(visit_end_s <= latest_s[at(v)])) continue;
    const double path_end_s = std::max(end_s, visit_end_s + tail_s_[at(index)]);
    if (path_end_s >= limit_) continue;
    if (routes_.size() == routes_max_) return false;
    if (routes_.size() % kRoutesToClock == 0 && budget_->expired && budget_->expired())
      return false;
    const Ready before = ready_[at(task.site)];
    set_ready(task, time_s, visit_end_s);
    route_.push_back(v);
    const Tasks its = tasks | bit_of(index);
    routes_.push_back({its, path_end_s, vehicle, visits_.size(), route_.size()});
    visits_.insert(visits_.end(), route_.begin(), route_.end());
    const bool in_number =
        extend(vehicle, its, deliver ? loads - 1 : loads, visit_end_s, path_end_s);
    route_.pop_back();
    ready_[at(task.site)] = before;
    if (!in_number) return false;
  }
  return true;
}

double Routes::ready_s(const Task& task) const {
  const Ready& ready = ready_[at(task.site)];
  if (task.id.kind == TaskKind::survey) return 0.0;
  return task.id.kind == TaskKind::deliver ? ready.deliver_s + task.offset_s : ready.assess_s;
}

void Routes::set_ready(const Task& task, double time_s, double end_s) {
  const SiteTasks& site = model_.sites[at(task.site)];
  Ready& ready = ready_[at(task.site)];
  if (task.id.kind == TaskKind::assess) return;
  if (task.id.kind == TaskKind::survey) {
    ready.deliver_s = end_s + model_.decide_wait_s;
    ready.assess_s = end_s;
    if (site.deliveries.empty()) return;
  } else {
    ready.deliver_s = time_s - task.offset_s;
  }
  ready.assess_s = ready.deliver_s + offset_s_[at(task.site)] + site.assess_wait_s;
}

/// The open task that the fewest routes do; kNone where there is one that none does.
Index Routes::hardest_task(const std::vector<std::size_t>& list, Tasks open) {
  std::fill(counts_.begin(), counts_.end(), 0);
  for (const std::size_t r : list) {
    for (Tasks rest = routes_[r].tasks; rest != 0; rest &= rest - 1) {
      ++counts_[static_cast<std::size_t>(std::countr_zero(rest))];
    }
  }
  Index hardest = kNone;
  for (Tasks rest = open; rest != 0; rest &= rest - 1) {
    const Index t = std::countr_zero(rest);
    if (hardest == kNone || counts_[at(t)] < counts_[at(hardest)]) hardest = t;
  }
  return counts_[at(hardest)] > 0 ? hardest : kNone;
}

/// What the dearest routes of all vehicles are worth beyond the open tasks; below 0 no plan is made
/// of these routes.
double Routes::weigh(std::size_t depth, Tasks open) {
  const auto& price = prices_[depth];
  std::fill(most_.begin(), most_.end(), 0.0);
  std::fill(dearest_.begin(), dearest_.end(), routes_.size());
  for (const std::size_t r : lists_[depth]) {
    Route& route = routes_[r];
    route.worth = 0.0;
    for (Tasks rest = route.tasks; rest != 0; rest &= rest - 1) {
      route.worth += price[static_cast<std::size_t>(std::countr_zero(rest))];
    }
    if (route.worth <= most_[at(route.vehicle)]) continue;
    most_[at(route.vehicle)] = route.worth;
    dearest_[at(route.vehicle)] = r;
  }
  double room = 0.0;
  for (const double most : most_) room += most;
  for (Tasks rest = open; rest != 0; rest &= rest - 1) {
    room -= price[static_cast<std::size_t>(std::countr_zero(rest))];
  }
  return room;
}

/// A plan with a route that is worth so much less than its vehicle's dearest leaves a task out.
void Routes::drop_cheap(std::size_t depth, double room) {
  std::erase_if(lists_[depth], [&](std::size_t r) {
    return routes_[r].worth < most_[at(routes_[r].vehicle)] - room;
  });
}

/// Dearer where the dearest routes leave a task out, cheaper where several do it. False where each
/// is done once.
bool Routes::move_prices(std::size_t depth, Tasks open, double room) {
  std::fill(counts_.begin(), counts_.end(), -1);
  for (const std::size_t r : dearest_) {
    if (r == routes_.size()) continue;
    for (Tasks rest = routes_[r].tasks; rest != 0; rest &= rest - 1) {
      ++counts_[static_cast<std::size_t>(std::countr_zero(rest))];
    }
  }
  int norm = 0;
  for (Tasks rest = open; rest != 0; rest &= rest - 1) {
    const int x = counts_[static_cast<std::size_t>(std::countr_zero(rest))];
    norm += x * x;
  }
  if (norm == 0) return false;
  const double step = room / norm;
  for (Tasks rest = open; rest != 0; rest &= rest - 1) {
    const auto t = static_cast<std::size_t>(std::countr_zero(rest));
    prices_[depth][t] -= step * counts_[t];
  }
  return true;
}

/// Prices at which the routes left are few (Lagrange's relaxation; Held and Karp 1971). False where
/// they show that no plan is made of them.
bool Routes::tighten(std::size_t depth, Tasks open, int steps) {
  for (int k = 0; k < steps; ++k) {
    const double room = weigh(depth, open) + kRounding;
    if (room < 0.0) return false;
    drop_cheap(depth, room);
    if (k + 1 < steps && !move_prices(depth, open, room)) break;
  }
  return true;
}

/// Could a plan with these routes, that do these tasks, end before the limit?
bool Routes::is_below_limit(Tasks tasks) {
  if (bound_timing_.evaluate(orders_, limit_) >= limit_) return false;
  for (Tasks rest = tasks; rest != 0; rest &= rest - 1) {
    const auto t = static_cast<std::size_t>(std::countr_zero(rest));
    if (bound_timing_.ends_s()[t] + tail_s_[t] >= limit_) return false;
  }
  return true;
}

void Routes::take_plan() {
  const double cost = timing_.evaluate(orders_);
  if (cost >= limit_) return;
  best_ = orders_;
  best_cost_ = cost;
  limit_ = cost - kCoupledTolerance * std::abs(cost);
}

/// When the open tasks can be done, as the tasks of the routes chosen go: of `bound_timing_`.
void Routes::find_windows(std::size_t depth, Tasks open) {
  paths_.find(bound_timing_);
  auto& head_s = heads_s_[depth];
  auto& tail_s = tails_s_[depth];
  const auto is_open = [&](Index t) { return t != kNone && (open & bit_of(t)) != 0; };
  const auto narrow = [&](Index t) {
    const Paths::Newcomer its = paths_.newcomer(model_.tasks[at(t)]);
    head_s[at(t)] = std::max(head_s_[at(t)], its.ready_s);
    tail_s[at(t)] = std::max({tail_s_[at(t)], its.tail_s, its.group_s});
  };
  for (const SiteTasks& site : model_.sites) {
    double delivered_s = 0.0;
    double deliver_tail_s = 0.0;
    for (const Index d : site.deliveries) {
      if (!is_open(d)) continue;
      narrow(d);
      delivered_s = std::max(delivered_s, head_s[at(d)] + site.assess_wait_s);
      deliver_tail_s = std::max(
          deliver_tail_s, model_.decide_wait_s + model_.tasks[at(d)].offset_s + tail_s[at(d)]);
    }
    for (const Index a : site.assessments) {
      if (!is_open(a)) continue;
      narrow(a);
      head_s[at(a)] = std::max(head_s[at(a)], delivered_s);
    }
    if (!is_open(site.survey)) continue;
    narrow(site.survey);
    tail_s[at(site.survey)] = std::max(tail_s[at(site.survey)], deliver_tail_s);
  }
}

bool Routes::is_in_time(const Route& route, std::size_t depth) const {
  const auto& head_s = heads_s_[depth];
  const auto& tail_s = tails_s_[depth];
  const auto& after_s = model_.class_of(route.vehicle).after_s;
  double free_s = 0.0;
  Index before = kNone;
  for (std::size_t k = route.first; k < route.first + route.count; ++k) {
    const Index v = visits_[k];
    const auto t = at(model_.task_of[at(v)]);
    free_s =
        std::max(free_s + model_.reach_from(route.vehicle, before)[v], head_s[t]) + after_s[at(v)];
    if (free_s + tail_s[t] >= limit_) return false;
    before = v;
  }
  return true;
}

/// Counts a node, as several where many routes are to be looked through.
bool Routes::goes_on(std::size_t list) {
  const bool is_due = nodes_ >= next_clock_;
  if (is_due) next_clock_ = nodes_ + kNodesToClock;
  if (nodes_ >= nodes_max_ || (is_due && budget_->expired && budget_->expired())) stopped_ = true;
  nodes_ += 1 + list / kRoutesOfNode;
  return !stopped_;
}

/// Adds a route for the task that has the fewest, each in turn.
void Routes::cover(std::size_t depth, Tasks open) {
  if (open == 0) return take_plan();
  const auto& list = lists_[depth];
  if (!tighten(depth, open, depth == 0 ? kFirstSteps : kSteps)) return;
  const Index task = hardest_task(list, open);
  if (task == kNone) return;
  const Tasks done = all_ & ~open;
  auto& choices = choices_[depth];
  choices.clear();
  for (const std::size_t r : list) {
    if ((routes_[r].tasks & bit_of(task)) == 0) continue;
    choices.emplace_back(most_[at(routes_[r].vehicle)] - routes_[r].worth, r);
  }
  // First those that the prices say least against.
  std::sort(choices.begin(), choices.end());
  for (const auto& [loss, r] : choices) {
    const Route& route = routes_[r];
    if (route.end_s >= limit_) continue;
    if (!goes_on(list.size())) return;
    auto& order = orders_[at(route.vehicle)];
    const auto first = visits_.begin() + static_cast<std::ptrdiff_t>(route.first);
    order.assign(first, first + static_cast<std::ptrdiff_t>(route.count));
    if (is_below_limit(done | route.tasks)) {
      find_windows(depth + 1, open & ~route.tasks);
      auto& next = lists_[depth + 1];
      next.clear();
      for (const std::size_t other : list) {
        const Route& its = routes_[other];
        if (its.vehicle != route.vehicle && (its.tasks & route.tasks) == 0 && its.end_s < limit_ &&
            is_in_time(its, depth + 1)) {
          next.push_back(other);
        }
      }
      prices_[depth + 1] = prices_[depth];
      cover(depth + 1, open & ~route.tasks);
    }
    order.clear();
  }
}

}  // namespace skein::planning::coupled
