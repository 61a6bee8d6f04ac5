// SPDX-License-Identifier: Apache-2.0
#include "bounds.hpp"

#include <algorithm>
#include <numeric>

namespace skein::planning::coupled {

Bounds::Bounds(const Model& model)
    : model_{model},
      tail_s_(model.tasks.size(), 0.0),
      range_cost_(model.tasks.size(), 0.0),
      least_into_s_(model.classes.size() * model.tasks.size(), kInfinity),
      head_s_(model.tasks.size(), 0.0),
      survey_end_s_(model.vehicles.size()),
      delivery_s_(model.vehicles.size()),
      packed_(model.classes.size()),
      places_max_{std::clamp<std::size_t>(model.tasks.size(), 64, kPlacesMax)},
      penalty_(model.tasks.size() * places_max_, kInfinity) {
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
    // The reward of tasks is a sum, where one may be left out.
    cost = site.untouched ? cost + std::min(add_site(plan, 0.0, s), model_.sites[at(s)].reward_cost)
                          : add_site(plan, cost, s);
    if (cost == kInfinity) break;
  }
  chains_cost_ = cost;
  return cost;
}

double Bounds::add_site(const PartialPlan& plan, double cost, Index s) {
  const PartialPlan::Site& site = plan.sites()[at(s)];
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
  return add_assessments(plan, cost, s, ready_s);
}

double Bounds::add_survey(const PartialPlan& plan, double cost, Index site) {
  const Index t = model_.sites[at(site)].survey;
  double least_s = kInfinity;
  for (Index i = 0; i < model_.vehicle_count(); ++i) {
    const double time_s = arrival_s(plan, i, t);
    double end_s = time_s + model_.class_of(i).least_after_s[at(t)];
    if (!in_time(i, t, end_s)) end_s = kInfinity;
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
        if (!in_time(i, t, time_s)) time_s = kInfinity;
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
  for (const Index t : tasks.assessments) {
    if (plan.done().has(t)) continue;
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
      if (!in_time(i, t, end_s)) continue;
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
  find_open(plan);
  double own_cost = forgone_;
  for (std::size_t row = 0; row < open_count_; ++row) {
    own_cost = model_.add(own_cost, open_[row].cost);
  }
  // What the chains know beyond the heads is not used: penalties are counted from the heads.
  const double room = limit - model_.add(plan.cost(), own_cost);
  pack();
  make_places(plan, room, limit);
  if (too_many_) return true;
  if (!give_places()) return false;
  if (model_.criterion == Criterion::makespan) return true;
  return row_sum_ < room && least_sum_is_below(room);
}

void Bounds::find_open(const PartialPlan& plan) {
  open_count_ = 0;
  forgone_ = 0.0;
  double last_head_s = 0.0;
  for (Index t = 0; t < model_.task_count(); ++t) {
    if (plan.done().has(t)) continue;
    double after_s = kInfinity;
    for (const VehicleClass& kind : model_.classes) {
      after_s = std::min(after_s, kind.least_after_s[at(t)]);
    }
    double cost = model_.least_cost_of(t, head_s_[at(t)] + after_s) + range_cost_[at(t)];
    double left_out = kInfinity;
    if (plan.sites()[at(model_.tasks[at(t)].site)].untouched) {
      const double weight = model_.tasks[at(t)].weight;
      if (head_s_[at(t)] == kInfinity) {
        forgone_ += weight;
        continue;
      }
      cost = std::min(cost, weight);
      left_out = weight - cost;
    }
    open_[open_count_++] = {t, cost, 0.0, left_out};
    last_head_s = std::max(last_head_s, head_s_[at(t)]);
  }
  for (std::size_t row = 0; row < open_count_; ++row) {
    open_[row].least_slope_per_s = model_.least_slope_of(open_[row].task, last_head_s);
  }
}

void Bounds::pack() {
  const std::size_t tasks = model_.tasks.size();
  for (std::size_t k = 0; k < packed_.size(); ++k) {
    const VehicleClass& kind = model_.classes[k];
    Packed& can = packed_[k];
    can.count = 0;
    for (std::size_t row = 0; row < open_count_; ++row) {
      const std::size_t t = at(open_[row].task);
      if (kind.least_after_s[t] == kInfinity) continue;
      can.row[can.count] = row;
      can.head_s[can.count] = head_s_[t];
      can.after_s[can.count] = kind.least_after_s[t];
      can.slope_per_s[can.count] = open_[row].least_slope_per_s;
      ++can.count;
    }
    can.leg_s.resize(can.count * can.count);
    for (std::size_t a = 0; a < can.count; ++a) {
      const double* leg_s = kind.least_between_s.data() + at(open_[can.row[a]].task) * tasks;
      for (std::size_t b = 0; b < can.count; ++b) {
        can.leg_s[a * can.count + b] = a == b ? kInfinity : leg_s[at(open_[can.row[b]].task)];
      }
    }
  }
}

void Bounds::first_place(const PartialPlan& plan, const Packed& can, Index vehicle,
                         Place& place) const {
  const Vehicle& its = model_.vehicles[at(vehicle)];
  const double free_s = plan.vehicles()[at(vehicle)].free_s;
  for (std::size_t c = 0; c < can.count; ++c) {
    place.reach_s[c] = arrival_s(plan, vehicle, open_[can.row[c]].task);
    place.wait_cost[c] =
        its.range_weight_per_s * (std::max(place.reach_s[c], can.head_s[c]) - free_s);
  }
}

/// One leg more: from the ends of open tasks to the times of all. A wait before a task costs range,
/// or as long a delay of the task before it, whose cost is concave.
void Bounds::next_place(const Packed& can, double weight_per_s, Place& place) const {
  const std::size_t count = can.count;
  std::fill_n(place.reach_s.begin(), count, kInfinity);
  std::fill_n(place.wait_cost.begin(), count, kInfinity);
  for (std::size_t a = 0; a < count; ++a) {
    const double end_s = place.end_s[a];
    if (end_s == kInfinity) continue;
    const double* leg_s = can.leg_s.data() + a * count;
    const double slope_per_s = std::min(weight_per_s, can.slope_per_s[a]);
    for (std::size_t b = 0; b < count; ++b) {
      const double reach_s = end_s + leg_s[b];
      place.reach_s[b] = std::min(place.reach_s[b], reach_s);
      const double wait_s = std::max(0.0, can.head_s[b] - reach_s);
      place.wait_cost[b] =
          std::min(place.wait_cost[b], weight_per_s * leg_s[b] + slope_per_s * wait_s);
    }
  }
}

void Bounds::make_places(const PartialPlan& plan, double room, double limit) {
  const double most = model_.criterion == Criterion::makespan ? limit : room;
  PerTask least_penalty;
  for (std::size_t row = 0; row < open_count_; ++row) least_penalty[row] = open_[row].left_out;
  std::fill_n(allowed_.begin(), open_count_, Set128{});
  places_ = 0;
  too_many_ = false;
  Place place;
  for (Index i = 0; i < model_.vehicle_count(); ++i) {
    const Vehicle& its = model_.vehicles[at(i)];
    const Packed& can = packed_[at(its.kind)];
    const bool loaded = plan.vehicles()[at(i)].loads > 0;
    for (std::size_t position = 0; position < can.count; ++position) {
      if (places_ == places_max_) {
        too_many_ = true;
        return;
      }
      if (position == 0) {
        first_place(plan, can, i, place);
      } else {
        next_place(can, its.range_weight_per_s, place);
      }
      for (std::size_t row = 0; row < open_count_; ++row) {
        penalty_[row * places_max_ + places_] = kInfinity;
      }
      bool any = false;
      for (std::size_t c = 0; c < can.count; ++c) {
        const std::size_t row = can.row[c];
        const Open& open = open_[row];
        double end_s = std::max(place.reach_s[c], can.head_s[c]) + can.after_s[c];
        const bool able = loaded || model_.tasks[at(open.task)].id.kind != TaskKind::deliver;
        const double range_cost = place.wait_cost[c] + its.range_weight_per_s * can.after_s[c];
        const double more = able ? penalty(open, its, end_s, range_cost) : kInfinity;
        place.end_s[c] = kInfinity;
        if (!(more < most)) continue;
        place.end_s[c] = end_s;
        penalty_[row * places_max_ + places_] = more;
        allowed_[row].add(static_cast<int>(places_));
        any = true;
        least_penalty[row] = std::min(least_penalty[row], more);
      }
      if (!any) break;
      ++places_;
    }
  }
  row_sum_ = std::accumulate(least_penalty.begin(),
                             least_penalty.begin() + static_cast<std::ptrdiff_t>(open_count_), 0.0);
}

/// What the task costs at a place beyond what it costs by its chain; for a makespan the least end
/// of all.
double Bounds::penalty(const Open& open, const Vehicle& vehicle, double end_s,
                       double range_cost) const {
  if (!(end_s <= vehicle.latest_of_task_s[at(open.task)])) return kInfinity;
  if (model_.criterion == Criterion::makespan) return end_s + tail_s_[at(open.task)];
  return std::max(0.0, model_.least_cost_of(open.task, end_s) + range_cost - open.cost);
}

bool Bounds::least_sum_is_below(double room) {
  // Of what may be left out each row has a place of its own for that.
  std::size_t columns = places_;
  for (std::size_t row = 0; row < open_count_; ++row) {
    if (open_[row].left_out < kInfinity) ++columns;
  }
  cost_.clear();
  std::size_t out = places_;
  for (std::size_t row = 0; row < open_count_; ++row) {
    const auto first = penalty_.begin() + static_cast<std::ptrdiff_t>(row * places_max_);
    cost_.insert(cost_.end(), first, first + static_cast<std::ptrdiff_t>(places_));
    cost_.resize((row + 1) * columns, kInfinity);
    if (open_[row].left_out < kInfinity) cost_[row * columns + out++] = open_[row].left_out;
  }
  const auto place_of = std::span{place_of_}.first(open_count_);
  if (!solver_.least_sum(cost_, columns, place_of)) return false;
  double sum = 0.0;
  for (std::size_t row = 0; row < open_count_; ++row) {
    sum += cost_[row * columns + static_cast<std::size_t>(place_of[row])];
  }
  return sum < room;
}

/// Is there any way to give a place to every open task that cannot be left out?
/// Kuhn's augmenting paths.
bool Bounds::give_places() {
  holder_.fill(kNone);
  for (std::size_t row = 0; row < open_count_; ++row) {
    if (open_[row].left_out < kInfinity) continue;
    Set128 tried;
    if (!match(row, tried)) return false;
  }
  return true;
}

bool Bounds::match(std::size_t row, Set128& tried) {
  for (int place = allowed_[row].first_without(tried); place != Set128::kNone;
       place = allowed_[row].first_without(tried)) {
    tried.add(place);
    int& holder = holder_[at(place)];
    if (holder == kNone || match(at(holder), tried)) {
      holder = static_cast<int>(row);
      return true;
    }
  }
  return false;
}

}  // namespace skein::planning::coupled
