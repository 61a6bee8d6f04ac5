// SPDX-License-Identifier: Apache-2.0
#include "skein/domain/path.hpp"

#include <algorithm>
#include <cmath>

namespace skein {

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

double TimedPath::distance_at(Instant t) const {
  // What would be flown at speed_mps.
  const double even_m = std::max(0.0, to_seconds(t - start_time) * speed_mps);
  if (paces.empty()) return even_m;
  double left_m = even_m;
  double flown_m = 0.0;
  for (std::size_t i = 0; i < path.segments.size(); ++i) {
    const double length_m = path.segments[i].length_m;
    const double there_m = left_m * pace(i);
    if (there_m < length_m) return flown_m + there_m;
    left_m -= length_m / pace(i);
    flown_m += length_m;
  }
  return flown_m + left_m * pace(path.segments.size());
}

Instant TimedPath::time_at(double distance_m) const {
  if (paces.empty()) return start_time + from_seconds(distance_m / speed_mps);
  double left_m = std::max(distance_m, 0.0);
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
  if (paces.empty()) return speed_mps;
  double left_m = std::max(distance_m, 0.0);
  std::size_t piece = 0;
  for (; piece < path.segments.size() && left_m >= path.segments[piece].length_m; ++piece) {
    left_m -= path.segments[piece].length_m;
  }
  return speed_mps * pace(piece);
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
