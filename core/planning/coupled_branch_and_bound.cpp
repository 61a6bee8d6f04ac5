// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "coupled_model.hpp"
#include "skein/base/assert.hpp"

namespace skein::planning::coupled {
namespace {

constexpr std::uint64_t kSeed = 1;
constexpr std::uint64_t kSearchStepsPerTask = 10;

struct Child {
  Index vehicle = kNone;
  Index visit = kNone;
  double bound = 0.0;
};

/// A plan that is being built: its tasks so far, each with its final time but for the deliveries of
/// one site when some of them are still to be given away.
class Tree {
 public:
  Tree(const Model& model, const PlanningBudget& budget);

  void start_from(const Orders& orders, double cost) {
    best_ = orders;
    best_cost_ = cost;
  }
  void run();

  [[nodiscard]] double best_cost() const { return best_cost_; }
  [[nodiscard]] const Orders& best() const { return best_; }
  [[nodiscard]] double bound() const { return std::min(open_bound_, best_cost_); }
  [[nodiscard]] bool is_complete() const { return !stopped_; }
  [[nodiscard]] std::uint64_t nodes() const { return nodes_; }

 private:
  struct Site {
    bool survey_open = false;
    int deliveries_open = 0;
    Mask assessments_open = 0;
    double ready_s = 0.0;  ///< when what comes next may be done
  };
  /// A delivery given away.
  struct Member {
    Index vehicle;
    Index task;
    double free_s;  ///< when the vehicle was free before
  };
  struct Saved {
    double free_s;
    Index last;
    double cost;
    double floor_s;
    double common_s;
    double ready_s;
    Index group_site;
    std::size_t group_begin;
  };

  [[nodiscard]] const Task& task_of(Index visit) const {
    return model_.tasks[at(model_.task_of[at(visit)])];
  }
  [[nodiscard]] std::span<const Member> group() const {
    return std::span{members_}.subspan(group_begin_);
  }
  [[nodiscard]] double threshold() const {
    return best_cost_ - kCoupledTolerance * std::max(1.0, std::abs(best_cost_));
  }
  void explore(double bound);
  void make_children(std::vector<Child>& children);
  void try_task(std::vector<Child>& children, Index task);
  [[nodiscard]] Saved apply(const Child& child);
  void undo(const Child& child, const Saved& saved);
  void close_group();
  void set_common(double common_s);
  [[nodiscard]] double lower_bound();
  double site_bound(double cost, Index site);
  [[nodiscard]] double time_of(const Child& child) const;

  const Model& model_;
  const PlanningBudget& budget_;
  std::vector<double> free_s_;
  std::vector<Index> last_;
  std::vector<int> loads_;
  std::vector<Site> sites_;
  Orders orders_;
  double cost_ = 0.0;
  double floor_s_ = 0.0;  ///< no task to come is before it
  int left_ = 0;

  /// The site whose deliveries are being given away.
  Index group_site_ = kNone;
  double common_s_ = 0.0;
  std::vector<Member> members_;  ///< of all sites, in the order in which they were given away
  std::size_t group_begin_ = 0;  ///< the first of the site in hand

  std::vector<std::vector<Child>> children_;  ///< by depth
  std::vector<double> one_, two_;             ///< by vehicle, of site_bound
  Orders best_;
  double best_cost_ = kInfinity;
  double open_bound_ = kInfinity;  ///< of what was not explored
  std::uint64_t nodes_ = 0;
  bool stopped_ = false;
};

Tree::Tree(const Model& model, const PlanningBudget& budget)
    : model_{model},
      budget_{budget},
      free_s_(model.vehicles.size(), 0.0),
      last_(model.vehicles.size(), kNone),
      sites_(model.sites.size()),
      orders_(model.vehicles.size()),
      left_{model.task_count()},
      children_(model.tasks.size() + 1),
      one_(model.vehicles.size()),
      two_(model.vehicles.size()) {
  for (const Vehicle& v : model.vehicles) loads_.push_back(v.loads);
  for (std::size_t s = 0; s < sites_.size(); ++s) {
    sites_[s].survey_open = model.sites[s].survey != kNone;
    sites_[s].deliveries_open = static_cast<int>(model.sites[s].deliveries.size());
    for (const Index t : model.sites[s].assessments) sites_[s].assessments_open |= bit(t);
  }
}

void Tree::run() {
  const double bound = lower_bound();
  if (bound < threshold()) explore(bound);
}

void Tree::explore(double bound) {
  ++nodes_;
  if (stopped_ || budget_.is_spent(nodes_)) {
    stopped_ = true;
    open_bound_ = std::min(open_bound_, bound);
    return;
  }
  if (left_ == 0) {
    if (cost_ < best_cost_) {
      best_cost_ = cost_;
      best_ = orders_;
    }
    return;
  }
  std::vector<Child>& children = children_[at(left_)];
  children.clear();
  make_children(children);
  std::stable_sort(children.begin(), children.end(),
                   [](const Child& a, const Child& b) { return a.bound < b.bound; });
  for (const Child& child : children) {
    if (child.bound >= threshold()) break;
    if (stopped_) {
      open_bound_ = std::min(open_bound_, child.bound);
      return;
    }
    const Saved saved = apply(child);
    explore(std::max(bound, child.bound));
    undo(child, saved);
  }
}

double Tree::time_of(const Child& child) const {
  const Task& task = task_of(child.visit);
  const double arrival = free_s_[at(child.vehicle)] +
                         model_.reach_from(child.vehicle, last_[at(child.vehicle)])[child.visit];
  return task.id.kind == TaskKind::survey ? arrival
                                          : std::max(arrival, sites_[at(task.site)].ready_s);
}

void Tree::make_children(std::vector<Child>& children) {
  if (group_site_ != kNone) {
    try_task(children, model_.sites[at(group_site_)].deliveries[group().size()]);
    return;
  }
  for (std::size_t s = 0; s < sites_.size(); ++s) {
    if (sites_[s].survey_open) {
      try_task(children, model_.sites[s].survey);
    } else if (sites_[s].deliveries_open > 0) {
      try_task(children, model_.sites[s].deliveries.front());
    } else {
      for (Mask open = sites_[s].assessments_open; open != 0; open &= open - 1) {
        try_task(children, std::countr_zero(open));
      }
    }
  }
}

void Tree::try_task(std::vector<Child>& children, Index task) {
  const Task& its = model_.tasks[at(task)];
  const bool deliver = its.id.kind == TaskKind::deliver;
  for (Index i = 0; i < model_.vehicle_count(); ++i) {
    const Vehicle& vehicle = model_.vehicles[at(i)];
    if (deliver && loads_[at(i)] == 0) continue;
    // Of twins that have done nothing, the first is as good as any.
    if (last_[at(i)] == kNone && vehicle.twin != kNone && last_[at(vehicle.twin)] == kNone)
      continue;
    if (deliver && std::any_of(members_.begin() + static_cast<std::ptrdiff_t>(group_begin_),
                               members_.end(), [&](const Member& m) { return m.vehicle == i; })) {
      continue;
    }
    for (Index v = its.first_visit; v < its.first_visit + its.visits; ++v) {
      Child child{i, v, 0.0};
      const double time_s = time_of(child);
      if (!(time_s + model_.class_of(i).after_s[at(v)] <= vehicle.deadline_s)) continue;
      const bool single = !deliver || model_.sites[at(its.site)].deliveries.size() == 1;
      if (single && time_s < floor_s_) continue;
      const Saved saved = apply(child);
      child.bound = left_ == 0 ? cost_ : lower_bound();
      undo(child, saved);
      if (child.bound < threshold()) children.push_back(child);
    }
  }
}

void Tree::set_common(double common_s) {
  common_s_ = common_s;
  for (const Member& m : group()) {
    free_s_[at(m.vehicle)] = common_s + model_.tasks[at(m.task)].offset_s;
  }
}

Tree::Saved Tree::apply(const Child& child) {
  const Index task_index = model_.task_of[at(child.visit)];
  const Task& task = model_.tasks[at(task_index)];
  Site& site = sites_[at(task.site)];
  const auto i = at(child.vehicle);
  const Vehicle& vehicle = model_.vehicles[i];
  const Saved saved{free_s_[i], last_[i],     cost_,       floor_s_,
                    common_s_,  site.ready_s, group_site_, group_begin_};
  const double time_s = time_of(child);
  orders_[i].push_back(child.visit);
  last_[i] = child.visit;
  --left_;
  if (task.id.kind == TaskKind::deliver) {
    --loads_[i];
    --site.deliveries_open;
    if (group_site_ == kNone) common_s_ = 0.0;
    group_site_ = task.site;
    members_.push_back({child.vehicle, task_index, saved.free_s});
    set_common(std::max(common_s_, time_s - task.offset_s));
    if (site.deliveries_open == 0) close_group();
    return saved;
  }
  const double end_s = time_s + model_.class_of(child.vehicle).after_s[at(child.visit)];
  cost_ = model_.add(cost_, model_.cost_of(task_index, end_s)) +
          vehicle.range_weight_per_s * (end_s - free_s_[i]);
  free_s_[i] = end_s;
  if (!model_.offsets) floor_s_ = time_s;
  if (task.id.kind == TaskKind::survey) {
    site.survey_open = false;
    site.ready_s = site.deliveries_open > 0 ? end_s + model_.decide_wait_s : end_s;
  } else {
    site.assessments_open &= ~bit(task_index);
  }
  return saved;
}

/// All deliveries are given away: their times are final.
void Tree::close_group() {
  double last_s = 0.0;
  for (const Member& m : group()) {
    const double end_s = free_s_[at(m.vehicle)];
    const Vehicle& vehicle = model_.vehicles[at(m.vehicle)];
    last_s = std::max(last_s, end_s);
    cost_ = end_s <= vehicle.deadline_s ? model_.add(cost_, model_.cost_of(m.task, end_s)) +
                                              vehicle.range_weight_per_s * (end_s - m.free_s)
                                        : kInfinity;
  }
  if (!model_.offsets) {
    if (common_s_ < floor_s_) cost_ = kInfinity;  // another order of building has this plan
    floor_s_ = common_s_;
  }
  sites_[at(group_site_)].ready_s = last_s + model_.sites[at(group_site_)].assess_wait_s;
  group_site_ = kNone;
  group_begin_ = members_.size();
}

void Tree::undo(const Child& child, const Saved& saved) {
  const Index task_index = model_.task_of[at(child.visit)];
  const Task& task = model_.tasks[at(task_index)];
  Site& site = sites_[at(task.site)];
  const auto i = at(child.vehicle);
  ++left_;
  orders_[i].pop_back();
  last_[i] = saved.last;
  cost_ = saved.cost;
  floor_s_ = saved.floor_s;
  site.ready_s = saved.ready_s;
  if (task.id.kind == TaskKind::deliver) {
    ++loads_[i];
    ++site.deliveries_open;
    members_.pop_back();
    group_site_ = saved.group_site;
    group_begin_ = saved.group_begin;
    set_common(saved.common_s);
  } else if (task.id.kind == TaskKind::survey) {
    site.survey_open = true;
  } else {
    site.assessments_open |= bit(task_index);
  }
  free_s_[i] = saved.free_s;
}

/// Every site alone with all vehicles, as if no other site needed them.
double Tree::lower_bound() {
  double cost = cost_;
  for (Index s = 0; s < static_cast<Index>(sites_.size()) && cost < kInfinity; ++s) {
    cost = site_bound(cost, s);
  }
  return cost;
}

/// The two least of a list, to know the least without one of them.
struct TwoLeast {
  double least = kInfinity;
  double second = kInfinity;
  Index who = kNone;
  void take(double value, Index index) {
    if (value < least) {
      second = least;
      least = value;
      who = index;
    } else {
      second = std::min(second, value);
    }
  }
  [[nodiscard]] double without(Index index) const { return index == who ? second : least; }
};

double Tree::site_bound(double cost, Index s) {
  const Site& site = sites_[at(s)];
  const SiteTasks& tasks = model_.sites[at(s)];
  const Index vehicles = model_.vehicle_count();
  const bool grouped = group_site_ == s;
  if (!site.survey_open && site.deliveries_open == 0 && !grouped && site.assessments_open == 0) {
    return cost;
  }
  double ready_s = site.ready_s;
  TwoLeast surveyed;
  if (site.survey_open) {
    const Index t = tasks.survey;
    for (Index i = 0; i < vehicles; ++i) {
      const double arrival =
          std::max(free_s_[at(i)] + model_.least_from(i, last_[at(i)])[t], floor_s_);
      double end_s = arrival + model_.class_of(i).least_after_s[at(t)];
      if (end_s > model_.vehicles[at(i)].deadline_s) end_s = kInfinity;
      one_[at(i)] = end_s;
      surveyed.take(end_s, i);
    }
    cost = model_.add(cost, model_.cost_of(t, surveyed.least));
    ready_s = surveyed.least + (tasks.deliveries.empty() ? 0.0 : model_.decide_wait_s);
  }
  TwoLeast delivered;
  bool chain = false;
  if (site.deliveries_open > 0 || grouped) {
    const bool single = tasks.deliveries.size() == 1;
    double common_s = grouped ? std::max(common_s_, ready_s) : ready_s;
    const std::size_t given = grouped ? group().size() : 0;
    for (std::size_t d = given; d < tasks.deliveries.size(); ++d) {
      const Index t = tasks.deliveries[d];
      TwoLeast soonest;
      for (Index i = 0; i < vehicles; ++i) {
        double time_s = kInfinity;
        if (loads_[at(i)] > 0) {
          time_s = std::max(free_s_[at(i)] + model_.least_from(i, last_[at(i)])[t], floor_s_);
          if (site.survey_open) {
            const double others_s = surveyed.without(i) + model_.decide_wait_s;
            const double own_s =
                one_[at(i)] +
                std::max(model_.decide_wait_s,
                         model_.class_of(i)
                             .least_between_s[at(tasks.survey) * model_.tasks.size() + at(t)]);
            time_s = std::min(std::max(time_s, others_s), own_s);
          } else {
            time_s = std::max(time_s, ready_s);
          }
          if (time_s > model_.vehicles[at(i)].deadline_s) time_s = kInfinity;
        }
        if (single) two_[at(i)] = time_s;
        soonest.take(time_s, i);
      }
      common_s = std::max(common_s, soonest.least - model_.tasks[at(t)].offset_s);
      if (single) delivered = soonest;
    }
    chain = single && !grouped;
    double last_s = 0.0;
    for (const Index t : tasks.deliveries) {
      const double time_s = common_s + model_.tasks[at(t)].offset_s;
      last_s = std::max(last_s, time_s);
      cost = model_.add(cost, model_.cost_of(t, time_s));
    }
    ready_s = last_s + tasks.assess_wait_s;
  }
  for (Mask open = site.assessments_open; open != 0; open &= open - 1) {
    const Index t = std::countr_zero(open);
    double least_s = kInfinity;
    for (Index i = 0; i < vehicles; ++i) {
      double time_s = std::max(free_s_[at(i)] + model_.least_from(i, last_[at(i)])[t], floor_s_);
      if (chain) {
        const double others_s = delivered.without(i) + tasks.assess_wait_s;
        const double own_s =
            two_[at(i)] +
            std::max(
                tasks.assess_wait_s,
                model_.class_of(i)
                    .least_between_s[at(tasks.deliveries.front()) * model_.tasks.size() + at(t)]);
        time_s = std::min(std::max(time_s, others_s), own_s);
      } else {
        time_s = std::max(time_s, ready_s);
      }
      const double end_s = time_s + model_.class_of(i).least_after_s[at(t)];
      if (end_s <= model_.vehicles[at(i)].deadline_s) least_s = std::min(least_s, end_s);
    }
    cost = model_.add(cost, model_.cost_of(t, least_s));
  }
  return cost;
}

}  // namespace
}  // namespace skein::planning::coupled

namespace skein::planning {

Result<CoupledPlan> branch_and_bound(const CoupledProblem& problem, const PlanningBudget& budget) {
  using coupled::kInfinity;
  const auto model = coupled::Model::make(problem);
  if (!model) return model.error();
  Random random{coupled::kSeed};
  PlanningBudget first = budget;
  first.steps_max = std::min(first.steps_max, coupled::kSearchStepsPerTask * model->tasks.size());
  const auto incumbent = coupled::search(*model, random, first);
  coupled::Tree tree{*model, budget};
  if (incumbent.cost < kInfinity) tree.start_from(incumbent.orders, incumbent.cost);
  tree.run();
  if (tree.best_cost() == kInfinity) return coupled::no_plan(*model);
  CoupledPlan plan = coupled::make_plan(*model, problem, tree.best());
  plan.proven = tree.is_complete();
  plan.bound = plan.proven ? plan.objective : model->objective(tree.bound());
  plan.steps = tree.nodes();
  return plan;
}

}  // namespace skein::planning
