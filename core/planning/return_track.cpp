// SPDX-License-Identifier: Apache-2.0
#include "return_track.hpp"

#include <algorithm>
#include <cmath>

#include "skein/base/assert.hpp"

namespace skein::planning {
namespace {

/// Keeps the steps from becoming endlessly small.
constexpr double kMargin_m = 1.0;
/// In a wind places are found to this, which the margin has room for.
constexpr double kSettled_m = 0.01;

double square(double x) { return x * x; }

double distance_at(const ReturnTrack& a, const ReturnTrack& b, double time_s) {
  const bool a_holds = time_s >= a.end_s();
  const bool b_holds = time_s >= b.end_s();
  if (a_holds && b_holds) return distance_m(a.ring(), b.ring());
  if (a_holds) return distance_m(a.ring(), b.position_at(time_s));
  if (b_holds) return distance_m(b.ring(), a.position_at(time_s));
  return (a.position_at(time_s) - b.position_at(time_s)).norm();
}

}  // namespace

double distance_m(const Ring& ring, const Vec2& point) {
  return std::abs((point - ring.centre).norm() - ring.radius_m);
}

double distance_m(const Ring& a, const Ring& b) {
  return std::max((a.centre - b.centre).norm() - a.radius_m - b.radius_m, 0.0);
}

Ring ring_of(const Pose2& at, double curvature_per_m) {
  SKEIN_ASSERT(curvature_per_m != 0.0);
  const Vec2 centre = at.position() + left_of(unit_vector(at.heading_rad)) / curvature_per_m;
  return {centre, 1.0 / std::abs(curvature_per_m)};
}

ReturnTrack::ReturnTrack(const TimedPath& timed, Instant epoch)
    : begin_s_{to_seconds(timed.start_time - epoch)},
      speed_mps_{timed.speed_mps},
      wind_share_{timed.wind_per_speed()} {
  SKEIN_ASSERT(timed.paces.empty() && timed.on_time_m == 0.0);
  Pose2 from = timed.path.start;
  for (const Segment& s : timed.path.segments) {
    const Vec2 forward = unit_vector(from.heading_rad);
    if (s.curvature_per_m == 0.0) {
      pieces_.push_back({length_m_, 0.0, from.position(), forward});
    } else {
      const Vec2 to_centre = left_of(forward) / s.curvature_per_m;
      pieces_.push_back({length_m_, s.curvature_per_m, from.position() + to_centre, -to_centre});
    }
    from = advance(from, s.curvature_per_m, s.length_m);
    length_m_ += s.length_m;
  }
  if (pieces_.empty())
    pieces_.push_back({0.0, 0.0, from.position(), unit_vector(from.heading_rad)});
  const double helped_m = wind_share_.dot(from.position() - timed.path.start.position());
  end_s_ = begin_s_ + (length_m_ - helped_m) / speed_mps_;
  ring_ = ring_of(from, timed.tail_curvature_per_m);
}

Vec2 ReturnTrack::position_at(double time_s) const {
  const double even_m = (time_s - begin_s_) * speed_mps_;
  Vec2 at = position_at_distance(even_m);
  if (wind_share_ == Vec2{0.0, 0.0}) return at;
  // As TimedPath::distance_at(): a contraction, by kWindShare.
  const Vec2 from = position_at_distance(0.0);
  double last_m = even_m;
  while (true) {
    const double next_m = even_m + wind_share_.dot(at - from);
    at = position_at_distance(next_m);
    if (std::abs(next_m - last_m) < kSettled_m) return at;
    last_m = next_m;
  }
}

Vec2 ReturnTrack::position_at_distance(double distance_m) const {
  const double at_m = std::clamp(distance_m, 0.0, length_m_);
  std::size_t i = 0;
  while (i + 1 < pieces_.size() && pieces_[i + 1].begin_m <= at_m) ++i;
  const Piece& piece = pieces_[i];
  const double along_m = at_m - piece.begin_m;
  if (piece.curvature_per_m == 0.0) return piece.origin + along_m * piece.vector;
  const Vec2 turned = unit_vector(piece.curvature_per_m * along_m);
  return {piece.origin.x() + piece.vector.dot(Vec2{turned.x(), -turned.y()}),
          piece.origin.y() + piece.vector.dot(Vec2{turned.y(), turned.x()})};
}

bool keeps_off(const Path& path, const Vec2& point, double apart_m) {
  Pose2 from = path.start;
  for (const Segment& s : path.segments) {
    const bool far = (from.position() - point).squaredNorm() >= square(apart_m + s.length_m);
    if (!far && distance_to_piece(point, from, s.curvature_per_m, s.length_m) < apart_m) {
      return false;
    }
    from = advance(from, s.curvature_per_m, s.length_m);
  }
  return true;
}

bool stay_apart(const ReturnTrack& a, const ReturnTrack& b, double apart_m) {
  const double closing_mps = a.speed_max_mps() + b.speed_max_mps();
  const double last_s = std::max(a.end_s(), b.end_s());
  double time_s = std::max(a.begin_s(), b.begin_s());
  while (time_s < last_s) {
    const double distance = distance_at(a, b, time_s);
    if (distance < apart_m + kMargin_m) return false;
    double next_s = time_s + (distance - apart_m) / closing_mps;
    // From its arrival on a vehicle is a ring, which is nearer than the vehicle was.
    for (const double end_s : {a.end_s(), b.end_s()}) {
      if (time_s < end_s) next_s = std::min(next_s, end_s);
    }
    time_s = next_s;
  }
  return distance_m(a.ring(), b.ring()) >= apart_m;
}

}  // namespace skein::planning
