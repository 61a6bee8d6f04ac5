// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "motion.hpp"
#include "skein/checks/checks.hpp"

namespace skein::checks {

namespace {

/// But for the time after it in which its program finds out where it is.
bool is_within_left_alone(const RunRecord& record, const Limits& limits, VehicleId vehicle,
                          Instant from, Instant until) {
  return std::ranges::any_of(record.left_alone, [&](const LeftAlone& alone) {
    return alone.vehicle == vehicle && alone.from <= from + from_seconds(limits.track_gap_s) &&
           until <= alone.until + from_seconds(limits.taken_up_s);
  });
}

}  // namespace

CheckResult check_recordings(const RunRecord& record, const Limits& limits) {
  CheckResult result{"recordings",
                     "every vehicle left a track without gaps above " +
                         fixed(limits.track_gap_s, 1) + " s, and its plans",
                     0,
                     "vehicles",
                     "",
                     {}};
  Worst worst;
  for (const VehicleSpec& vehicle : record.vehicles) {
    ++result.judged;
    const std::string who = vehicle_name(vehicle.id);
    const auto* recorded = recording_of(record, vehicle.id);
    const bool lost =
        std::find(record.lost.begin(), record.lost.end(), vehicle.id) != record.lost.end();
    const bool planned =
        recorded != nullptr && (!recorded->plans.empty() || !record.places.empty());
    if (recorded == nullptr || recorded->track.empty() || !planned) {
      const char* what = recorded == nullptr       ? " left no recording"
                         : recorded->track.empty() ? " left no track"
                                                   : " left no plan";
      if (!lost) result.violations.push_back({vehicle.id, Instant{}, who + what});
      continue;
    }
    if (!lost && recorded->damaged_parts > 0) {
      result.violations.push_back({vehicle.id, recorded->track.back().state.time,
                                   who + " left " + std::to_string(recorded->damaged_parts) +
                                       " parts of a recording that cannot be read"});
    }
    for (std::size_t i = 1; i < recorded->track.size(); ++i) {
      const Instant from = recorded->track[i - 1].state.time;
      const Instant next = recorded->track[i].state.time;
      const double gap = to_seconds(next - from);
      if (gap > 0.0 && is_within_left_alone(record, limits, vehicle.id, from, next)) continue;
      worst.raise(gap, from);
      if (gap <= 0.0 || gap > limits.track_gap_s) {
        result.violations.push_back(
            {vehicle.id, from,
             who + "'s track " + at(from) +
                 (gap <= 0.0 ? " does not go forward in time"
                             : " has a gap of " + fixed(gap, 2) + " s (limit " +
                                   fixed(limits.track_gap_s, 2) + " s)")});
      }
    }
  }
  result.measured = "longest gap " + fixed(worst.value, 2) + " s";
  result.moment = worst.at;
  return result;
}

std::vector<CheckResult> judge(const RunRecord& record, const Limits& limits) {
  std::vector<CheckResult> results;
  for (const auto check :
       {check_recordings, check_turn_radius, check_continuity, check_range, check_hazards,
        check_precedence, check_capabilities, check_loads, check_leases, check_authorisation,
        check_standing_orders, check_single_delivery, check_completion, check_separation,
        check_deliveries, check_surveys, check_assessments}) {
    results.push_back(check(record, limits));
  }
  if (auto fence = check_fence(record)) results.push_back(*std::move(fence));
  if (auto taken_back = check_taken_back(record)) results.push_back(*std::move(taken_back));
  return results;
}

std::vector<CheckResult> judge_routes(const RunRecord& record, const Limits& limits) {
  std::vector<CheckResult> results;
  for (const auto check : {check_recordings, check_turn_radius, check_continuity, check_range,
                           check_hazards, check_separation, check_routes}) {
    results.push_back(check(record, limits));
  }
  return results;
}

std::vector<CheckResult> judge_formation(const RunRecord& record, const Limits& limits) {
  std::vector<CheckResult> results;
  for (const auto check :
       {check_recordings, check_separation, check_orders, check_arrivals, check_places}) {
    results.push_back(check(record, limits));
  }
  return results;
}

std::vector<CheckResult> judge_tracks(const RunRecord& record, const Limits& limits) {
  std::vector<CheckResult> results;
  for (const auto check :
       {check_recordings, check_turn_radius, check_continuity, check_range, check_hazards,
        check_separation, check_orders, check_arrivals, check_moving_places}) {
    results.push_back(check(record, limits));
  }
  return results;
}

}  // namespace skein::checks
