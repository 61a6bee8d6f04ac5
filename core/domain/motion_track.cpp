// SPDX-License-Identifier: Apache-2.0
#include "skein/domain/motion_track.hpp"

#include "skein/base/assert.hpp"

namespace skein {
namespace {

Vec3 vector_of(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }

}  // namespace

MotionTrack MotionTrack::standing_at(const Vec3& place, Instant since) {
  MotionTrack track;
  track.start = since;
  track.count = 1;
  track.points.front().position_m = {place.x(), place.y(), place.z()};
  return track;
}

MotionTrack::Moment MotionTrack::at(Instant t) const {
  SKEIN_ASSERT(count > 0 && count <= kPointsMax);
  if (t < start) return {.position_m = vector_of(points[0].position_m)};
  const auto index = static_cast<std::uint64_t>((t - start) / kStep);
  if (index + 1 >= count) return {.position_m = vector_of(points.at(count - 1U).position_m)};
  const Point& from = points.at(index);
  const Point& to = points.at(index + 1);
  // Hermite's polynomial: both points with their velocities.
  const double h = to_seconds(kStep);
  const double s = to_seconds(t - start - kStep * static_cast<Duration::rep>(index)) / h;
  const Vec3 p = vector_of(from.position_m);
  const Vec3 way = vector_of(to.position_m) - p;
  const Vec3 v0 = h * vector_of(from.velocity_mps);
  const Vec3 v1 = h * vector_of(to.velocity_mps);
  const Vec3 square = 3.0 * way - 2.0 * v0 - v1;
  const Vec3 cube = v0 + v1 - 2.0 * way;
  return {p + s * (v0 + s * (square + s * cube)), (v0 + s * (2.0 * square + 3.0 * s * cube)) / h,
          (2.0 * square + 6.0 * s * cube) / (h * h)};
}

}  // namespace skein
