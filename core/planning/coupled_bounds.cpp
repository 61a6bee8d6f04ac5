// SPDX-License-Identifier: Apache-2.0
#include "coupled_bounds.hpp"

#include <algorithm>
#include <bit>
#include <numeric>

#include "skein/planning/assignment.hpp"

namespace skein::planning::coupled {

Bounds::Bounds(const Model& model)
    : model_{model},
      tail_s_(model.tasks.size(), 0.0),
      range_cost_(model.tasks.size(), 0.0),
      least_into_s_(model.classes.size() * model.tasks.size(), kInfinity),
      head_s_(model.tasks.size(), 0.0),
      survey_end_s_(model.vehicles.size()),
      delivery_s_(model.vehicles.size()),
      penalty_(static_cast<Eigen::Index>(model.tasks.size()), kPlacesMax) {
  make_tails();
  make_least_range_costs();
}

void Bounds::make_tails() {
  const auto least_after_s = [&](Index t) {
    double least_s = kInfinity;
    for (const VehicleClass& kind : model_.classes) {
      least_s = std::min(least_s, kind.least_after_s[at(t)]);
    }
    return least_s;
  };
  for (const SiteTasks& site : model_.sites) {
    double assess_s = 0.0;
    for (const Index t : site.assessments) assess_s = std::max(assess_s, least_after_s(t));
    double deliver_s = 0.0;
    for (const Index t : site.deliveries) {
      tail_s_[at(t)] = site.assessments.empty() ? 0.0 : site.assess_wait_s + assess_s;
      deliver_s = std::max(deliver_s, model_.tasks[at(t)].offset_s + tail_s_[at(t)]);
    }
    if (site.survey == kNone) continue;
    tail_s_[at(site.survey)] =
        site.deliveries.empty() ? assess_s : model_.decide_wait_s + deliver_s;
  }
}

void Bounds::make_least_range_costs() {
  const std::size_t tasks = model_.tasks.size();
  for (std::size_t t = 0; t < tasks; ++t) {
    for (std::size_t k = 0; k < model_.classes.size(); ++k) {
      for (std::size_t a = 0; a < tasks; ++a) {
        double& into = least_into_s_[k * tasks + t];
        into = std::min(into, model_.classes[k].least_between_s[a * tasks + t]);
      }
    }
    double least = kInfinity;
    for (const Vehicle& v : model_.vehicles) {
      const double into_s = std::min(v.least_s[t], least_into_s_[at(v.kind) * tasks + t]);
      const double seconds = into_s + model_.classes[at(v.kind)].least_after_s[t];
      if (seconds < kInfinity) least = std::min(least, v.range_weight_per_s * seconds);
    }
    range_cost_[t] = least < kInfinity ? least : 0.0;
  }
}

void Bounds::TwoLeast::take(double value, Index index) {
  if (value < least) {
    second = least;
    least = value;
    who = index;
  } else {
    second = std::min(second, value);
  }
}

double Bounds::arrival_s(const PartialPlan& plan, Index vehicle, Index task) const {
  const auto& state = plan.vehicles()[at(vehicle)];
  return std::max(state.free_s + model_.least_from(vehicle, state.last)[task], plan.floor_s());
}

double Bounds::between_s(Index vehicle, Index from, Index to) const {
  return model_.class_of(vehicle).least_between_s[at(from) * model_.tasks.size() + at(to)];
}

double Bounds::chains(const PartialPlan& plan) {
  double cost = plan.cost();
  for (Index s = 0; s < static_cast<Index>(plan.sites().size()); ++s) {
    const PartialPlan::Site& site = plan.sites()[at(s)];
    if (!site.is_open() && plan.group_site() != s) continue;
    const SiteTasks& tasks = model_.sites[at(s)];
    double ready_s = site.ready_s;
    surveyed_ = {};
    delivered_ = {};
    one_delivery_open_ = false;
    if (site.survey_open) {
      cost = add_survey(plan, cost, s);
      ready_s = surveyed_.least + (tasks.deliveries.empty() ? 0.0 : model_.decide_wait_s);
    }
    if (site.deliveries_open > 0) {
      const double common_s = std::max(plan.group_site() == s ? plan.common_s() : 0.0, ready_s);
      cost = add_deliveries(plan, cost, s, common_s);
      double last_s = 0.0;
      for (const Index t : tasks.deliveries) last_s = std::max(last_s, head_s_[at(t)]);
      ready_s = last_s + tasks.assess_wait_s;
    }
    cost = add_assessments(plan, cost, s, ready_s);
    if (cost == kInfinity) break;
  }
  chains_cost_ = cost;
  return cost;
}

double Bounds::add_survey(const PartialPlan& plan, double cost, Index site) {
  const Index t = model_.sites[at(site)].survey;
  double least_s = kInfinity;
  for (Index i = 0; i < model_.vehicle_count(); ++i) {
    const double time_s = arrival_s(plan, i, t);
    double end_s = time_s + model_.class_of(i).least_after_s[at(t)];
    if (!in_time(i, end_s)) end_s = kInfinity;
    least_s = std::min(least_s, time_s);
    survey_end_s_[at(i)] = end_s;
    surveyed_.take(end_s, i);
  }
  head_s_[at(t)] = least_s;
  return model_.add(cost, model_.least_cost_of(t, surveyed_.least)) + range_cost_[at(t)];
}

/// The tasks of the group that are given away have no final time yet, so they are counted here too.
double Bounds::add_deliveries(const PartialPlan& plan, double cost, Index s, double common_s) {
  const SiteTasks& tasks = model_.sites[at(s)];
  const bool grouped = plan.group_site() == s;
  const bool survey_open = plan.sites()[at(s)].survey_open;
  const double ready_s = common_s;
  one_delivery_open_ = tasks.deliveries.size() == 1;
  for (std::size_t d = grouped ? plan.group_size() : 0; d < tasks.deliveries.size(); ++d) {
    const Index t = tasks.deliveries[d];
    delivered_ = {};
    for (Index i = 0; i < model_.vehicle_count(); ++i) {
      double time_s = kInfinity;
      if (plan.vehicles()[at(i)].loads > 0) {
        time_s = arrival_s(plan, i, t);
        if (survey_open) {
          const double others_s = surveyed_.without(i) + model_.decide_wait_s;
          const double own_s =
              survey_end_s_[at(i)] + std::max(model_.decide_wait_s, between_s(i, tasks.survey, t));
          time_s = std::min(std::max(time_s, others_s), own_s);
        } else {
          time_s = std::max(time_s, ready_s);
        }
        if (!in_time(i, time_s)) time_s = kInfinity;
      }
      delivery_s_[at(i)] = time_s;
      delivered_.take(time_s, i);
    }
    common_s = std::max(common_s, delivered_.least - model_.tasks[at(t)].offset_s);
  }
  for (const Index t : tasks.deliveries) {
    head_s_[at(t)] = common_s + model_.tasks[at(t)].offset_s;
    cost = model_.add(cost, model_.least_cost_of(t, head_s_[at(t)])) + range_cost_[at(t)];
  }
  return cost;
}

double Bounds::add_assessments(const PartialPlan& plan, double cost, Index s, double ready_s) {
  const SiteTasks& tasks = model_.sites[at(s)];
  for (Mask open = plan.sites()[at(s)].assessments_open; open != 0; open &= open - 1) {
    const Index t = std::countr_zero(open);
    double least_s = kInfinity;
    double least_end_s = kInfinity;
    for (Index i = 0; i < model_.vehicle_count(); ++i) {
      double time_s = arrival_s(plan, i, t);
      if (one_delivery_open_) {
        const double others_s = delivered_.without(i) + tasks.assess_wait_s;
        const double own_s =
            delivery_s_[at(i)] +
            std::max(tasks.assess_wait_s, between_s(i, tasks.deliveries.front(), t));
        time_s = std::min(std::max(time_s, others_s), own_s);
      } else {
        time_s = std::max(time_s, ready_s);
      }
      const double end_s = time_s + model_.class_of(i).least_after_s[at(t)];
      if (!in_time(i, end_s)) continue;
      least_s = std::min(least_s, time_s);
      least_end_s = std::min(least_end_s, end_s);
    }
    head_s_[at(t)] = least_s;
    cost = model_.add(cost, model_.least_cost_of(t, least_end_s)) + range_cost_[at(t)];
  }
  return cost;
}

bool Bounds::places_suffice(const PartialPlan& plan, double limit) {
  if (chains(plan) >= limit) return false;
  open_count_ = 0;
  double own_cost = 0.0;
  for (Index t = 0; t < model_.task_count(); ++t) {
    if ((plan.done() & bit(t)) != 0) continue;
    double after_s = kInfinity;
    for (const VehicleClass& kind : model_.classes) {
      after_s = std::min(after_s, kind.least_after_s[at(t)]);
    }
    const double cost = model_.least_cost_of(t, head_s_[at(t)] + after_s) + range_cost_[at(t)];
    own_cost = model_.add(own_cost, cost);
    open_[open_count_++] = {t, cost};
  }
  // What the chains know beyond the heads is not used: penalties are counted from the heads.
  const double room = limit - model_.add(plan.cost(), own_cost);
  make_places(plan, room, limit);
  if (too_many_) return true;
  if (!give_places()) return false;
  if (model_.criterion == Criterion::makespan) return true;
  if (places_ < static_cast<int>(open_count_)) return false;
  if (row_sum_ >= room) return false;
  const auto least =
      least_sum_assignment(penalty_.topLeftCorner(static_cast<Eigen::Index>(open_count_), places_));
  return least && least->cost < room;
}

/// What comes second or later comes from another open task.
void Bounds::make_legs_into_open() {
  if (model_.criterion != Criterion::value) return;
  const std::size_t tasks = model_.tasks.size();
  std::fill(least_into_s_.begin(), least_into_s_.end(), kInfinity);
  for (std::size_t k = 0; k < model_.classes.size(); ++k) {
    double* into_s = least_into_s_.data() + k * tasks;
    for (std::size_t row = 0; row < open_count_; ++row) {
      const double* leg_s = model_.classes[k].least_between_s.data() + at(open_[row].task) * tasks;
      for (std::size_t t = 0; t < tasks; ++t) into_s[t] = std::min(into_s[t], leg_s[t]);
    }
  }
}

/// One leg more: from the ends of open tasks to the times of all.
void Bounds::walk(const VehicleClass& kind, const std::array<double, kCoupledTasksMax>& end_s,
                  std::array<double, kCoupledTasksMax>& reach_s) const {
  const std::size_t tasks = model_.tasks.size();
  reach_s.fill(kInfinity);
  for (std::size_t row = 0; row < open_count_; ++row) {
    const double from_s = end_s[row];
    if (from_s == kInfinity) continue;
    const double* leg_s = kind.least_between_s.data() + at(open_[row].task) * tasks;
    for (std::size_t t = 0; t < tasks; ++t) reach_s[t] = std::min(reach_s[t], from_s + leg_s[t]);
  }
}

void Bounds::make_places(const PartialPlan& plan, double room, double limit) {
  const double most = model_.criterion == Criterion::makespan ? limit : room;
  make_legs_into_open();
  std::array<double, kCoupledTasksMax> end_s{};
  std::array<double, kCoupledTasksMax> next_s{};
  std::array<double, kCoupledTasksMax> reach_s{};
  std::array<double, kCoupledTasksMax> least_penalty{};
  least_penalty.fill(kInfinity);
  places_ = 0;
  too_many_ = false;
  for (std::size_t row = 0; row < open_count_; ++row) allowed_[row] = 0;
  for (Index i = 0; i < model_.vehicle_count(); ++i) {
    const VehicleClass& kind = model_.class_of(i);
    for (std::size_t position = 0; position < open_count_; ++position) {
      bool any = false;
      if (places_ == kPlacesMax) {
        too_many_ = true;
        return;
      }
      if (position == 0) {
        for (std::size_t row = 0; row < open_count_; ++row) {
          reach_s[at(open_[row].task)] = arrival_s(plan, i, open_[row].task);
        }
      } else {
        walk(kind, end_s, reach_s);
      }
      for (std::size_t row = 0; row < open_count_; ++row) {
        const Index t = open_[row].task;
        const double ends_s = std::max(reach_s[at(t)], head_s_[at(t)]) + kind.least_after_s[at(t)];
        const double more = penalty(plan, open_[row], i, ends_s, position);
        const bool possible = more < most;
        next_s[row] = possible ? ends_s : kInfinity;
        penalty_(static_cast<Eigen::Index>(row), places_) = possible ? more : kInfinity;
        if (possible) allowed_[row] |= bit(places_);
        any = any || possible;
        least_penalty[row] = std::min(least_penalty[row], more);
      }
      if (!any) break;
      ++places_;
      std::swap(end_s, next_s);
    }
  }
  row_sum_ = std::accumulate(least_penalty.begin(),
                             least_penalty.begin() + static_cast<std::ptrdiff_t>(open_count_), 0.0);
}

/// What the task costs at a place beyond what it costs by its chain; for a makespan the least end
/// of all.
double Bounds::penalty(const PartialPlan& plan, const Open& open, Index vehicle, double end_s,
                       std::size_t position) const {
  const Index t = open.task;
  if (!in_time(vehicle, end_s)) return kInfinity;
  if (model_.criterion == Criterion::makespan) return end_s + tail_s_[at(t)];
  double cost = model_.least_cost_of(t, end_s);
  const Vehicle& its = model_.vehicles[at(vehicle)];
  if (its.range_weight_per_s > 0.0) {
    const double after_s = model_.class_of(vehicle).least_after_s[at(t)];
    const double seconds =
        position == 0 ? end_s - plan.vehicles()[at(vehicle)].free_s
                      : least_into_s_[at(its.kind) * model_.tasks.size() + at(t)] + after_s;
    cost += its.range_weight_per_s * seconds;
  }
  return std::max(0.0, cost - open.cost);
}

/// Is there any way to give every open task a place? Kuhn's augmenting paths.
bool Bounds::give_places() {
  holder_.fill(kNone);
  for (std::size_t row = 0; row < open_count_; ++row) {
    Mask tried = 0;
    if (!match(row, tried)) return false;
  }
  return true;
}

bool Bounds::match(std::size_t row, Mask& tried) {
  while (const Mask left = allowed_[row] & ~tried) {
    const int place = std::countr_zero(left);
    tried |= bit(place);
    int& holder = holder_[at(place)];
    if (holder == kNone || match(at(holder), tried)) {
      holder = static_cast<int>(row);
      return true;
    }
  }
  return false;
}

}  // namespace skein::planning::coupled
