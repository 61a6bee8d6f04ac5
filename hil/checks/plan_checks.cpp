// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>

#include "motion.hpp"
#include "skein/checks/checks.hpp"

namespace skein::checks {
namespace {

using recording::PlanRecord;
using recording::Recording;

// Relative slack for the rounding of 1/r, nothing else.
constexpr double kRounding = 1e-9;
// Arcs are walked in steps that leave at most a millimetre between chord and arc.
constexpr double kWalkStep = 0.5;
// A plan that touches a hazard's edge has not entered it.
constexpr double kEdge = 0.01;

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

/// The smallest flown radius over its limit, of one track.
double judge_track_turns(const Recording& recorded, const VehicleSpec& vehicle,
                         const Limits& limits, CheckResult& result) {
  const auto& track = recorded.track;
  double tightest = 0.0;
  Instant when{};
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
    if (whole && flown > 1.0 && std::abs(turned) / flown > tightest) {
      tightest = std::abs(turned) / flown;
      when = track[i].state.time;
    }
  }
  if (tightest * vehicle.turn_radius_m > 1.0 + limits.turn_share) {
    result.violations.push_back(
        {recorded.vehicle, when,
         vehicle_name(recorded.vehicle) + " turned " + at(when) + " at a radius of " +
             fixed(1.0 / tightest, 1) + " m through the air (limit " +
             fixed(vehicle.turn_radius_m / (1.0 + limits.turn_share), 1) + " m)"});
  }
  return tightest > 0.0 ? 1.0 / (tightest * vehicle.turn_radius_m) : 1e9;
}

/// When a plan stopped being followed; the end of the track for the last one.
Instant end_of(const Recording& recorded, std::size_t plan) {
  if (plan + 1 < recorded.plans.size()) return recorded.plans[plan + 1].since;
  return recorded.track.empty() ? recorded.plans[plan].since : recorded.track.back().state.time;
}

void judge_plan_hazard(const Recording& recorded, std::size_t index, const KnownHazard& known,
                       const Limits& limits, CheckResult& result) {
  const PlanRecord& plan = recorded.plans[index];
  const Instant held_from = known.known_from + from_seconds(limits.hazard_reaction_s);
  const double length = plan_length_m(plan.plan);
  double from = plan_distance_m(plan.plan, plan.since);
  double to = length;
  if (plan.since >= held_from || known.known_from <= Instant{}) {
    // Made in knowledge of the hazard, so clear to its end, one round of the hold included.
    if (plan.plan.tail_curvature_per_m != 0.0) {
      to = std::max(from, length) + kTwoPi / std::abs(plan.plan.tail_curvature_per_m);
    }
  } else {
    from = std::max(from, plan_distance_m(plan.plan, held_from));
    to = plan_distance_m(plan.plan, end_of(recorded, index));
  }
  if (to <= from) return;
  ++result.judged;

  bool outside_before = false;
  std::optional<double> where;
  double nearest = known.hazard.radius_m - kEdge;
  walk_plan(plan.plan, from, to, kWalkStep, [&](double distance, const Vec2& point) {
    const double away = (point - known.hazard.centre).norm();
    outside_before = outside_before || away >= known.hazard.radius_m;
    if (outside_before && away < nearest) {
      nearest = away;
      where = distance;
    }
    // The straight way back to the edge is the shortest; the margin is for rounding.
    return away - known.hazard.radius_m - kEdge;
  });
  if (where) {
    const Instant when = plan.plan.start_time + from_seconds(*where / plan.plan.speed_mps);
    result.violations.push_back({recorded.vehicle, plan.since,
                                 plan_name(recorded, plan) + " leads " + at(when) + " " +
                                     fixed(known.hazard.radius_m - nearest, 1) + " m into hazard " +
                                     std::to_string(known.hazard.id.value) + " (radius " +
                                     fixed(known.hazard.radius_m, 1) + " m)"});
  }
}

/// The least clearance of the track, metres; negative inside.
double judge_track_hazard(const Recording& recorded, const KnownHazard& known, const Limits& limits,
                          CheckResult& result) {
  const Instant held_from = known.known_from <= Instant{}
                                ? known.known_from
                                : known.known_from + from_seconds(limits.hazard_reaction_s);
  double nearest = 1e12;
  Instant when{};
  bool outside_before = false;
  for (std::size_t i = first_at(recorded.track, held_from); i < recorded.track.size(); ++i) {
    const VehicleState& s = recorded.track[i].state;
    const double away = (Vec2{s.x_m, s.y_m} - known.hazard.centre).norm() - known.hazard.radius_m;
    outside_before = outside_before || away >= 0.0;
    if (outside_before && away < nearest) {
      nearest = away;
      when = s.time;
    }
  }
  ++result.judged;
  if (nearest < 0.0) {
    result.violations.push_back({recorded.vehicle, when,
                                 vehicle_name(recorded.vehicle) + " flew " + at(when) + " " +
                                     fixed(-nearest, 1) + " m inside hazard " +
                                     std::to_string(known.hazard.id.value) + " (radius " +
                                     fixed(known.hazard.radius_m, 1) + " m)"});
  }
  return nearest;
}

}  // namespace

CheckResult check_turn_radius(const RunRecord& record, const Limits& limits) {
  CheckResult result{"turn radius",
                     "no plan turns tighter than the vehicle can; no track by more than " +
                         fixed(100.0 * limits.turn_share, 0) + " %",
                     0,
                     "plans and tracks",
                     "",
                     {}};
  double least = 1e9;
  for (const Recording& recorded : record.recordings) {
    const VehicleSpec* vehicle = spec_of(record, recorded.vehicle);
    if (vehicle == nullptr) continue;
    judge_plan_turns(recorded, *vehicle, result);
    if (recorded.track.size() < 2) continue;
    ++result.judged;
    least = std::min(least, judge_track_turns(recorded, *vehicle, limits, result));
  }
  if (least < 1e9) {
    result.measured = "tightest flown turn " + fixed(100.0 * least, 1) + " % of the turn radius";
  }
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
  double worst = 0.0;
  for (const Recording& recorded : record.recordings) {
    for (std::size_t i = 0; i < recorded.plans.size(); ++i) {
      const PlanRecord& plan = recorded.plans[i];
      const Pose2 here = plan_pose(plan.plan, plan_distance_m(plan.plan, plan.since));
      Pose2 before = here;
      const char* what = "the plan before it";
      if (i > 0) {
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
      worst = std::max(worst, jump);
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
  result.measured = "largest jump " + fixed(worst, 1) + " m";
  return result;
}

CheckResult check_range(const RunRecord& record, const Limits& limits) {
  CheckResult result{"range", "no vehicle flies, or plans to fly, further than its range",
                     0,       "plans and tracks",
                     "",      {}};
  double fullest = 0.0;
  for (const Recording& recorded : record.recordings) {
    const VehicleSpec* vehicle = spec_of(record, recorded.vehicle);
    if (vehicle == nullptr || recorded.track.empty()) continue;
    double flown = recorded.track.front().state.distance_flown_m;
    for (std::size_t i = 1; i < recorded.track.size(); ++i) {
      const VehicleState& a = recorded.track[i - 1].state;
      const VehicleState& b = recorded.track[i].state;
      flown += std::hypot(b.x_m - a.x_m, b.y_m - a.y_m);
    }
    flown = std::max(flown, recorded.track.back().state.distance_flown_m);
    ++result.judged;
    fullest = std::max(fullest, flown / vehicle->range_m);
    if (flown > vehicle->range_m) {
      result.violations.push_back({recorded.vehicle, recorded.track.back().state.time,
                                   vehicle_name(recorded.vehicle) + " flew " + fixed(flown, 0) +
                                       " m (range " + fixed(vehicle->range_m, 0) + " m)"});
    }
    for (const PlanRecord& plan : recorded.plans) {
      const auto there = track_at(recorded.track, plan.since, limits.track_gap_s);
      if (!there) continue;
      ++result.judged;
      const double ahead =
          std::max(0.0, plan_length_m(plan.plan) - plan_distance_m(plan.plan, plan.since));
      const double total = there->distance_flown_m + ahead;
      if (total > vehicle->range_m) {
        result.violations.push_back({recorded.vehicle, plan.since,
                                     plan_name(recorded, plan) + ", followed from " +
                                         fixed(to_seconds(plan.since), 2) +
                                         " s, brings the distance flown to " + fixed(total, 0) +
                                         " m (range " + fixed(vehicle->range_m, 0) + " m)"});
      }
    }
  }
  result.measured = "most used " + fixed(100.0 * fullest, 1) + " % of the range";
  return result;
}

CheckResult check_hazards(const RunRecord& record, const Limits& limits) {
  CheckResult result{"hazards", "no plan and no track enters a known hazard",
                     0,         "plans and tracks against hazards",
                     "",        {}};
  double least = 1e12;
  for (const Recording& recorded : record.recordings) {
    for (const KnownHazard& known : record.hazards) {
      for (std::size_t i = 0; i < recorded.plans.size(); ++i) {
        judge_plan_hazard(recorded, i, known, limits, result);
      }
      least = std::min(least, judge_track_hazard(recorded, known, limits, result));
    }
  }
  if (least < 1e11) result.measured = "least clearance flown " + fixed(least, 1) + " m";
  return result;
}

}  // namespace skein::checks
