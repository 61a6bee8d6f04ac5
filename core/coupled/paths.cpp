// SPDX-License-Identifier: Apache-2.0
#include "paths.hpp"

#include <algorithm>
#include <ranges>

namespace skein::planning::coupled {

Paths::Paths(const Model& model)
    : model_{model}, sites_(model.sites.size()), tail_s_(model.tasks.size(), 0.0) {}

void Paths::find(const Timing& timing) {
  std::fill(sites_.begin(), sites_.end(), Site{});
  for (const Timing::Done& done : timing.done()) {
    const Index index = model_.task_of[at(done.visit)];
    const Task& task = model_.tasks[at(index)];
    Site& site = sites_[at(task.site)];
    const double time_s = timing.times_s()[at(index)];
    if (task.id.kind == TaskKind::survey) {
      site.survey_end_s = timing.ends_s()[at(index)];
    } else if (task.id.kind == TaskKind::deliver) {
      site.common_s = std::max(site.common_s, time_s - task.offset_s);
      site.last_delivery_s = std::max(site.last_delivery_s, time_s);
    }
  }
  // Backwards: all tails that one needs are there.
  for (const auto& done : std::views::reverse(timing.done())) {
    const Index index = model_.task_of[at(done.visit)];
    const Task& task = model_.tasks[at(index)];
    Site& site = sites_[at(task.site)];
    double after_s = site_tail_s(task);
    if (done.next != kNone) {
      after_s = std::max(after_s, model_.reach_from(done.vehicle, done.visit)[done.next] +
                                      tail_s(model_.task_of[at(done.next)]));
    }
    const double tail_s = model_.class_of(done.vehicle).after_s[at(done.visit)] + after_s;
    tail_s_[at(index)] = tail_s;
    if (task.id.kind == TaskKind::deliver) {
      site.common_tail_s = std::max(site.common_tail_s, task.offset_s + tail_s);
    } else if (task.id.kind == TaskKind::assess) {
      site.assess_tail_s = std::max(site.assess_tail_s, tail_s);
    }
  }
}

/// Who delays one delivery delays all of the site.
double Paths::tail_s(Index task) const {
  const Task& its = model_.tasks[at(task)];
  if (its.id.kind != TaskKind::deliver) return tail_s_[at(task)];
  return sites_[at(its.site)].common_tail_s - its.offset_s;
}

/// From the end of a task to the end of what must follow it at its site.
double Paths::site_tail_s(const Task& task) const {
  const Site& site = sites_[at(task.site)];
  const double assess_s = site.assess_tail_s;
  if (task.id.kind == TaskKind::survey) {
    if (site.common_tail_s != kNever) return model_.decide_wait_s + site.common_tail_s;
    return std::max(0.0, assess_s);
  }
  if (task.id.kind != TaskKind::deliver || assess_s == kNever) return 0.0;
  return model_.sites[at(task.site)].assess_wait_s + assess_s;
}

/// The earliest time of a task, as its site goes.
double Paths::ready_s(const Task& task) const {
  const Site& site = sites_[at(task.site)];
  if (task.id.kind == TaskKind::survey) return 0.0;
  const double surveyed_s = std::max(0.0, site.survey_end_s);
  if (task.id.kind == TaskKind::deliver) {
    const double decided_s = site.survey_end_s == kNever ? 0.0 : surveyed_s + model_.decide_wait_s;
    return std::max(site.common_s, decided_s) + task.offset_s;
  }
  if (site.last_delivery_s == kNever) return surveyed_s;
  return site.last_delivery_s + model_.sites[at(task.site)].assess_wait_s;
}

Paths::Newcomer Paths::newcomer(const Task& task) const {
  const double common_s = sites_[at(task.site)].common_tail_s;
  const bool grouped = task.id.kind == TaskKind::deliver && common_s != kNever;
  return {ready_s(task), site_tail_s(task), grouped ? common_s - task.offset_s : 0.0};
}

double Paths::through_s(const Newcomer& task, const std::vector<Index>& order, const Timing& timing,
                        Index vehicle, std::size_t position, Index visit) const {
  const Index before = position == 0 ? kNone : order[position - 1];
  const double free_s = before == kNone ? 0.0 : timing.ends_s()[at(model_.task_of[at(before)])];
  const double time_s = std::max(free_s + model_.reach_from(vehicle, before)[visit], task.ready_s);
  const double end_s = time_s + model_.class_of(vehicle).after_s[at(visit)];
  if (!(end_s <= model_.vehicles[at(vehicle)].latest_s[at(visit)])) return kInfinity;
  double after_s = task.tail_s;
  if (position < order.size()) {
    const Index next = order[position];
    after_s = std::max(after_s,
                       model_.reach_from(vehicle, visit)[next] + tail_s(model_.task_of[at(next)]));
  }
  return std::max(end_s + after_s, time_s + task.group_s);
}

}  // namespace skein::planning::coupled
