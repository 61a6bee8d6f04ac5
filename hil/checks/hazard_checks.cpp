// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "motion.hpp"
#include "skein/checks/checks.hpp"

namespace skein::checks {
namespace {

using recording::PlanRecord;
using recording::Recording;

// Arcs are walked in steps that leave at most a millimetre between chord and arc.
constexpr double kWalkStep = 0.5;
// A plan that touches a hazard's edge has not entered it; it begins where the vehicle was to be,
// some centimetres beside where it was.
constexpr double kEdge = 0.05;

/// From when on a vehicle is held to a hazard. Before that it may not have heard of it.
struct Held {
  Instant from{};
  bool always = false;  ///< the hazard was known before the mission
};

/// A vehicle knows of a hazard when that appears, or, where no program was running on it, from its
/// next start on, and where that stood still, from when it goes on. None where that never came.
std::optional<Held> held(const RunRecord& record, const Recording& recorded,
                         const TimedHazard& known, const Limits& limits) {
  if (known.known_before()) return Held{known.known_from, true};
  Instant knows = known.known_from;
  if (!recorded.track.empty()) knows = std::max(knows, recorded.track.front().state.time);
  for (const AgentEnd& end : record.agent_ends) {
    if (end.vehicle != recorded.vehicle || knows < end.at) continue;
    if (!end.restarted_at) return std::nullopt;
    knows = std::max(knows, *end.restarted_at);
  }
  for (const LeftAlone& still : record.stood_still) {
    const bool concerned = still.vehicle == recorded.vehicle && knows >= still.from;
    if (concerned) knows = std::max(knows, still.until);
  }
  return Held{knows + from_seconds(limits.hazard_reaction_s), false};
}

Vec2 wind_of(const VehicleState& state) {
  return state.groundspeed_mps * unit_vector(state.course_rad) -
         state.airspeed_mps * unit_vector(state.heading_rad);
}

/// Where the vehicle is, what lies within its power, and what does not (the wind).
struct Mover {
  Vec2 position;
  double heading_rad = 0.0;
  double airspeed_mps = 0.0;
  double turn_radius_m = 0.0;  ///< the least: through the air and, as plans have it, over ground
  Vec2 wind;
  double turned_rad = 0.0;

  [[nodiscard]] Vec2 velocity() const { return airspeed_mps * unit_vector(heading_rad) + wind; }
  void turn(double side, double seconds) {
    const Vec2 over_ground = velocity();
    const double speed_mps = over_ground.norm();
    // Over the ground the curvature of a turn is its rate times this by the speed cubed.
    const double ahead_m2ps2 = airspeed_mps * unit_vector(heading_rad).dot(over_ground);
    double rate_max = airspeed_mps / turn_radius_m;
    if (ahead_m2ps2 > 0.0) {
      rate_max = std::min(rate_max, std::pow(speed_mps, 3) / ahead_m2ps2 / turn_radius_m);
    }
    const double turn_rad = rate_max * seconds;
    heading_rad += 0.5 * side * turn_rad;
    position += velocity() * seconds;
    heading_rad += 0.5 * side * turn_rad;
    turned_rad += turn_rad;
  }
};

Mover mover_at(const VehicleState& state, const VehicleSpec& vehicle) {
  return {{state.x_m, state.y_m},
          state.heading_rad,
          state.airspeed_mps,
          vehicle.turn_radius_m,
          wind_of(state)};
}

constexpr double kStep_s = 0.01;      ///< 0.5 m for the fastest vehicles
constexpr double kLongest_s = 300.0;  ///< a turn in a wind that it makes no way against

/// Could the vehicle stay outside from the first point on, in the wind that there was from then on?
/// The most that it can do is the tightest turn to one side, until it comes no nearer, and straight
/// on: no other path passes farther off. So it cannot exactly when both turns lead into the hazard.
bool could_stay_outside(std::span<const recording::TrackPoint> track, const VehicleSpec& vehicle,
                        const Hazard& hazard) {
  const auto misses = [&](double side) {
    Mover m = mover_at(track.front().state, vehicle);
    auto now = track.begin();
    for (double t_s = 0.0; m.turned_rad < kTwoPi && t_s < kLongest_s; t_s += kStep_s) {
      const Vec2 from_centre = m.position - hazard.centre;
      if (from_centre.norm() < hazard.radius_m) return false;
      if (from_centre.dot(m.velocity()) >= 0.0) return true;
      m.turn(side, kStep_s);
      const Instant time = track.front().state.time + from_seconds(t_s);
      while (std::next(now) != track.end() && std::next(now)->state.time <= time) ++now;
      m.wind = wind_of(now->state);
    }
    return true;
  };
  return misses(1.0) || misses(-1.0);
}

/// Time to the edge straight on, from inside.
double straight_out_s(const Mover& m, const Hazard& hazard) {
  const Vec2 p = m.position - hazard.centre;
  const Vec2 v = m.velocity();
  const double v2 = v.squaredNorm();
  if (v2 <= 0.0) return std::numeric_limits<double>::infinity();
  const double b = p.dot(v);
  const double c = hazard.radius_m * hazard.radius_m - p.squaredNorm();
  return (std::sqrt(std::max(0.0, b * b + v2 * c)) - b) / v2;
}

/// The shortest time in which the vehicle can be outside: a turn to either side, then straight on.
double way_out_s(const Mover& start, const Hazard& hazard) {
  double best = straight_out_s(start, hazard);
  for (const double side : {1.0, -1.0}) {
    Mover m = start;
    for (double t = 0.0; t < std::min(best, kLongest_s) && m.turned_rad < kTwoPi; t += kStep_s) {
      if ((m.position - hazard.centre).norm() >= hazard.radius_m) {
        best = t;
        break;
      }
      best = std::min(best, t + straight_out_s(m, hazard));
      m.turn(side, kStep_s);
    }
  }
  return best;
}

std::string into(const Hazard& hazard) {
  return "hazard " + std::to_string(hazard.id.value) + " (radius " + fixed(hazard.radius_m, 1) +
         " m)";
}

/// What is excused of a vehicle and a hazard: it is inside although it could do nothing else.
struct Excused {
  Instant since{};
  Instant until{};  ///< when it should have left, by the shortest way
};

double clearance_m(const VehicleState& s, const Hazard& hazard) {
  return (Vec2{s.x_m, s.y_m} - hazard.centre).norm() - hazard.radius_m;
}

/// At the moment from which it is held to the hazard the vehicle is inside, or no turn misses it.
std::optional<Excused> excused(const Recording& recorded, const VehicleSpec* vehicle,
                               const TimedHazard& known, const Held& held, const Limits& limits) {
  if (held.always || vehicle == nullptr) return std::nullopt;
  const auto& track = recorded.track;
  std::size_t i = first_at(track, held.from);
  if (i == track.size()) return std::nullopt;
  if (clearance_m(track[i].state, known.hazard) >= 0.0) {
    const std::span flown = std::span{track}.subspan(i);
    if (could_stay_outside(flown, *vehicle, known.hazard)) return std::nullopt;
    double clear = clearance_m(track[i].state, known.hazard);
    while (clear >= 0.0) {
      if (++i == track.size()) return std::nullopt;
      // Who comes no nearer has missed it; what is entered after that could be avoided.
      const double next = clearance_m(track[i].state, known.hazard);
      if (next > clear) return std::nullopt;
      clear = next;
    }
  }
  const VehicleState& entry = track[i].state;
  const double out_s = way_out_s(mover_at(entry, *vehicle), known.hazard);
  return Excused{entry.time, entry.time + from_seconds(out_s + limits.hazard_leaving_s)};
}

void judge_plan(const Recording& recorded, std::size_t index, const TimedHazard& known,
                const Held& held, const std::optional<Excused>& excuse, CheckResult& result) {
  const PlanRecord& plan = recorded.plans[index];
  const double length = plan_length_m(plan.plan);
  double from = plan_distance_m(plan.plan, plan.since);
  double to = length;
  if (plan.since >= held.from || held.always) {
    // Made in knowledge of the hazard, so clear to its end, one round of the hold included.
    if (plan.plan.tail_curvature_per_m != 0.0) {
      to = std::max(from, length) + kTwoPi / std::abs(plan.plan.tail_curvature_per_m);
    }
  } else {
    const bool last = index + 1 == recorded.plans.size();
    const Instant end = !last                    ? recorded.plans[index + 1].since
                        : recorded.track.empty() ? plan.since
                                                 : recorded.track.back().state.time;
    from = std::max(from, plan_distance_m(plan.plan, held.from));
    to = plan_distance_m(plan.plan, end);
  }
  if (excuse) from = std::max(from, plan_distance_m(plan.plan, excuse->until));
  if (to <= from) return;
  ++result.judged;

  // A plan from before the vehicle was held to the hazard may lead out of it then; how long that
  // may take is judged by the track. Who is inside one that was known before the mission has been
  // judged for the way in.
  bool outside_before = !held.always && (plan.since >= held.from || excuse);
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
  if (!where) return;
  const Instant when = plan.plan.time_at(*where);
  result.violations.push_back({recorded.vehicle, plan.since,
                               "plan " + std::to_string(plan.number) + " of " +
                                   vehicle_name(recorded.vehicle) + " leads " + at(when) + " " +
                                   fixed(known.hazard.radius_m - nearest, 1) + " m into " +
                                   into(known.hazard)});
}

/// One stay inside a hazard.
struct Stay {
  Instant deepest_at{};
  double deepest_m = 0.0;
  Instant left{};  ///< the first moment outside, or the track's last
};

/// The least clearance of the track outside what is excused, metres; negative inside.
Worst judge_track(const RunRecord& record, const Limits& limits, const Recording& recorded,
                  const TimedHazard& known, const Held& held, const std::optional<Excused>& excuse,
                  CheckResult& result) {
  ++result.judged;
  Worst nearest{.value = std::numeric_limits<double>::infinity(), .at = {}};
  Stay stay;
  bool leaving = false;  // it has not yet come out of what is excused
  const auto& track = recorded.track;
  for (std::size_t i = first_at(track, held.from); i < track.size(); ++i) {
    const VehicleState& s = track[i].state;
    const double clear = clearance_m(s, known.hazard);
    // Its autopilot knows of none.
    const Instant since = s.time - from_seconds(limits.taken_up_s);
    if (was_left_alone(record, recorded.vehicle, since, s.time)) continue;
    if (excuse && s.time == excuse->since) leaving = true;
    if (leaving) stay.left = s.time;
    if (clear >= 0.0) leaving = false;
    if (leaving && s.time <= excuse->until) {
      if (-clear > stay.deepest_m) stay = {s.time, -clear, s.time};
      continue;
    }
    nearest.lower(clear, s.time);
  }
  if (excuse) {
    result.excused.push_back({recorded.vehicle, excuse->since,
                              vehicle_name(recorded.vehicle) + " could not but be " +
                                  fixed(stay.deepest_m, 1) + " m inside " + into(known.hazard) +
                                  " " + at(stay.deepest_at) + ", which appeared " +
                                  at(known.known_from) + "; it was outside after " +
                                  fixed(to_seconds(stay.left - excuse->since), 2) + " s (limit " +
                                  fixed(to_seconds(excuse->until - excuse->since), 2) + " s)"});
  }
  if (nearest.value < 0.0) {
    result.violations.push_back(
        {recorded.vehicle, *nearest.at,
         vehicle_name(recorded.vehicle) + " flew " + at(*nearest.at) + " " +
             fixed(-nearest.value, 1) + " m inside " + into(known.hazard) +
             (excuse ? ", which it should have left " + at(excuse->until) : std::string{})});
  }
  return nearest;
}

}  // namespace

CheckResult check_hazards(const RunRecord& record, const Limits& limits) {
  CheckResult result{"hazards",
                     "no plan and no track enters a hazard from " +
                         fixed(limits.hazard_reaction_s, 1) +
                         " s after it is known; who cannot miss it leaves by the shortest way",
                     0,
                     "plans and tracks against hazards",
                     "",
                     {}};
  Worst least{.value = std::numeric_limits<double>::infinity(), .at = {}};
  for (const Recording& recorded : record.recordings) {
    const VehicleSpec* vehicle = spec_of(record, recorded.vehicle);
    for (const TimedHazard& known : record.hazards) {
      const auto from = held(record, recorded, known, limits);
      if (!from) continue;
      const auto excuse = excused(recorded, vehicle, known, *from, limits);
      for (std::size_t i = 0; i < recorded.plans.size(); ++i) {
        judge_plan(recorded, i, known, *from, excuse, result);
      }
      const Worst of_track = judge_track(record, limits, recorded, known, *from, excuse, result);
      if (of_track.at) least.lower(of_track.value, *of_track.at);
    }
  }
  if (least.at) result.measured = "least clearance flown " + fixed(least.value, 1) + " m";
  result.moment = least.at;
  if (!result.excused.empty()) {
    result.measured += "; " + std::to_string(result.excused.size()) + " could not be avoided";
  }
  return result;
}

std::optional<CheckResult> check_fence(const RunRecord& record) {
  if (!record.fence.exists()) return std::nullopt;
  CheckResult result{"fence", "nobody is outside of the fence", 0, "tracks", "", {}};
  Worst least_m{.value = std::numeric_limits<double>::infinity(), .at = {}};
  for (const Recording& recorded : record.recordings) {
    ++result.judged;
    const recording::TrackPoint* worst = nullptr;
    double deepest_m = 0.0;
    for (const auto& sample : recorded.track) {
      const VehicleState& s = sample.state;
      const double inside_m =
          std::min(record.fence.inside_m({s.x_m, s.y_m}), record.fence.height_max_m - s.z_m);
      least_m.lower(inside_m, s.time);
      if (inside_m >= deepest_m) continue;
      deepest_m = inside_m;
      worst = &sample;
    }
    if (worst == nullptr) continue;
    result.violations.push_back({recorded.vehicle, worst->state.time,
                                 vehicle_name(recorded.vehicle) + " was " + fixed(-deepest_m, 1) +
                                     " m outside of the fence " + at(worst->state.time)});
  }
  if (least_m.at) result.measured = "least distance to it " + fixed(least_m.value, 1) + " m";
  result.moment = least_m.at;
  return result;
}

}  // namespace skein::checks
