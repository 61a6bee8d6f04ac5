// SPDX-License-Identifier: Apache-2.0
#include "motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace skein::checks {
namespace {

// Direction of travel is taken over half a second, so that one noisy position does not decide.
constexpr double kBearingHalfSpan = 0.25;

// A piece of constant curvature by its chord: the chord of an arc turning by a points a/2 off the
// initial heading and is s sin(a/2)/(a/2) long.
Pose2 along_piece(const Pose2& from, double curvature_per_m, double s) {
  const double half = 0.5 * curvature_per_m * s;
  const double chord = std::abs(half) < 1e-9 ? s : s * std::sin(half) / half;
  const double direction = from.heading_rad + half;
  return {from.x_m + chord * std::cos(direction), from.y_m + chord * std::sin(direction),
          from.heading_rad + 2.0 * half};
}

// A plan of constant airspeed: what is flown where `even` would be in still air, by bisection. As
// far as it is on time, the airspeed is what the wind along the straight way leaves of the speed.
double distance_in_wind(const TimedPath& plan, double even) {
  const Vec2 wind = plan.wind_mps();
  const Vec2 downwind = wind.normalized();
  const auto share_of = [&](double airspeed) {
    return std::min(wind.norm() / airspeed, TimedPath::kWindShare);
  };
  const auto place = [&](double at) { return plan_pose(plan, at).position(); };
  const double timed_to = plan.paces.empty() ? plan.on_time_m : plan_length_m(plan);
  const Vec2 begin = place(0.0);
  const Vec2 free_from = place(timed_to);
  const Vec2 mean = timed_to > 0.0 ? Vec2{(free_from - begin) / timed_to} : Vec2{0.0, 0.0};
  const double timed_share =
      share_of(std::max(plan.speed_mps - wind.dot(mean), 0.5 * plan.speed_mps));
  const auto still_air = [&](double at) {
    if (at > timed_to) return at - share_of(plan.speed_mps) * downwind.dot(place(at) - free_from);
    return (at - timed_share * downwind.dot(place(at) - begin)) /
           (1.0 - timed_share * downwind.dot(mean));
  };
  double low = 0.0;
  double high = even / (1.0 - 2.0 * TimedPath::kWindShare);
  while (high - low > 1e-4) {
    const double middle = 0.5 * (low + high);
    (still_air(middle) < even ? low : high) = middle;
  }
  return low;
}

// At the speed of each segment, in still air.
double even_distance_m(const TimedPath& plan, Instant time) {
  double seconds = std::max(0.0, to_seconds(time - plan.start_time));
  double distance = 0.0;
  for (std::size_t i = 0; i < plan.paces.size(); ++i) {
    const double speed = plan.speed_mps * plan.paces[i];
    if (i >= plan.path.segments.size()) return distance + seconds * speed;
    const double takes = plan.path.segments[i].length_m / speed;
    if (seconds < takes) return distance + seconds * speed;
    seconds -= takes;
    distance += plan.path.segments[i].length_m;
  }
  return distance + seconds * plan.speed_mps;
}

template <class Items, class Key>
auto find_by_id(const Items& items, Key key) -> decltype(items.data()) {
  const auto it = std::find_if(items.begin(), items.end(), key);
  return it == items.end() ? nullptr : &*it;
}

}  // namespace

double plan_distance_m(const TimedPath& plan, Instant time) {
  const double even = even_distance_m(plan, time);
  const bool windward = plan.paces.empty() || even > plan_length_m(plan);
  return plan.has_wind() && windward ? distance_in_wind(plan, even) : even;
}

double plan_length_m(const TimedPath& plan) {
  double length = 0.0;
  for (const Segment& segment : plan.path.segments) length += segment.length_m;
  return length;
}

Pose2 plan_pose(const TimedPath& plan, double distance_m) {
  Pose2 pose = plan.path.start;
  double left = distance_m;
  for (const Segment& segment : plan.path.segments) {
    const double step = std::min(left, segment.length_m);
    pose = along_piece(pose, segment.curvature_per_m, step);
    left -= step;
    if (left <= 0.0) return pose;
  }
  return along_piece(pose, plan.tail_curvature_per_m, left);
}

void walk_plan(const TimedPath& plan, double from_m, double to_m, double step_m,
               const std::function<double(double, const Vec2&)>& see) {
  const auto steps = std::max(1.0, std::ceil((to_m - from_m) / step_m));
  Pose2 pose = plan.path.start;
  double begin = 0.0;
  std::size_t piece = 0;
  double i = 0.0;
  while (i <= steps) {
    const double distance = from_m + (to_m - from_m) * i / steps;
    const auto& segments = plan.path.segments;
    while (piece < segments.size() && distance > begin + segments[piece].length_m) {
      pose = along_piece(pose, segments[piece].curvature_per_m, segments[piece].length_m);
      begin += segments[piece].length_m;
      ++piece;
    }
    const double curvature =
        piece < segments.size() ? segments[piece].curvature_per_m : plan.tail_curvature_per_m;
    const double idle = see(distance, along_piece(pose, curvature, distance - begin).position());
    const double skipped =
        to_m > from_m ? std::floor(std::max(0.0, idle) * steps / (to_m - from_m)) : 0.0;
    i += 1.0 + skipped;
  }
}

std::size_t first_at(const std::vector<recording::TrackPoint>& track, Instant time) {
  const auto it = std::partition_point(track.begin(), track.end(),
                                       [&](const auto& p) { return p.state.time < time; });
  return static_cast<std::size_t>(it - track.begin());
}

const recording::PlanRecord* plan_in_force(const std::vector<recording::PlanRecord>& plans,
                                           Instant time) {
  const auto after = std::partition_point(
      plans.begin(), plans.end(),
      [time](const recording::PlanRecord& plan) { return plan.since <= time; });
  return after == plans.begin() ? nullptr : &*std::prev(after);
}

namespace {

/// Without its end for which that holds, where there is anything before it.
template <class Ended>
std::span<const recording::TrackPoint> before(const std::vector<recording::TrackPoint>& track,
                                              Ended ended) {
  std::size_t size = track.size();
  while (size > 0 && ended(track[size - 1].state)) --size;
  return size > 0 ? std::span{track}.first(size) : std::span{track};
}

}  // namespace

std::span<const recording::TrackPoint> flown_part(const std::vector<recording::TrackPoint>& track) {
  return before(track, [](const VehicleState& state) { return state.on_ground(); });
}

std::span<const recording::TrackPoint> planned_part(
    const std::vector<recording::TrackPoint>& track) {
  return before(track, [](const VehicleState& state) {
    return state.on_ground() || state.phase == FlightPhase::landing;
  });
}

std::optional<TrackPosition> track_at(const std::vector<recording::TrackPoint>& track, Instant time,
                                      double gap_s) {
  const std::size_t after = first_at(track, time);
  if (after == track.size()) return std::nullopt;
  const VehicleState& b = track[after].state;
  if (b.time == time) return TrackPosition{{b.x_m, b.y_m}, b.z_m, b.distance_flown_m};
  if (after == 0) return std::nullopt;
  const VehicleState& a = track[after - 1].state;
  const double span = to_seconds(b.time - a.time);
  if (span > gap_s) return std::nullopt;
  const double share = to_seconds(time - a.time) / span;
  const auto mix = [share](double from, double to) { return from + share * (to - from); };
  return TrackPosition{{mix(a.x_m, b.x_m), mix(a.y_m, b.y_m)},
                       mix(a.z_m, b.z_m),
                       mix(a.distance_flown_m, b.distance_flown_m)};
}

std::optional<Pass> nearest_pass(const std::vector<recording::TrackPoint>& track, const Vec2& point,
                                 Instant expected, const Limits& limits) {
  const auto position = [](const recording::TrackPoint& p) {
    return Vec2{p.state.x_m, p.state.y_m};
  };
  const Duration window = from_seconds(limits.delivery_window_s);
  std::optional<Pass> pass;
  for (std::size_t i = std::max<std::size_t>(first_at(track, expected - window), 1);
       i < track.size() && track[i].state.time <= expected + window; ++i) {
    const Vec2 a = position(track[i - 1]);
    const Vec2 step = position(track[i]) - a;
    const double length2 = step.squaredNorm();
    const double share =
        length2 > 0.0 ? std::clamp((point - a).dot(step) / length2, 0.0, 1.0) : 0.0;
    const double miss = (a + share * step - point).norm();
    if (pass && miss >= pass->miss_m) continue;
    const double between_s = to_seconds(track[i].state.time - track[i - 1].state.time);
    pass = Pass{track[i - 1].state.time + from_seconds(share * between_s), miss, 0.0};
  }
  if (!pass) return std::nullopt;
  const Duration half = from_seconds(kBearingHalfSpan);
  const auto before = track_at(track, pass->time - half, limits.track_gap_s);
  // The recording may end with the mission in that moment.
  const Instant until = std::min(pass->time + half, track.back().state.time);
  const auto after = track_at(track, until, limits.track_gap_s);
  if (!before || !after) return std::nullopt;
  const Vec2 travel = after->horizontal - before->horizontal;
  pass->heading_rad = std::atan2(travel.y(), travel.x());
  return pass;
}

const VehicleSpec* spec_of(const RunRecord& record, VehicleId vehicle) {
  return find_by_id(record.vehicles, [&](const VehicleSpec& v) { return v.id == vehicle; });
}
const Site* site_of(const RunRecord& record, SiteId site) {
  return find_by_id(record.sites, [&](const Site& s) { return s.id == site; });
}

std::string fixed(double value, int decimals) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
  return text.data();
}
std::string vehicle_name(VehicleId vehicle) {
  return vehicle == kGroundStation ? "the ground station"
                                   : "vehicle " + std::to_string(vehicle.value);
}
std::string at(Instant time) { return "at " + fixed(to_seconds(time), 2) + " s"; }

}  // namespace skein::checks
