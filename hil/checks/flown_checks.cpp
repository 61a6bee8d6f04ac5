// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "motion.hpp"
#include "skein/checks/checks.hpp"
#include "skein/checks/flown.hpp"

namespace skein::checks {
namespace {

using recording::TrackPoint;

// A start angle is looked for this long before and after the planned start.
constexpr double kStartWindow = 5.0;

Vec2 position(const TrackPoint& point) { return {point.state.x_m, point.state.y_m}; }

DeliveryFlown seen_delivery(const TaskRun& run, const Site& site,
                            const DeliveryRequirement& required,
                            const std::vector<TrackPoint>& track, const Limits& limits) {
  DeliveryFlown flown;
  flown.run = run;
  flown.offset = required.offset;
  const auto pass = nearest_pass(track, site.position, *run.planned, limits);
  if (!pass) return flown;
  flown.seen = true;
  flown.time = pass->time;
  flown.miss_m = pass->miss_m;
  flown.bearing_error_rad = wrap_pi(pass->heading_rad - required.bearing_rad);
  return flown;
}

/// When the vehicle passed the angle as seen from the site, next to `expected`.
std::optional<Instant> pass_of_angle(const std::vector<TrackPoint>& track, const Vec2& site,
                                     double angle_rad, Instant expected) {
  const Duration window = from_seconds(kStartWindow);
  std::optional<Instant> best;
  const auto beyond = [&](std::size_t i) {
    const Vec2 from_site = position(track[i]) - site;
    return wrap_pi(std::atan2(from_site.y(), from_site.x()) - angle_rad);
  };
  for (std::size_t i = std::max<std::size_t>(first_at(track, expected - window), 1);
       i < track.size() && track[i].state.time <= expected + window; ++i) {
    const double a = beyond(i - 1);
    const double b = beyond(i);
    // A change of sign at the far side of the site is no pass.
    if (a * b > 0.0 || std::abs(a) > 1.0 || std::abs(b) > 1.0) continue;
    const double share = a == b ? 0.0 : a / (a - b);
    const Instant time =
        track[i - 1].state.time +
        from_seconds(share * to_seconds(track[i].state.time - track[i - 1].state.time));
    if (!best || std::chrono::abs(time - expected) < std::chrono::abs(*best - expected)) {
      best = time;
    }
  }
  return best;
}

void measure_ring(const std::vector<TrackPoint>& track, const Vec2& site, const Limits& limits,
                  ArcFlown& arc) {
  const double allowed = limits.arc_radius_share * arc.radius_m;
  bool inside = true;
  for (std::size_t i = first_at(track, *arc.start); i < track.size(); ++i) {
    const double since = to_seconds(track[i].state.time - *arc.start);
    const double error = (position(track[i]) - site).norm() - arc.radius_m;
    if (since <= to_seconds(arc.dwell) && std::abs(error) > std::abs(arc.radius_error_m)) {
      arc.radius_error_m = error;
    }
    inside = inside && std::abs(error) <= allowed;
    if (inside) arc.dwell_s = since;
    if (!inside && since > to_seconds(arc.dwell)) break;
  }
}

/// Its vehicle was left alone on the way to it, or within: how well it was flown then is no word of
/// the program's.
bool was_disturbed(const RunRecord& record, const TaskRun& run, const Limits& limits) {
  return was_left_alone(record, run.vehicle, run.begin() - from_seconds(limits.taken_up_s),
                        run.done.value_or(run.begin()));
}

void excuse(const TaskRun& run, CheckResult& result) {
  result.excused.push_back({run.vehicle, run.begin(),
                            to_string(run.task) + " by " + vehicle_name(run.vehicle) + ", begun " +
                                at(run.begin()) +
                                ", is not judged by how it was flown: its program stood still"});
}

std::string delivery_name(const DeliveryFlown& d) {
  return to_string(d.run.task) + " by " + vehicle_name(d.run.vehicle);
}

/// How well it was flown is excused; that it was is the program's word still.
void judge_told(const DeliveryFlown& d, const Limits& limits, CheckResult& result) {
  constexpr double kStillThere = 2.0;
  if (!d.seen || d.miss_m <= kStillThere * limits.miss_m) return excuse(d.run, result);
  ++result.judged;
  result.violations.push_back({d.run.vehicle, *d.run.planned,
                               delivery_name(d) + " was told as done, though it passed " +
                                   fixed(d.miss_m, 1) + " m from the site"});
}

void judge_pass(const DeliveryFlown& d, const Limits& limits, CheckResult& result) {
  const auto violate = [&](const std::string& what) {
    result.violations.push_back({d.run.vehicle, *d.run.planned, delivery_name(d) + what});
  };
  if (!d.seen) {
    violate(" was planned " + at(*d.run.planned) + ", but the track does not show it");
    return;
  }
  if (d.miss_m > limits.miss_m) {
    violate(" passed " + at(d.time) + " " + fixed(d.miss_m, 1) + " m from the site (limit " +
            fixed(limits.miss_m, 0) + " m)");
  }
  if (std::abs(d.time_error_s()) > limits.arrival_s) {
    violate(" passed " + at(d.time) + ", planned " + at(*d.run.planned) + ": " +
            fixed(std::abs(d.time_error_s()), 2) + " s off (limit " + fixed(limits.arrival_s, 1) +
            " s)");
  }
  if (std::abs(d.bearing_error_rad) > limits.bearing_rad) {
    violate(" passed " + at(d.time) + " " + fixed(degrees(std::abs(d.bearing_error_rad)), 1) +
            " deg off its bearing (limit " + fixed(degrees(limits.bearing_rad), 0) + " deg)");
  }
}

/// The deliveries of one round: together, or in their slots. Returns the worst, s.
Worst judge_slots(const std::vector<const DeliveryFlown*>& group, const Limits& limits,
                  CheckResult& result) {
  Worst worst;
  if (group.size() < 2) return worst;
  const auto slot = [](const DeliveryFlown* d, Instant time) { return time - d->offset; };
  std::vector<Instant> planned;
  planned.reserve(group.size());
  for (const DeliveryFlown* d : group) planned.push_back(slot(d, *d->run.planned));
  std::sort(planned.begin(), planned.end());
  const Instant base = planned[planned.size() / 2];
  const DeliveryFlown* first = nullptr;
  const DeliveryFlown* last = nullptr;
  for (const DeliveryFlown* d : group) {
    const double plan_off = to_seconds(slot(d, *d->run.planned) - base);
    if (std::abs(plan_off) > limits.planned_time_s) {
      result.violations.push_back({d->run.vehicle, *d->run.planned,
                                   delivery_name(*d) + " was planned " + at(*d->run.planned) +
                                       ", " + fixed(std::abs(plan_off), 2) +
                                       " s off its slot beside the others (limit " +
                                       fixed(limits.planned_time_s, 2) + " s)"});
    }
    if (!d->seen) continue;
    const double off = to_seconds(slot(d, d->time) - base);
    if (d->offset > Duration{}) {
      worst.raise(std::abs(off), d->time);
      if (std::abs(off) > limits.arrival_s) {
        result.violations.push_back({d->run.vehicle, d->time,
                                     delivery_name(*d) + " passed " + at(d->time) + ", " +
                                         fixed(std::abs(off), 2) + " s off its slot (limit " +
                                         fixed(limits.arrival_s, 1) + " s)"});
      }
    } else {
      if (first == nullptr || d->time < first->time) first = d;
      if (last == nullptr || d->time > last->time) last = d;
    }
  }
  if (first != last) {
    const double spread = to_seconds(last->time - first->time);
    worst.raise(spread, last->time);
    if (spread > limits.arrival_s) {
      result.violations.push_back({last->run.vehicle, last->time,
                                   delivery_name(*last) + " passed " + at(last->time) + ", " +
                                       fixed(spread, 2) + " s after the simultaneous " +
                                       delivery_name(*first) + " (limit " +
                                       fixed(limits.arrival_s, 1) + " s)"});
    }
  }
  return worst;
}

CheckResult check_arcs(const RunRecord& record, const Limits& limits, TaskKind kind) {
  const bool survey = kind == TaskKind::survey;
  CheckResult result{survey ? "surveys" : "assessments",
                     "as flown: start within " + fixed(limits.arrival_s, 1) + " s, radius within " +
                         fixed(100.0 * limits.arc_radius_share, 0) + " %, the whole dwell",
                     0,
                     survey ? "surveys" : "assessments",
                     "",
                     {}};
  Worst worst_time;
  double worst_radius = 0.0;
  for (const ArcFlown& arc : arcs_flown(record, kind, limits)) {
    if (was_disturbed(record, arc.run, limits)) {
      excuse(arc.run, result);
      continue;
    }
    ++result.judged;
    const std::string who = to_string(arc.run.task) + " by " + vehicle_name(arc.run.vehicle);
    const auto violate = [&](const std::string& what) {
      result.violations.push_back({arc.run.vehicle, arc.run.begin(), who + what});
    };
    if (!arc.start) {
      violate(" is reported done, but the track does not pass its start angle near " +
              fixed(to_seconds(arc.run.planned ? *arc.run.planned : arc.run.begin()), 2) + " s");
      continue;
    }
    worst_time.raise(std::abs(arc.time_error_s()), *arc.start);
    worst_radius = std::max(worst_radius, std::abs(arc.radius_error_m) / arc.radius_m);
    if (std::abs(arc.time_error_s()) > limits.arrival_s) {
      violate(" began " + at(*arc.start) + ", planned " + at(*arc.run.planned) + ": " +
              fixed(std::abs(arc.time_error_s()), 2) + " s off (limit " +
              fixed(limits.arrival_s, 1) + " s)");
    }
    if (arc.dwell_s < to_seconds(arc.dwell)) {
      violate(" stayed on the arc for " + fixed(arc.dwell_s, 2) + " s from " +
              fixed(to_seconds(*arc.start), 2) + " s (required " + fixed(to_seconds(arc.dwell), 2) +
              " s within " + fixed(100.0 * limits.arc_radius_share, 0) + " % of " +
              fixed(arc.radius_m, 0) + " m; largest error " + fixed(arc.radius_error_m, 1) + " m)");
    }
  }
  if (result.judged > 0) {
    result.measured = "worst start " + fixed(worst_time.value, 2) + " s, radius " +
                      fixed(100.0 * worst_radius, 1) + " %";
  }
  result.moment = worst_time.at;
  return result;
}

}  // namespace

std::vector<DeliveryFlown> deliveries_flown(const RunRecord& record, const Limits& limits) {
  return deliveries_flown(record, record.recordings, limits);
}

std::vector<DeliveryFlown> deliveries_flown(const RunRecord& record,
                                            const std::vector<recording::Recording>& tracks,
                                            const Limits& limits) {
  const std::vector<TrackPoint> unknown;
  std::vector<DeliveryFlown> all;
  for (const TaskRun& run : task_runs(record)) {
    const Site* site = site_of(record, run.task.site);
    if (run.task.kind != TaskKind::deliver || !run.flown() || !run.planned || site == nullptr ||
        run.task.index >= site->deliveries.size()) {
      continue;
    }
    const recording::Recording* recorded = recording_of(tracks, run.vehicle);
    all.push_back(seen_delivery(run, *site, site->deliveries[run.task.index],
                                recorded != nullptr ? recorded->track : unknown, limits));
  }
  std::stable_sort(all.begin(), all.end(), [](const DeliveryFlown& a, const DeliveryFlown& b) {
    return std::pair{*a.run.planned, a.run.task} < std::pair{*b.run.planned, b.run.task};
  });
  return all;
}

std::vector<ArcFlown> arcs_flown(const RunRecord& record, TaskKind kind, const Limits& limits) {
  std::vector<ArcFlown> all;
  for (const TaskRun& run : task_runs(record)) {
    const Site* site = site_of(record, run.task.site);
    const VehicleSpec* vehicle = spec_of(record, run.vehicle);
    if (run.task.kind != kind || !run.flown() || !run.done || site == nullptr ||
        vehicle == nullptr ||
        (kind == TaskKind::assess && run.task.index >= site->assessments.size())) {
      continue;
    }
    const bool survey = kind == TaskKind::survey;
    const ArcRequirement& required = survey ? site->survey : site->assessments[run.task.index];
    ArcFlown arc;
    arc.run = run;
    arc.dwell = required.dwell;
    arc.radius_m = survey ? vehicle->sensor_radius_m : vehicle->assess_radius_m;
    const auto& track = recording_of(record, run.vehicle)->track;
    const Instant expected = run.planned ? *run.planned : run.begin();
    arc.start = required.start_angle_rad
                    ? pass_of_angle(track, site->position, *required.start_angle_rad, expected)
                    : std::optional{run.begin()};
    if (arc.start) measure_ring(track, site->position, limits, arc);
    all.push_back(arc);
  }
  return all;
}

std::map<TaskId, TaskFlown> tasks_flown(const RunRecord& record, const Limits& limits) {
  std::map<TaskId, TaskFlown> flown;
  for (const TaskRun& run : task_runs(record)) {
    if (!run.done) continue;
    const auto [known, is_new] = flown.emplace(run.task, TaskFlown{run.begin(), *run.done});
    if (!is_new && *run.done < known->second.time) known->second = {run.begin(), *run.done};
  }
  // Events tell planned times; where the track was seen to be there, that time counts.
  for (const DeliveryFlown& delivery : deliveries_flown(record, limits)) {
    TaskFlown& known = flown.at(delivery.run.task);
    if (delivery.seen && delivery.run.done == known.time) {
      known = {delivery.run.begin(), delivery.time};
    }
  }
  for (const ArcFlown& arc : arcs_flown(record, TaskKind::assess, limits)) {
    TaskFlown& known = flown.at(arc.run.task);
    if (arc.start && arc.run.done == known.time) known.begin = *arc.start;
  }
  return flown;
}

Reward reward_flown(const std::vector<Site>& sites, const std::map<TaskId, TaskFlown>& flown) {
  Reward reward;
  for (const Site& site : sites) {
    reward.all += site.reward * static_cast<double>(1 + tasks_after_survey(site).size());
    for (const auto& [task, run] : flown) {
      if (task.site != site.id) continue;
      reward.flown += site.reward * std::exp(-site.reward_decay_per_s * to_seconds(run.time));
    }
  }
  return reward;
}

/// The recording ended with the mission, before the approach that had begun could.
bool outlasts_recording(const RunRecord& record, const TaskRun& run) {
  const auto* recorded = recording_of(record, run.vehicle);
  const auto* vehicle = spec_of(record, run.vehicle);
  if (run.done || recorded == nullptr || vehicle == nullptr || recorded->track.empty()) {
    return false;
  }
  const Duration approach = from_seconds(vehicle->final_approach_m / vehicle->cruise_speed_mps);
  return recorded->track.back().state.time < run.begin() + approach;
}

CheckResult check_deliveries(const RunRecord& record, const Limits& limits) {
  CheckResult result{"deliveries",
                     "as flown: within " + fixed(limits.arrival_s, 1) + " s, " +
                         fixed(limits.miss_m, 0) + " m and " +
                         fixed(degrees(limits.bearing_rad), 0) + " deg",
                     0,
                     "deliveries",
                     "",
                     {}};
  for (const TaskRun& run : task_runs(record)) {
    const bool delivered = run.task.kind == TaskKind::deliver && run.flown() && !run.cut_off &&
                           !outlasts_recording(record, run) && !was_disturbed(record, run, limits);
    const Site* site = site_of(record, run.task.site);
    if (delivered &&
        (!run.planned || site == nullptr || run.task.index >= site->deliveries.size())) {
      ++result.judged;
      result.violations.push_back({run.vehicle, run.begin(),
                                   to_string(run.task) + " by " + vehicle_name(run.vehicle) +
                                       " began " + at(run.begin()) +
                                       (run.planned ? ", but the mission has no such delivery"
                                                    : ", and its end was never told")});
    }
  }
  const std::vector<DeliveryFlown> flown = deliveries_flown(record, limits);
  std::map<std::pair<SiteId, coalition::Round>, std::vector<const DeliveryFlown*>> groups;
  Worst time;
  double miss = 0.0;
  double bearing = 0.0;
  for (const DeliveryFlown& d : flown) {
    if (was_disturbed(record, d.run, limits)) {
      judge_told(d, limits, result);
      continue;
    }
    ++result.judged;
    judge_pass(d, limits, result);
    groups[{d.run.task.site, d.run.round}].push_back(&d);
    if (!d.seen) continue;
    time.raise(std::abs(d.time_error_s()), d.time);
    miss = std::max(miss, d.miss_m);
    bearing = std::max(bearing, std::abs(d.bearing_error_rad));
  }
  Worst slot;
  for (const auto& [key, group] : groups) {
    const Worst of_group = judge_slots(group, limits, result);
    if (of_group.at) slot.raise(of_group.value, *of_group.at);
  }
  if (!flown.empty()) {
    result.measured = "worst " + fixed(time.value, 2) + " s (together or slot " +
                      fixed(slot.value, 2) + " s), " + fixed(miss, 1) + " m, " +
                      fixed(degrees(bearing), 1) + " deg";
  }
  result.moment = slot.value > time.value ? slot.at : time.at;
  return result;
}

CheckResult check_surveys(const RunRecord& record, const Limits& limits) {
  return check_arcs(record, limits, TaskKind::survey);
}
CheckResult check_assessments(const RunRecord& record, const Limits& limits) {
  return check_arcs(record, limits, TaskKind::assess);
}

CheckResult check_copters(const RunRecord& record, const Limits& limits) {
  const auto by_copter = [&](const TaskRun& run) {
    const VehicleSpec* vehicle = spec_of(record, run.vehicle);
    return vehicle != nullptr && vehicle->is_copter();
  };
  std::map<TaskKind, std::size_t> flown;
  std::optional<Instant> moment;
  for (const TaskKind kind : {TaskKind::survey, TaskKind::assess}) {
    for (const ArcFlown& arc : arcs_flown(record, kind, limits)) {
      if (!arc.start || !by_copter(arc.run)) continue;
      ++flown[kind];
      note_moment(moment, *arc.start);
    }
  }
  for (const DeliveryFlown& delivery : deliveries_flown(record, limits)) {
    if (!delivery.seen || !by_copter(delivery.run)) continue;
    ++flown[TaskKind::deliver];
    note_moment(moment, delivery.time);
  }
  CheckResult result{"copters", "copters have flown what is expected of them", 0, "tasks", "", {}};
  result.moment = moment;
  for (const TaskKind kind : {TaskKind::survey, TaskKind::deliver, TaskKind::assess}) {
    const std::string name{to_string(kind)};
    if (flown[kind] > 0) {
      result.judged += flown[kind];
      result.measured.append(result.measured.empty() ? "" : ", ");
      result.measured.append(std::to_string(flown[kind])).append(" ").append(name);
    } else if (limits.copters_fly.has(kind)) {
      result.violations.push_back(
          {kGroundStation, Instant{}, "no copter has flown a task to " + name});
    }
  }
  return result;
}

}  // namespace skein::checks
