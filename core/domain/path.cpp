// SPDX-License-Identifier: Apache-2.0
#include "skein/domain/path.hpp"

#include <algorithm>
#include <cmath>

namespace skein {
namespace {

constexpr double kSettled_m = 1e-6;
constexpr int kStepsMax = 40;

}  // namespace

double Path::length_m() const {
  double sum = 0.0;
  for (const auto& s : segments) sum += s.length_m;
  return sum;
}

Pose2 Path::pose_at(double distance_m) const {
  double left = std::max(distance_m, 0.0);
  Pose2 pose = start;
  for (const auto& s : segments) {
    const double step = std::min(left, s.length_m);
    pose = advance(pose, s.curvature_per_m, step);
    left -= step;
    if (left <= 0.0) break;
  }
  return pose;
}

double Path::curvature_at(double distance_m) const {
  double left = std::max(distance_m, 0.0);
  for (const auto& s : segments) {
    if (left < s.length_m) return s.curvature_per_m;
    left -= s.length_m;
  }
  return segments.empty() ? 0.0 : segments.back().curvature_per_m;
}

double Path::curvature_max_per_m() const {
  double largest = 0.0;
  for (const auto& s : segments) {
    if (s.length_m > 0.0) largest = std::max(largest, std::abs(s.curvature_per_m));
  }
  return largest;
}

bool Path::append(const Segment& segment) {
  return segment.length_m <= 0.0 || segments.try_push_back(segment);
}

bool Path::append(const Path& next) {
  const auto pieces =
      static_cast<std::size_t>(std::count_if(next.segments.begin(), next.segments.end(),
                                             [](const Segment& s) { return s.length_m > 0.0; }));
  if (segments.size() + pieces > kPathSegmentsMax) return false;
  return std::all_of(next.segments.begin(), next.segments.end(),
                     [this](const Segment& s) { return append(s); });
}

bool TimedPath::append(const Segment& segment, double pace) {
  if (segment.length_m <= 0.0) return true;
  return path.append(segment) && paces.try_push_back(pace);
}

bool TimedPath::append(const Path& next, double pace) {
  return std::ranges::all_of(next.segments,
                             [this, pace](const Segment& s) { return append(s, pace); });
}

Vec2 TimedPath::wind_per_speed() const { return wind_per(speed_mps); }

Vec2 TimedPath::wind_per(double airspeed_mps) const {
  const Vec2 share = wind_mps() / airspeed_mps;
  return share * std::min(1.0, kWindShare / share.norm());
}

/// What its times count with there; with paces, beyond the path's end.
TimedPath::Airing TimedPath::airing(bool is_timed) const {
  if (!paces.empty()) return {path.end().position(), wind_per_speed(), speed_mps};
  if (!is_timed || on_time_m <= 0.0) {
    const double from_m = on_time_m > 0.0 ? on_time_m : 0.0;
    return {pose_at_distance(from_m).position(), wind_per_speed(), speed_mps};
  }
  const Vec2 from = path.start.position();
  const Vec2 straight = (pose_at_distance(on_time_m).position() - from) / on_time_m;
  const double with_mps = wind_mps().dot(straight);
  const double airspeed_mps = std::max(speed_mps - with_mps, kLeastShare * speed_mps);
  const Vec2 share = wind_per(airspeed_mps);
  return {from, share, speed_mps * (1.0 - share.dot(straight))};
}

/// How much less far it would be flown in still air in the time that the way to there takes.
double TimedPath::helped_m(const Airing& airing, double distance_m) const {
  return airing.wind_share.dot(pose_at_distance(distance_m).position() - airing.from_m);
}

/// Where it is when it would be there in still air. A contraction, by kWindShare at most.
double TimedPath::in_wind_m(const Airing& airing, double even_m) const {
  double distance_m = even_m;
  for (int step = 0; step < kStepsMax; ++step) {
    const double next_m = std::max(0.0, even_m + helped_m(airing, distance_m));
    const bool settled = std::abs(next_m - distance_m) < kSettled_m;
    distance_m = next_m;
    if (settled) break;
  }
  return distance_m;
}

double TimedPath::distance_at(Instant t) const {
  // What would be flown at speed_mps.
  const double even_m = std::max(0.0, to_seconds(t - start_time) * speed_mps);
  if (paces.empty()) {
    if (!has_wind()) return even_m;
    const Airing air = airing(even_m < on_time_m);
    return in_wind_m(air, even_m * air.even_mps / speed_mps);
  }
  double left_m = even_m;
  double flown_m = 0.0;
  for (std::size_t i = 0; i < path.segments.size(); ++i) {
    const double length_m = path.segments[i].length_m;
    const double there_m = left_m * pace(i);
    if (there_m < length_m) return flown_m + there_m;
    left_m -= length_m / pace(i);
    flown_m += length_m;
  }
  flown_m += left_m * pace(path.segments.size());
  return has_wind() ? in_wind_m(airing(false), flown_m) : flown_m;
}

Instant TimedPath::time_at(double distance_m) const {
  if (paces.empty()) {
    if (!has_wind()) return start_time + from_seconds(distance_m / speed_mps);
    const Airing air = airing(distance_m < on_time_m);
    return start_time + from_seconds((distance_m - helped_m(air, distance_m)) / air.even_mps);
  }
  const bool windward = has_wind() && distance_m > path.length_m();
  const double still_m = windward ? distance_m - helped_m(airing(false), distance_m) : distance_m;
  double left_m = std::max(still_m, 0.0);
  double even_m = 0.0;
  for (std::size_t i = 0; i < path.segments.size(); ++i) {
    const double length_m = std::min(left_m, path.segments[i].length_m);
    even_m += length_m / pace(i);
    left_m -= length_m;
    if (left_m <= 0.0) break;
  }
  even_m += left_m / pace(path.segments.size());
  return start_time + from_seconds(even_m / speed_mps);
}

double TimedPath::speed_at_distance(double distance_m) const {
  if (paces.empty() && !has_wind()) return speed_mps;
  double left_m = std::max(distance_m, 0.0);
  std::size_t piece = 0;
  for (; piece < path.segments.size() && left_m >= path.segments[piece].length_m; ++piece) {
    left_m -= path.segments[piece].length_m;
  }
  const double paced_mps = speed_mps * pace(piece);
  if (!has_wind() || (!paces.empty() && piece < path.segments.size())) return paced_mps;
  const Airing air = airing(distance_m < on_time_m);
  const Vec2 along = unit_vector(pose_at_distance(distance_m).heading_rad);
  return air.even_mps * pace(piece) / (1.0 - air.wind_share.dot(along));
}

Pose2 TimedPath::pose_at_distance(double distance_m) const {
  const double length = path.length_m();
  const Pose2 pose = path.pose_at(distance_m);
  return distance_m <= length ? pose : advance(pose, tail_curvature_per_m, distance_m - length);
}

double TimedPath::curvature_at_distance(double distance_m) const {
  return distance_m < path.length_m() ? path.curvature_at(distance_m) : tail_curvature_per_m;
}

Instant TimedPath::end_time() const { return time_at(path.length_m()); }

std::optional<Path> TimedPath::piece(double from_m, double to_m) const {
  Path cut;
  cut.start = pose_at_distance(from_m);
  double begin = 0.0;
  const auto add = [&](double curvature, double end) {
    const double length = std::min(to_m, end) - std::max(from_m, begin);
    begin = end;
    return length <= 0.0 || cut.append(Segment{curvature, length});
  };
  for (const auto& s : path.segments) {
    if (!add(s.curvature_per_m, begin + s.length_m)) return std::nullopt;
  }
  if (!add(tail_curvature_per_m, std::max(begin, to_m))) return std::nullopt;
  return cut;
}

}  // namespace skein
