// SPDX-License-Identifier: Apache-2.0
#include "orca.hpp"

#include <algorithm>
#include <cmath>

#include "skein/base/shortened.hpp"

namespace skein::swap {
namespace {

constexpr double kParallel = 1e-9;

Vec2 unit_or(const Vec2& v, const Vec2& otherwise) {
  const double length = v.norm();
  return length > 1e-12 ? Vec2{v / length} : otherwise;
}

/// What a linear program looks for: the point nearest to a target, or farthest in a direction.
struct Aim {
  Vec2 vector;
  bool farthest = false;

  /// The best of from + t along, t in [low, high].
  [[nodiscard]] double on_line(const Vec2& from, const Vec2& along, double low, double high) const {
    if (farthest) return along.dot(vector) > 0.0 ? high : low;
    return std::clamp(along.dot(vector - from), low, high);
  }
  /// The best in the disc.
  [[nodiscard]] Vec2 in_disc(double radius) const {
    return farthest ? Vec2{radius * vector} : shortened(vector, radius);
  }
};

/// On the edge of planes[at], among the planes before it and in the disc. False where there is
/// none.
bool best_on_edge(std::span<const HalfPlane> planes, std::size_t at, double radius, const Aim& aim,
                  Vec2& best) {
  const HalfPlane& edge = planes[at];
  const Vec2 along = left_of(edge.normal);
  const double middle = -along.dot(edge.point);
  const double room = middle * middle + radius * radius - edge.point.squaredNorm();
  if (room < 0.0) return false;
  double low = middle - std::sqrt(room);
  double high = middle + std::sqrt(room);
  for (std::size_t i = 0; i < at; ++i) {
    const double slope = along.dot(planes[i].normal);
    const double depth = planes[i].depth(edge.point);  // of edge.point + t along: depth + t slope
    if (std::abs(slope) < kParallel) {
      if (depth < 0.0) return false;
      continue;
    }
    if (slope > 0.0) {
      low = std::max(low, -depth / slope);
    } else {
      high = std::min(high, -depth / slope);
    }
    if (low > high) return false;
  }
  best = edge.point + aim.on_line(edge.point, along, low, high) * along;
  return true;
}

/// The number of planes that could be kept to, from the first: all of them, or the one that failed.
std::size_t plan_2d(std::span<const HalfPlane> planes, double radius, const Aim& aim, Vec2& best) {
  best = aim.in_disc(radius);
  for (std::size_t i = 0; i < planes.size(); ++i) {
    if (planes[i].depth(best) >= 0.0) continue;
    const Vec2 before = best;
    if (!best_on_edge(planes, i, radius, aim, best)) {
      best = before;
      return i;
    }
  }
  return planes.size();
}

/// From the plane that failed on: the least depth below the worst plane (the third dimension).
/// Where plane i is the worst, the others are no deeper than it: half planes again.
Vec2 plan_3d(std::span<const HalfPlane> planes, std::size_t failed, double radius, Vec2 best) {
  double worst = 0.0;
  std::vector<HalfPlane> no_deeper;
  for (std::size_t i = failed; i < planes.size(); ++i) {
    if (planes[i].depth(best) >= -worst) continue;
    no_deeper.clear();
    for (std::size_t j = 0; j < i; ++j) {
      const Vec2 normal = planes[j].normal - planes[i].normal;
      const double length = normal.norm();
      if (length < kParallel) continue;  // the same direction: as deep wherever one is
      const double offset =
          planes[j].point.dot(planes[j].normal) - planes[i].point.dot(planes[i].normal);
      no_deeper.push_back({normal * (offset / (length * length)), normal / length});
    }
    Vec2 found;
    // It can only fail by rounding: what was found is then as good.
    if (plan_2d(no_deeper, radius, {planes[i].normal, true}, found) == no_deeper.size()) {
      best = found;
    }
    worst = -planes[i].depth(best);
  }
  return best;
}

}  // namespace

HalfPlane orca_half_plane(const OrcaParams& params, const OrcaBody& self, const OrcaBody& other) {
  const Vec2 apart = other.position_m - self.position_m;
  const Vec2 relative = self.velocity_mps - other.velocity_mps;
  const double distance = apart.norm();
  const double r = params.distance_m;
  const bool too_near = distance <= r;

  // The velocity obstacle: a cone from 0 around `apart`, cut off by the disc of radius r / tau.
  const double horizon = too_near ? params.period_s : params.horizon_s;
  const Vec2 from_disc = relative - apart / horizon;
  const double beyond = -from_disc.dot(apart);  // towards the apex
  Vec2 normal;
  double change = 0.0;  // |u|, signed: along the normal
  if (too_near || beyond > r * from_disc.norm()) {
    normal = unit_or(from_disc, unit_or(-apart, Vec2::UnitX()));
    change = r / horizon - from_disc.dot(normal);
  } else {
    const double leg = std::sqrt(distance * distance - r * r);
    const double side = cross(apart, relative) >= 0.0 ? 1.0 : -1.0;
    const Vec2 along = (leg * apart + side * r * left_of(apart)) / (distance * distance);
    normal = side * left_of(along);
    change = -relative.dot(normal);
  }
  return {self.velocity_mps + 0.5 * change * normal, normal};
}

Vec2 orca_velocity(std::span<const HalfPlane> planes, double speed_mps, const Vec2& preferred) {
  Vec2 best;
  const std::size_t kept = plan_2d(planes, speed_mps, {preferred}, best);
  return kept == planes.size() ? best : plan_3d(planes, kept, speed_mps, best);
}

}  // namespace skein::swap
