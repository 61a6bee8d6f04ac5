// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "motion.hpp"
#include "skein/checks/checks.hpp"

namespace skein::checks {
namespace {

using recording::PlanRecord;
using recording::Recording;

// Relative slack for the rounding of 1/r, nothing else.
constexpr double kRounding = 1e-9;

std::string plan_name(const Recording& recorded, const PlanRecord& plan) {
  return "plan " + std::to_string(plan.number) + " of " + vehicle_name(recorded.vehicle);
}

void judge_plan_turns(const Recording& recorded, const VehicleSpec& vehicle, CheckResult& result) {
  for (const PlanRecord& plan : recorded.plans) {
    ++result.judged;
    double tightest = std::abs(plan.plan.tail_curvature_per_m);
    for (const Segment& segment : plan.plan.path.segments) {
      tightest = std::max(tightest, std::abs(segment.curvature_per_m));
    }
    if (tightest * vehicle.turn_radius_m > 1.0 + kRounding) {
      result.violations.push_back({recorded.vehicle, plan.since,
                                   plan_name(recorded, plan) + ", followed from " +
                                       fixed(to_seconds(plan.since), 2) +
                                       " s, turns at a radius of " + fixed(1.0 / tightest, 2) +
                                       " m (limit " + fixed(vehicle.turn_radius_m, 2) + " m)"});
    }
  }
}

/// An autopilot flew it, through gusts: it rolls past the bank that is asked for, and back.
bool is_on_autopilot(const RunRecord& record, VehicleId vehicle) {
  return std::ranges::any_of(
      record.truths, [vehicle](const Recording& truth) { return truth.vehicle == vehicle; });
}

struct TightestTurn {
  double curvature_per_m = 0.0;
  Instant when{};
};

/// The tightest that was flown, through the air.
TightestTurn tightest_turn(const Recording& recorded, const Limits& limits) {
  const auto track = planned_part(recorded.track);
  TightestTurn tightest;
  double turned = 0.0;  // over the window [first, i]
  double flown = 0.0;
  const auto turn = [&](std::size_t i) {
    return wrap_pi(track[i].state.heading_rad - track[i - 1].state.heading_rad);
  };
  const auto run = [&](std::size_t i) {
    return 0.5 * (track[i].state.airspeed_mps + track[i - 1].state.airspeed_mps) *
           to_seconds(track[i].state.time - track[i - 1].state.time);
  };
  std::size_t first = 0;
  for (std::size_t i = 1; i < track.size(); ++i) {
    turned += turn(i);
    flown += run(i);
    while (first + 1 < i && to_seconds(track[i].state.time - track[first + 1].state.time) >=
                                limits.turn_window_s - 1e-6) {
      ++first;
      turned -= turn(first);
      flown -= run(first);
    }
    const bool whole =
        to_seconds(track[i].state.time - track[first].state.time) >= limits.turn_window_s - 1e-6;
    if (whole && flown > 1.0 && std::abs(turned) / flown > tightest.curvature_per_m) {
      tightest = {std::abs(turned) / flown, track[i].state.time};
    }
  }
  return tightest;
}

void judge_track_turns(const Recording& recorded, const VehicleSpec& vehicle, const Limits& limits,
                       const TightestTurn& tightest, CheckResult& result) {
  ++result.judged;
  if (tightest.curvature_per_m * vehicle.turn_radius_m <= 1.0 + limits.turn_share) return;
  result.violations.push_back(
      {recorded.vehicle, tightest.when,
       vehicle_name(recorded.vehicle) + " turned " + at(tightest.when) + " at a radius of " +
           fixed(1.0 / tightest.curvature_per_m, 1) + " m through the air (limit " +
           fixed(vehicle.turn_radius_m / (1.0 + limits.turn_share), 1) + " m)"});
}

}  // namespace

CheckResult check_turn_radius(const RunRecord& record, const Limits& limits) {
  CheckResult result{"turn radius",
                     "no plan turns tighter than the vehicle can; no track by more than " +
                         fixed(100.0 * limits.turn_share, 0) + " %, but for those of autopilots",
                     0,
                     "plans and tracks",
                     "",
                     {}};
  Worst least{.value = 1e9, .at = {}};
  for (const Recording& recorded : record.recordings) {
    const VehicleSpec* vehicle = spec_of(record, recorded.vehicle);
    if (vehicle == nullptr) continue;
    judge_plan_turns(recorded, *vehicle, result);
    // A copter turns on the spot; what its plans' turns take is judged above.
    if (recorded.track.size() < 2 || vehicle->is_copter()) continue;
    const TightestTurn tightest = tightest_turn(recorded, limits);
    if (!is_on_autopilot(record, recorded.vehicle)) {
      judge_track_turns(recorded, *vehicle, limits, tightest, result);
    }
    if (tightest.curvature_per_m > 0.0) {
      least.lower(1.0 / (tightest.curvature_per_m * vehicle->turn_radius_m), tightest.when);
    }
  }
  if (least.at) {
    result.measured =
        "tightest flown turn " + fixed(100.0 * least.value, 1) + " % of the turn radius";
  }
  result.moment = least.at;
  return result;
}

CheckResult check_continuity(const RunRecord& record, const Limits& limits) {
  CheckResult result{"continuity",
                     "a new plan starts where the old one is, within " +
                         fixed(limits.plan_jump_m, 0) + " m and " +
                         fixed(degrees(limits.plan_jump_rad), 0) + " deg",
                     0,
                     "plans",
                     "",
                     {}};
  Worst worst;
  for (const Recording& recorded : record.recordings) {
    for (std::size_t i = 0; i < recorded.plans.size(); ++i) {
      const PlanRecord& plan = recorded.plans[i];
      const Pose2 here = plan_pose(plan.plan, plan_distance_m(plan.plan, plan.since));
      Pose2 before = here;
      const char* what = "the plan before it";
      // Where the vehicle's program has ended, what flies it starts from where it is; so does its
      // new program: the wind has carried it off the orbit meanwhile.
      const bool other_program =
          std::any_of(record.agent_ends.begin(), record.agent_ends.end(), [&](const AgentEnd& end) {
            const bool anew = i > 0 && end.restarted_at && plan.since >= *end.restarted_at &&
                              recorded.plans[i - 1].since < *end.restarted_at;
            return end.vehicle == recorded.vehicle && (end.at == plan.since || anew);
          });
      // And who was left alone, from where that has brought it, where it finds that out.
      const auto from_old = [&] {
        return plan_pose(recorded.plans[i - 1].plan,
                         plan_distance_m(recorded.plans[i - 1].plan, plan.since));
      };
      const bool taken_up =
          i > 0 &&
          was_left_alone(record, recorded.vehicle, recorded.plans[i - 1].since, plan.since) &&
          ((here.position() - from_old().position()).norm() > limits.plan_jump_m ||
           std::abs(wrap_pi(here.heading_rad - from_old().heading_rad)) > limits.plan_jump_rad);
      if (i > 0 && !other_program && !taken_up) {
        const PlanRecord& old = recorded.plans[i - 1];
        before = plan_pose(old.plan, plan_distance_m(old.plan, plan.since));
        if (plan.number <= old.number || plan.since < old.since) {
          result.violations.push_back({recorded.vehicle, plan.since,
                                       plan_name(recorded, plan) + " came after plan " +
                                           std::to_string(old.number) +
                                           ": numbers and times must grow"});
        }
      } else if (const auto flown = track_at(recorded.track, plan.since, limits.track_gap_s)) {
        before = {flown->horizontal.x(), flown->horizontal.y(), here.heading_rad};
        what = "the vehicle";
      } else {
        continue;
      }
      ++result.judged;
      const double jump = (here.position() - before.position()).norm();
      const double turn = std::abs(wrap_pi(here.heading_rad - before.heading_rad));
      worst.raise(jump, plan.since);
      if (!(jump <= limits.plan_jump_m && turn <= limits.plan_jump_rad)) {
        result.violations.push_back({recorded.vehicle, plan.since,
                                     plan_name(recorded, plan) + " starts " + at(plan.since) + " " +
                                         fixed(jump, 1) + " m and " + fixed(degrees(turn), 1) +
                                         " deg from " + what + " (limits " +
                                         fixed(limits.plan_jump_m, 0) + " m and " +
                                         fixed(degrees(limits.plan_jump_rad), 0) + " deg)"});
      }
    }
  }
  result.measured = "largest jump " + fixed(worst.value, 1) + " m";
  result.moment = worst.at;
  return result;
}

namespace {

double length_m(std::span<const recording::TrackPoint> track) {
  double sum_m = 0.0;
  for (std::size_t i = 1; i < track.size(); ++i) {
    const VehicleState& a = track[i - 1].state;
    const VehicleState& b = track[i].state;
    sum_m += std::hypot(b.x_m - a.x_m, b.y_m - a.y_m);
  }
  return sum_m;
}

/// By its range; what it lands with is a glide, which takes none.
void judge_flown_range(const Recording& recorded, const VehicleSpec& vehicle, const Limits& limits,
                       double flown_m, CheckResult& result) {
  const auto add = [&](Instant when, const std::string& what) {
    result.violations.push_back({recorded.vehicle, when, vehicle_name(recorded.vehicle) + what});
  };
  const auto planned = planned_part(recorded.track);
  const Instant end = planned.back().state.time;
  if (flown_m > vehicle.range_m) {
    add(end, " flew " + fixed(flown_m, 0) + " m (range " + fixed(vehicle.range_m, 0) + " m)");
  }
  const double landed_m = length_m(std::span{recorded.track}.subspan(planned.size() - 1));
  const double lap_m = kTwoPi * vehicle.planning_radius_m();
  // A copter comes over its place, and straight down.
  const double glide_m = vehicle.is_copter() ? 2.0 * lap_m
                                             : limits.glide_ratio * planned.back().state.z_m +
                                                   2.0 * (vehicle.landing.approach_m + lap_m);
  if (landed_m > glide_m) {
    add(recorded.track.back().state.time, " flew " + fixed(landed_m, 0) +
                                              " m to land (a glide there takes " +
                                              fixed(glide_m, 0) + " m at most)");
  }
  const auto empty = std::ranges::find_if(
      recorded.track, [](const auto& point) { return point.state.battery_percent == 0; });
  if (empty != recorded.track.end()) add(empty->state.time, " flies on a battery that is empty");
}

void judge_planned_range(const Recording& recorded, const VehicleSpec& vehicle,
                         const Limits& limits, CheckResult& result) {
  const Instant landed_from = planned_part(recorded.track).back().state.time;
  for (const PlanRecord& plan : recorded.plans) {
    const auto there = track_at(recorded.track, plan.since, limits.track_gap_s);
    if (!there || plan.since > landed_from) continue;
    ++result.judged;
    const double ahead =
        std::max(0.0, plan_length_m(plan.plan) - plan_distance_m(plan.plan, plan.since));
    const double total = there->distance_flown_m + ahead;
    if (total <= vehicle.range_m) continue;
    result.violations.push_back({recorded.vehicle, plan.since,
                                 plan_name(recorded, plan) + ", followed from " +
                                     fixed(to_seconds(plan.since), 2) +
                                     " s, brings the distance flown to " + fixed(total, 0) +
                                     " m (range " + fixed(vehicle.range_m, 0) + " m)"});
  }
}

}  // namespace

CheckResult check_range(const RunRecord& record, const Limits& limits) {
  CheckResult result{
      "range", "no vehicle flies, or plans to fly, further than its range, or on an empty battery",
      0,       "plans and tracks",
      "",      {}};
  Worst fullest;
  for (const Recording& recorded : record.recordings) {
    const VehicleSpec* vehicle = spec_of(record, recorded.vehicle);
    if (vehicle == nullptr || recorded.track.empty()) continue;
    const auto planned = planned_part(recorded.track);
    const VehicleState& last = planned.back().state;
    const double flown_m =
        std::max(planned.front().state.distance_flown_m + length_m(planned), last.distance_flown_m);
    ++result.judged;
    fullest.raise(flown_m / vehicle->range_m, last.time);
    judge_flown_range(recorded, *vehicle, limits, flown_m, result);
    judge_planned_range(recorded, *vehicle, limits, result);
  }
  result.measured = "most used " + fixed(100.0 * fullest.value, 1) + " % of the range";
  result.moment = fullest.at;
  return result;
}

}  // namespace skein::checks
