// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "bounds.hpp"
#include "model.hpp"
#include "partial.hpp"
#include "routes.hpp"
#include "search.hpp"

namespace skein::planning::coupled {
namespace {

constexpr std::uint64_t kSeed = 1;
// The search gives the first plan, and goes on in between while the tree grows.
constexpr std::uint64_t kFirstSearchStepsPerTask = 5;
constexpr std::uint64_t kFirstSearchNodes = 500;
constexpr std::uint64_t kNodesPerSearchStep = 12;
// And so do routes.
constexpr std::uint64_t kRoutesPerNode = 20;
constexpr std::uint64_t kCoverNodesLeast = 4000;  ///< and as many as the tree has

/// Depth first over partial plans, the most promising first.
class Tree {
 public:
  Tree(const Model& model, Search& search, const PlanningBudget& budget);

  /// From the plan of a search, which goes on in between.
  void run();

  [[nodiscard]] double best_cost() const { return best_cost_; }
  [[nodiscard]] const Orders& best() const { return best_; }
  [[nodiscard]] double bound() const {
    return is_covered_ ? best_cost_ : std::min(open_bound_, best_cost_);
  }
  [[nodiscard]] bool is_proven() const { return bound() >= threshold(); }
  [[nodiscard]] std::uint64_t nodes() const { return nodes_; }

 private:
  struct Child {
    PartialPlan::Step step;
    double bound = 0.0;
    double time_s = 0.0;
  };

  [[nodiscard]] double threshold() const {
    return best_cost_ == kInfinity ? kInfinity
                                   : best_cost_ - kCoupledTolerance * std::abs(best_cost_);
  }
  void search(std::uint64_t steps);
  void cover();
  void take(const Orders& orders, double cost);
  void explore(double bound);
  void make_children(std::vector<Child>& children);
  void try_task(std::vector<Child>& children, Index task);

  const Model& model_;
  const PlanningBudget& budget_;
  Search& search_;
  std::uint64_t next_search_ = kFirstSearchNodes;
  PartialPlan plan_;
  Bounds bounds_;
  std::vector<std::vector<Child>> children_;  ///< by tasks left
  Orders best_;
  double best_cost_ = kInfinity;
  double open_bound_ = kInfinity;  ///< of what was not explored
  std::uint64_t nodes_ = 0;
  bool stopped_ = false;
  std::optional<Routes> routes_;
  bool is_covered_ = false;  ///< routes prove the best
};

Tree::Tree(const Model& model, Search& search, const PlanningBudget& budget)
    : model_{model},
      budget_{budget},
      search_{search},
      plan_{model},
      bounds_{model},
      children_(model.tasks.size() + 1) {}

void Tree::run() {
  search(kFirstSearchStepsPerTask * model_.tasks.size());
  const double bound = bounds_.chains(plan_);
  if (bound < threshold()) explore(bound);
}

void Tree::search(std::uint64_t steps) {
  for (std::uint64_t k = 0; k < steps && !(budget_.expired && budget_.expired()); ++k) {
    search_.step();
  }
  if (search_.best_cost() < best_cost_) take(search_.best(), search_.best_cost());
}

/// Makespans: what is proven by routes needs no tree.
void Tree::cover() {
  if (!can_cover(model_) || best_cost_ == kInfinity) return;
  if (!routes_) routes_.emplace(model_);
  const double before = best_cost_;
  const Routes::Effort effort{kRoutesPerNode * nodes_, std::max(kCoverNodesLeast, nodes_)};
  const auto outcome = routes_->improve(best_, best_cost_, effort, budget_);
  if (best_cost_ < before) search_.take(best_);
  if (outcome == Routes::Outcome::done) is_covered_ = stopped_ = true;
}

void Tree::take(const Orders& orders, double cost) {
  best_ = orders;
  best_cost_ = cost;
}

void Tree::explore(double bound) {
  if (stopped_ || budget_.is_spent(nodes_)) {
    stopped_ = true;
    open_bound_ = std::min(open_bound_, bound);
    return;
  }
  if (++nodes_ == next_search_) {
    search(nodes_ / kNodesPerSearchStep);
    cover();
    next_search_ *= 2;
  }
  if (plan_.may_end()) {
    const double cost = plan_.cost() + plan_.left_out_cost();
    if (cost < best_cost_) take(plan_.orders(), cost);
    if (plan_.left() == 0) return;
  }
  const bool between_groups = plan_.group_site() == kNone;
  if (between_groups && best_cost_ < kInfinity && !bounds_.places_suffice(plan_, threshold())) {
    return;
  }
  std::vector<Child>& children = children_[at(plan_.left())];
  children.clear();
  make_children(children);
  std::stable_sort(children.begin(), children.end(), [](const Child& a, const Child& b) {
    return a.bound < b.bound || (a.bound == b.bound && a.time_s < b.time_s);
  });
  for (const Child& child : children) {
    if (child.bound >= threshold()) break;
    const PartialPlan::Before before = plan_.apply(child.step);
    explore(std::max(bound, child.bound));
    plan_.undo(child.step, before);
  }
}

void Tree::make_children(std::vector<Child>& children) {
  if (plan_.group_site() != kNone) {
    try_task(children, model_.sites[at(plan_.group_site())].deliveries[plan_.group_size()]);
    return;
  }
  for (std::size_t s = 0; s < model_.sites.size(); ++s) {
    const PartialPlan::Site& site = plan_.sites()[s];
    if (site.survey_open) {
      try_task(children, model_.sites[s].survey);
    } else if (site.deliveries_open > 0) {
      try_task(children, model_.sites[s].deliveries.front());
    } else {
      for (const Index t : model_.sites[s].assessments) {
        if (!plan_.done().has(t)) try_task(children, t);
      }
    }
  }
}

void Tree::try_task(std::vector<Child>& children, Index task) {
  const Task& its = model_.tasks[at(task)];
  for (Index i = 0; i < model_.vehicle_count(); ++i) {
    // Of twins that have done nothing, the first is as good as any.
    const Index twin = model_.vehicles[at(i)].twin;
    if (twin != kNone && plan_.vehicles()[at(i)].last == kNone &&
        plan_.vehicles()[at(twin)].last == kNone) {
      continue;
    }
    for (Index v = its.first_visit; v < its.first_visit + its.visits; ++v) {
      Child child{{i, v}, 0.0, 0.0};
      if (!plan_.allows(child.step)) continue;
      child.time_s = plan_.time_of(child.step);
      const PartialPlan::Before before = plan_.apply(child.step);
      child.bound = bounds_.chains(plan_);
      plan_.undo(child.step, before);
      if (child.bound < threshold()) children.push_back(child);
    }
  }
}

}  // namespace

/// A wait that had to be lengthened may cost more than the bound, which knows of none.
void mark(const Model& model, double bound_cost, bool proven, CoupledPlan& plan) {
  plan.bound = model.objective(bound_cost);
  plan.proven = proven && plan.gap() <= kCoupledTolerance;
  if (plan.proven) plan.bound = plan.objective;
}

}  // namespace skein::planning::coupled

namespace skein::planning {

Result<CoupledPlan> branch_and_bound(const CoupledProblem& problem, const PlanningBudget& budget) {
  const auto model = coupled::Model::make(problem);
  if (!model) return model.error();
  Random random{coupled::kSeed};
  coupled::Search search{*model, random};
  coupled::Tree tree{*model, search, budget};
  tree.run();
  if (tree.best_cost() == coupled::kInfinity) {
    return coupled::no_plan(*model, tree.is_proven() ? coupled::Sought::everywhere
                                                     : coupled::Sought::within_the_budget);
  }
  auto plan = coupled::make_plan(*model, problem, tree.best());
  if (!plan) return plan;
  coupled::mark(*model, tree.is_proven() ? tree.best_cost() : tree.bound(), tree.is_proven(),
                *plan);
  plan->steps = tree.nodes();
  return plan;
}

}  // namespace skein::planning
