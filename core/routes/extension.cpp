// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include "skein/base/assert.hpp"
#include "skein/routes/fly_by.hpp"
#include "team_route.hpp"

namespace skein::routes {
namespace {

constexpr std::size_t kNumbers = 4;  ///< of one detour
constexpr std::size_t kDimension = 2 * kNumbers + 1;
/// The share of a leg that a detour takes: at least this; all of it from there on.
constexpr double kPartMin = 0.15;
constexpr double kWhole = 0.9;
/// Below this share of the missing length a detour is left out.
constexpr double kShareMin = 0.1;
/// How far from the end of the minor axis, of pi / 2.
constexpr double kLopsided = 0.6;
constexpr double kExact_m = 1e-8;
constexpr int kIterations = 25;

/// The ellipse with these foci whose every point is `around_m` from one and on to the other
/// (eq. 27, 28); its point at an angle from the major axis.
Vec2 ellipse_point(const Vec2& a, const Vec2& b, double around_m, double angle_rad) {
  const Vec2 d = b - a;
  const double apart = d.norm();
  const Vec2 along = d / apart;
  const double minor_sq = std::max(0.0, around_m * around_m - apart * apart);
  return 0.5 * (a + b) + 0.5 * around_m * std::cos(angle_rad) * along +
         0.5 * std::sqrt(minor_sq) * std::sin(angle_rad) * left_of(along);
}

}  // namespace

struct Extension::Detour {
  std::size_t leg = 0;
  double begin = 0.0;  ///< shares of the leg
  double end = 1.0;
  double angle_rad = 0.0;
  double extra_m = 0.0;
};

Box Extension::box() {
  Box box{std::vector<double>(kDimension, 0.0), std::vector<double>(kDimension, 1.0)};
  for (const std::size_t side : {std::size_t{3}, kNumbers + 3}) box.low[side] = -1.0;
  return box;
}

Extension::Detour Extension::detour(std::span<const double> numbers) const {
  // The last leg stays as it is.
  const std::vector<Vec2>& points = base_.waypoints;
  const std::size_t legs = points.size() - 2;
  double length = 0.0;
  for (std::size_t i = 0; i < legs; ++i) length += (points[i + 1] - points[i]).norm();
  double at = numbers[0] * length;
  Detour result;
  for (; result.leg + 1 < legs; ++result.leg) {
    const double leg = (points[result.leg + 1] - points[result.leg]).norm();
    if (at < leg) break;
    at -= leg;
  }
  const double part = kPartMin + (1.0 - kPartMin) * numbers[2];
  if (part < kWhole) {
    result.begin = numbers[1] * (1.0 - part);
    result.end = result.begin + part;
  }
  const double lopsided = (2.0 * std::abs(numbers[3]) - 1.0) * kLopsided;
  result.angle_rad = std::copysign(0.5 * kPi * (1.0 + lopsided), numbers[3]);
  return result;
}

void Extension::build(const Detour* first, const Detour* second, std::vector<Vec2>& waypoints,
                      std::vector<char>& fresh) const {
  waypoints.clear();
  fresh.clear();
  const auto add = [&](const Vec2& point, bool is_new) {
    waypoints.push_back(point);
    fresh.push_back(is_new ? 1 : 0);
  };
  const std::vector<Vec2>& points = base_.waypoints;
  for (std::size_t i = 0; i < points.size(); ++i) {
    add(points[i], false);
    for (const Detour* detour : {first, second}) {
      if (detour == nullptr || detour->leg != i) continue;
      const Vec2 leg = points[i + 1] - points[i];
      const Vec2 from = points[i] + detour->begin * leg;
      const Vec2 to = points[i] + detour->end * leg;
      if (detour->begin > 0.0) add(from, true);
      add(ellipse_point(from, to, (to - from).norm() + detour->extra_m, detour->angle_rad), true);
      if (detour->end < 1.0) add(to, true);
    }
  }
}

bool Extension::apply(std::span<const double> point, std::vector<Vec2>& waypoints,
                      std::vector<char>& fresh) const {
  SKEIN_ASSERT(point.size() == kDimension);
  const double missing = target_m_ - base_.length_m;
  if (missing < -kExact_m || base_.waypoints.size() < 3) return false;
  if (missing <= kExact_m) {
    build(nullptr, nullptr, waypoints, fresh);
    return true;
  }
  Detour first = detour(point.subspan(0, kNumbers));
  Detour second = detour(point.subspan(kNumbers, kNumbers));
  double share = point[2 * kNumbers];
  if (share < kShareMin) share = 0.0;
  if (share > 1.0 - kShareMin) share = 1.0;
  if (share > 0.0 && share < 1.0 && first.leg == second.leg) {
    first.begin *= 0.5;
    first.end *= 0.5;
    second.begin = 0.5 + 0.5 * second.begin;
    second.end = 0.5 + 0.5 * second.end;
  }
  if (second.leg < first.leg) {
    std::swap(first, second);
    share = 1.0 - share;
  }
  const Detour* const one = share > 0.0 ? &first : nullptr;
  const Detour* const two = share < 1.0 ? &second : nullptr;
  const auto length_with = [&](double extra_m) {
    first.extra_m = share * extra_m;
    second.extra_m = (1.0 - share) * extra_m;
    build(one, two, waypoints, fresh);
    return fly_by_length_m(waypoints, turn_radius_m_);
  };
  // The turns save some of what the detours add (eq. 32, 33): by the secant rule until it fits.
  double before = 0.0;
  double length_before = base_.length_m;
  double extra = missing;
  for (int k = 0; k < kIterations; ++k) {
    const double length = length_with(extra);
    const double error = target_m_ - length;
    if (std::abs(error) < kExact_m) return true;
    const double gain = (length - length_before) / (extra - before);
    before = extra;
    length_before = length;
    if (!(gain > 0.05)) return false;
    extra += error / gain;
    if (!(extra > 0.0) || extra > 20.0 * missing + 100.0 * turn_radius_m_) return false;
  }
  return false;
}

}  // namespace skein::routes
