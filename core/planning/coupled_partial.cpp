// SPDX-License-Identifier: Apache-2.0
#include "coupled_partial.hpp"

#include <algorithm>

namespace skein::planning::coupled {

PartialPlan::PartialPlan(const Model& model)
    : model_{model},
      sites_(model.sites.size()),
      vehicles_(model.vehicles.size()),
      orders_(model.vehicles.size()),
      left_{model.task_count()} {
  for (std::size_t i = 0; i < vehicles_.size(); ++i) vehicles_[i].loads = model.vehicles[i].loads;
  for (std::size_t s = 0; s < sites_.size(); ++s) {
    sites_[s].survey_open = model.sites[s].survey != kNone;
    sites_[s].deliveries_open = static_cast<int>(model.sites[s].deliveries.size());
    for (const Index t : model.sites[s].assessments) sites_[s].assessments_open |= bit(t);
  }
}

double PartialPlan::time_of(const Step& step) const {
  const Task& task = model_.tasks[at(model_.task_of[at(step.visit)])];
  const Vehicle& vehicle = vehicles_[at(step.vehicle)];
  const double arrival_s =
      vehicle.free_s + model_.reach_from(step.vehicle, vehicle.last)[step.visit];
  return task.id.kind == TaskKind::survey ? arrival_s
                                          : std::max(arrival_s, sites_[at(task.site)].ready_s);
}

bool PartialPlan::allows(const Step& step) const {
  const Task& task = model_.tasks[at(model_.task_of[at(step.visit)])];
  const coupled::Vehicle& its = model_.vehicles[at(step.vehicle)];
  const double time_s = time_of(step);
  const double end_s = time_s + model_.class_of(step.vehicle).after_s[at(step.visit)];
  if (!(end_s <= its.deadline_s)) return false;
  if (task.id.kind != TaskKind::deliver) return time_s >= floor_s_;
  if (vehicles_[at(step.vehicle)].loads == 0) return false;
  const auto members = group();
  return std::none_of(members.begin(), members.end(),
                      [&](const Member& m) { return m.vehicle == step.vehicle; });
}

void PartialPlan::set_common(double common_s) {
  common_s_ = common_s;
  for (const Member& m : group()) {
    vehicles_[at(m.vehicle)].free_s = common_s + model_.tasks[at(m.task)].offset_s;
  }
}

PartialPlan::Before PartialPlan::apply(const Step& step) {
  const Index index = model_.task_of[at(step.visit)];
  const Task& task = model_.tasks[at(index)];
  Site& site = sites_[at(task.site)];
  Vehicle& vehicle = vehicles_[at(step.vehicle)];
  const Before before{vehicle,   cost_,        floor_s_,    time_sum_s_,
                      common_s_, site.ready_s, group_site_, group_begin_};
  const double time_s = time_of(step);
  orders_[at(step.vehicle)].push_back(step.visit);
  vehicle.last = step.visit;
  --left_;
  done_ |= bit(index);
  if (task.id.kind == TaskKind::deliver) {
    --vehicle.loads;
    --site.deliveries_open;
    if (group_site_ == kNone) common_s_ = 0.0;
    group_site_ = task.site;
    members_.push_back({step.vehicle, index, before.vehicle.free_s});
    set_common(std::max(common_s_, time_s - task.offset_s));
    if (site.deliveries_open == 0) close_group();
    return before;
  }
  const double end_s = time_s + model_.class_of(step.vehicle).after_s[at(step.visit)];
  cost_ = model_.add(cost_, model_.cost_of(index, end_s)) +
          model_.vehicles[at(step.vehicle)].range_weight_per_s * (end_s - vehicle.free_s);
  vehicle.free_s = end_s;
  time_sum_s_ += time_s;
  if (!model_.offsets) floor_s_ = time_s;
  if (task.id.kind == TaskKind::survey) {
    site.survey_open = false;
    site.ready_s = site.deliveries_open > 0 ? end_s + model_.decide_wait_s : end_s;
  } else {
    site.assessments_open &= ~bit(index);
  }
  return before;
}

/// All deliveries are given away: their times are final.
void PartialPlan::close_group() {
  double last_s = 0.0;
  for (const Member& m : group()) {
    const double end_s = vehicles_[at(m.vehicle)].free_s;
    const coupled::Vehicle& its = model_.vehicles[at(m.vehicle)];
    last_s = std::max(last_s, end_s);
    time_sum_s_ += end_s;
    cost_ = end_s <= its.deadline_s ? model_.add(cost_, model_.cost_of(m.task, end_s)) +
                                          its.range_weight_per_s * (end_s - m.free_s)
                                    : kInfinity;
  }
  if (!model_.offsets) {
    if (common_s_ < floor_s_) cost_ = kInfinity;  // this plan is built in another way
    floor_s_ = common_s_;
  }
  sites_[at(group_site_)].ready_s = last_s + model_.sites[at(group_site_)].assess_wait_s;
  group_site_ = kNone;
  group_begin_ = members_.size();
}

void PartialPlan::undo(const Step& step, const Before& before) {
  const Index index = model_.task_of[at(step.visit)];
  const Task& task = model_.tasks[at(index)];
  Site& site = sites_[at(task.site)];
  orders_[at(step.vehicle)].pop_back();
  ++left_;
  done_ &= ~bit(index);
  cost_ = before.cost;
  floor_s_ = before.floor_s;
  time_sum_s_ = before.time_sum_s;
  site.ready_s = before.ready_s;
  if (task.id.kind == TaskKind::deliver) {
    ++site.deliveries_open;
    members_.pop_back();
    group_site_ = before.group_site;
    group_begin_ = before.group_begin;
    set_common(before.common_s);
  } else if (task.id.kind == TaskKind::survey) {
    site.survey_open = true;
  } else {
    site.assessments_open |= bit(index);
  }
  vehicles_[at(step.vehicle)] = before.vehicle;
}

}  // namespace skein::planning::coupled
