// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>
#include <vector>

#include "model.hpp"

namespace skein::planning::coupled {
namespace {

struct Bid {
  Index vehicle = kNone;
  Index visit = kNone;
  double time_s = kInfinity;
  double end_s = kInfinity;
};

/// One call for bids after the other.
class Tender {
 public:
  explicit Tender(const Model& model)
      : model_{model},
        orders_(model.vehicles.size()),
        free_s_(model.vehicles.size(), 0.0),
        deliveries_(model.vehicles.size(), 0),
        awarded_(model.tasks.size(), false),
        ready_s_(model.sites.size(), 0.0) {}

  [[nodiscard]] std::optional<Orders> run() {
    for (std::size_t left = model_.tasks.size(); left > 0;) {
      const Bid best = best_of_open();
      if (best.vehicle == kNone) {
        if (!may_end()) return std::nullopt;
        break;
      }
      const Task& task = model_.tasks[at(model_.task_of[at(best.visit)])];
      if (task.id.kind == TaskKind::deliver) {
        if (!award_deliveries(task.site)) return std::nullopt;
        left -= model_.sites[at(task.site)].deliveries.size();
      } else {
        award(best);
        --left;
        double& ready_s = ready_s_[at(task.site)];
        if (task.id.kind == TaskKind::survey) ready_s = best.end_s;
      }
    }
    // The times of the bids are those of a vehicle alone: together they may be a little later.
    if (Timing{model_}.evaluate(orders_) == kInfinity) return std::nullopt;
    return orders_;
  }

 private:
  [[nodiscard]] bool is_awarded(const std::vector<Index>& tasks) const {
    return std::all_of(tasks.begin(), tasks.end(), [&](Index t) { return awarded_[at(t)]; });
  }

  /// Is all that is left of optional sites of which nothing was awarded?
  [[nodiscard]] bool may_end() const {
    const std::vector<bool> left_out = left_out_of(model_, orders_);
    for (std::size_t t = 0; t < awarded_.size(); ++t) {
      if (!awarded_[t] && !left_out[at(model_.tasks[t].site)]) return false;
    }
    return true;
  }

  [[nodiscard]] Bid best_of_open() const {
    Bid best;
    for (const SiteTasks& site : model_.sites) {
      const bool surveyed = site.survey == kNone || awarded_[at(site.survey)];
      if (!surveyed) {
        consider(best, site.survey, 0.0, 0);
      } else if (!is_awarded(site.deliveries)) {
        const Index first = site.deliveries.front();
        consider(best, first, delivery_from_s(first), 0);
      } else {
        for (const Index t : site.assessments) {
          if (!awarded_[at(t)]) consider(best, t, ready_s_[at(model_.tasks[at(t)].site)], 0);
        }
      }
    }
    return best;
  }

  /// No delivery of the task's site before it, as the survey goes.
  [[nodiscard]] double delivery_from_s(Index task) const {
    const Index site = model_.tasks[at(task)].site;
    return model_.sites[at(site)].survey == kNone ? 0.0 : ready_s_[at(site)] + model_.decide_wait_s;
  }

  /// The earliest end wins, then the vehicle that comes first.
  void consider(Bid& best, Index task, double from_s, Mask excluded) const {
    const Task& its = model_.tasks[at(task)];
    for (Index i = 0; i < model_.vehicle_count(); ++i) {
      const Vehicle& vehicle = model_.vehicles[at(i)];
      if ((excluded & bit(i)) != 0) continue;
      if (its.id.kind == TaskKind::deliver && deliveries_[at(i)] >= vehicle.loads) continue;
      if (has_its_share(model_, orders_[at(i)], its)) continue;
      const double* reach_s = model_.reach_from(i, last_of(i));
      for (Index v = its.first_visit; v < its.first_visit + its.visits; ++v) {
        const double time_s = model_.flyable_s(i, last_of(i), v, free_s_[at(i)],
                                               std::max(free_s_[at(i)] + reach_s[v], from_s));
        const double end_s = time_s + model_.class_of(i).after_s[at(v)];
        if (end_s < best.end_s && end_s <= vehicle.latest_s[at(v)]) best = {i, v, time_s, end_s};
      }
    }
  }

  [[nodiscard]] Index last_of(Index vehicle) const {
    const auto& order = orders_[at(vehicle)];
    return order.empty() ? kNone : order.back();
  }

  void award(const Bid& bid) {
    const Index task = model_.task_of[at(bid.visit)];
    awarded_[at(task)] = true;
    orders_[at(bid.vehicle)].push_back(bid.visit);
    free_s_[at(bid.vehicle)] = bid.end_s;
    if (model_.tasks[at(task)].id.kind == TaskKind::deliver) ++deliveries_[at(bid.vehicle)];
  }

  bool award_deliveries(Index site) {
    const SiteTasks& tasks = model_.sites[at(site)];
    double common_s = delivery_from_s(tasks.deliveries.front());
    std::vector<Bid> members;
    Mask taken = 0;
    for (const Index t : tasks.deliveries) {
      const double offset_s = model_.tasks[at(t)].offset_s;
      Bid best;
      consider(best, t, common_s + offset_s, taken);
      if (best.vehicle == kNone) return false;
      common_s = std::max(common_s, best.time_s - offset_s);
      taken |= bit(best.vehicle);
      members.push_back(best);
    }
    double last_s = 0.0;
    for (Bid& member : members) {
      const Task& task = model_.tasks[at(model_.task_of[at(member.visit)])];
      member.end_s = common_s + task.offset_s;
      if (member.end_s > model_.vehicles[at(member.vehicle)].latest_s[at(member.visit)])
        return false;
      last_s = std::max(last_s, member.end_s);
      award(member);
    }
    ready_s_[at(site)] = last_s + tasks.assess_wait_s;
    return true;
  }

  const Model& model_;
  Orders orders_;
  std::vector<double> free_s_;  ///< by vehicle
  std::vector<int> deliveries_;
  std::vector<bool> awarded_;    ///< by task
  std::vector<double> ready_s_;  ///< by site: when the next kind of task may be done
};

}  // namespace

std::optional<Orders> greedy_orders(const Model& model) { return Tender{model}.run(); }

}  // namespace skein::planning::coupled

namespace skein::planning {

Result<CoupledPlan> greedy_awards(const CoupledProblem& problem) {
  const auto model = coupled::Model::make(problem);
  if (!model) return model.error();
  const auto orders = coupled::greedy_orders(*model);
  if (!orders) return coupled::no_plan(*model, coupled::Sought::in_one_way);
  return coupled::make_plan(*model, problem, *orders);
}

}  // namespace skein::planning
