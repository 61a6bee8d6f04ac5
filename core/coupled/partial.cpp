// SPDX-License-Identifier: Apache-2.0
#include "partial.hpp"

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
    sites_[s].assessments_open = static_cast<int>(model.sites[s].assessments.size());
    sites_[s].untouched = model.sites[s].optional && model.sites[s].tasks > 0;
    if (!sites_[s].untouched) must_ += model.sites[s].tasks;
  }
}

double PartialPlan::left_out_cost() const {
  double cost = 0.0;
  for (std::size_t s = 0; s < sites_.size(); ++s) {
    if (sites_[s].untouched) cost += model_.sites[s].reward_cost;
  }
  return cost;
}

double PartialPlan::time_of(const Step& step) const {
  const Task& task = model_.tasks[at(model_.task_of[at(step.visit)])];
  const Vehicle& vehicle = vehicles_[at(step.vehicle)];
  const double arrival_s =
      vehicle.free_s + model_.reach_from(step.vehicle, vehicle.last)[step.visit];
  if (task.id.kind == TaskKind::survey) return arrival_s;
  return model_.flyable_s(step.vehicle, vehicle.last, step.visit, vehicle.free_s,
                          std::max(arrival_s, sites_[at(task.site)].ready_s));
}

bool PartialPlan::allows(const Step& step) const {
  const Task& task = model_.tasks[at(model_.task_of[at(step.visit)])];
  const coupled::Vehicle& its = model_.vehicles[at(step.vehicle)];
  if (has_its_share(model_, orders_[at(step.vehicle)], task)) return false;
  const double time_s = time_of(step);
  const double end_s = time_s + model_.class_of(step.vehicle).after_s[at(step.visit)];
  if (!(end_s <= its.latest_s[at(step.visit)])) return false;
  if (task.id.kind != TaskKind::deliver) {
    return comes_after_all({time_s, bit(step.vehicle), task.site});
  }
  if (vehicles_[at(step.vehicle)].loads == 0) return false;
  const auto members = group();
  return std::none_of(members.begin(), members.end(),
                      [&](const Member& m) { return m.vehicle == step.vehicle; });
}

bool PartialPlan::comes_after_all(const Job& job) const {
  for (std::size_t k = jobs_.size(); k-- > 0;) {
    const Job& other = jobs_[k];
    if (other.site == job.site || (other.vehicles & job.vehicles) != 0) return true;
    if (other.time_s > job.time_s) return false;
  }
  return true;
}

void PartialPlan::add_job(const Job& job) {
  jobs_.push_back(job);
  if (!model_.offsets) floor_s_ = job.time_s;
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
  const Before before{vehicle,     cost_,        floor_s_,     common_s_,     site.ready_s,
                      group_site_, group_begin_, jobs_.size(), site.untouched};
  const double time_s = time_of(step);
  orders_[at(step.vehicle)].push_back(step.visit);
  vehicle.last = step.visit;
  --left_;
  if (site.untouched) must_ += model_.sites[at(task.site)].tasks;
  site.untouched = false;
  --must_;
  done_.add(index);
  if (task.id.kind == TaskKind::deliver) {
    --vehicle.loads;
    --site.deliveries_open;
    if (group_site_ == kNone) common_s_ = 0.0;
    group_site_ = task.site;
    members_.push_back({step.vehicle, index, before.vehicle.last, before.vehicle.free_s});
    set_common(std::max(common_s_, time_s - task.offset_s));
    if (site.deliveries_open == 0) close_group();
    return before;
  }
  const double end_s = time_s + model_.class_of(step.vehicle).after_s[at(step.visit)];
  cost_ = model_.add(cost_, model_.cost_of(index, end_s)) +
          model_.vehicles[at(step.vehicle)].range_weight_per_s * (end_s - vehicle.free_s);
  vehicle.free_s = end_s;
  add_job({time_s, bit(step.vehicle), task.site});
  if (task.id.kind == TaskKind::survey) {
    site.survey_open = false;
    site.ready_s = site.deliveries_open > 0 ? end_s + model_.decide_wait_s : end_s;
  } else {
    --site.assessments_open;
  }
  return before;
}

/// All deliveries are given away: their times are final.
void PartialPlan::close_group() {
  for (double raised_s = -kInfinity; raised_s < common_s_;) {
    raised_s = common_s_;
    for (const Member& m : group()) {
      const double offset_s = model_.tasks[at(m.task)].offset_s;
      const double wanted_s = common_s_ + offset_s;
      const double time_s =
          model_.flyable_s(m.vehicle, m.last, vehicles_[at(m.vehicle)].last, m.free_s, wanted_s);
      if (time_s > wanted_s) set_common(time_s - offset_s);
    }
  }
  double last_s = 0.0;
  Mask vehicles = 0;
  for (const Member& m : group()) {
    const double end_s = vehicles_[at(m.vehicle)].free_s;
    const coupled::Vehicle& its = model_.vehicles[at(m.vehicle)];
    last_s = std::max(last_s, end_s);
    vehicles |= bit(m.vehicle);
    cost_ = end_s <= its.latest_s[at(vehicles_[at(m.vehicle)].last)]
                ? model_.add(cost_, model_.cost_of(m.task, end_s)) +
                      its.range_weight_per_s * (end_s - m.free_s)
                : kInfinity;
  }
  const Job job{common_s_, vehicles, group_site_};
  if (!comes_after_all(job)) cost_ = kInfinity;  // this plan is built in another way
  add_job(job);
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
  ++must_;
  if (before.untouched) must_ -= model_.sites[at(task.site)].tasks;
  site.untouched = before.untouched;
  done_.remove(index);
  cost_ = before.cost;
  floor_s_ = before.floor_s;
  jobs_.erase(jobs_.begin() + static_cast<std::ptrdiff_t>(before.jobs), jobs_.end());
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
    ++site.assessments_open;
  }
  vehicles_[at(step.vehicle)] = before.vehicle;
}

}  // namespace skein::planning::coupled
