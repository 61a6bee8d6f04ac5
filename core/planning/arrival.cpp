// SPDX-License-Identifier: Apache-2.0
#include "skein/planning/arrival.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>

#include "skein/base/angles.hpp"
#include "skein/planning/dubins.hpp"

namespace skein::planning {
namespace {

constexpr double kExact = 1e-6;  ///< metres

/// A family of paths over one parameter; nothing where a member does not exist.
using Family = std::function<std::optional<Path>(double)>;

/// The member of the family with that length: the first change of side among samples, by bisection.
/// A jump of the length is found as well and thrown away.
std::optional<Path> member_of_length(const Family& family, double low, double high, int samples,
                                     double length, const std::function<bool(const Path&)>& good) {
  double before = low;
  auto at_before = family(before);
  for (int i = 1; i <= samples; ++i) {
    const double here = low + (high - low) * i / samples;
    auto at_here = family(here);
    if (at_before && at_here &&
        (at_before->length_m() - length) * (at_here->length_m() - length) <= 0.0) {
      double a = before;
      double b = here;
      const bool rising = at_here->length_m() >= at_before->length_m();
      std::optional<Path> middle;
      for (int k = 0; k < 60; ++k) {
        const double m = (a + b) / 2.0;
        middle = family(m);
        if (!middle || std::abs(middle->length_m() - length) < kExact / 10.0) break;
        ((middle->length_m() < length) == rising ? a : b) = m;
      }
      if (middle && std::abs(middle->length_m() - length) < kExact && good(*middle)) return middle;
    }
    before = here;
    at_before = std::move(at_here);
  }
  return std::nullopt;
}

std::optional<Path> with_loops(const Path& base, double radius, double extra,
                               const std::function<bool(const Path&)>& good) {
  const double loops = std::floor(extra / (kTwoPi * radius) + 1e-12);
  if (loops < 1.0) return std::nullopt;
  const double loop_radius = extra / (kTwoPi * loops);
  const double total = base.length_m();
  for (const double share : {0.0, 1.0, 0.5, 0.25, 0.75}) {
    for (const double sense : {1.0, -1.0}) {
      TimedPath timed;
      timed.path = base;
      const auto head = timed.piece(0.0, share * total);
      const auto tail = timed.piece(share * total, total);
      if (!head || !tail) continue;
      Path path = *head;
      if (path.append(Segment{sense / loop_radius, extra}) && path.append(*tail) && good(path))
        return path;
    }
  }
  return std::nullopt;
}

}  // namespace

Result<Path> path_of_length(const AvoidanceParams& params, const Transit& transit,
                            double length_m) {
  if (length_m > transit.length_max_m) return Error{"the path would be longer than the range left"};
  const auto base =
      shortest_clear_path(params, transit.from, transit.to, transit.radius_m, transit.hazards);
  if (!base) return base.error();
  const double extra = length_m - base->length_m();
  if (std::abs(extra) < kExact) return *base;
  if (extra < 0.0) {
    return Error{"the shortest path is " + std::to_string(-extra) +
                 " m too long to be there in time"};
  }
  const double r = transit.radius_m;
  const auto good = [&](const Path& p) { return is_clear(p, transit.hazards); };
  // Larger turn radii.
  for (std::size_t i = 0; i < static_cast<std::size_t>(DubinsWord::count); ++i) {
    const auto family = [&](double radius) -> std::optional<Path> {
      const auto word =
          dubins_word(static_cast<DubinsWord>(i), transit.from, transit.to, radius, radius);
      return word ? std::optional{word->to_path()} : std::nullopt;
    };
    if (const auto path = member_of_length(family, r, 5.0 * r, 24, length_m, good)) return *path;
  }
  // A detour by a point beside the path.
  for (const double share : {0.5, 0.3, 0.7, 0.15, 0.85}) {
    const Pose2 middle = base->pose_at(share * base->length_m());
    for (const double side : {1.0, -1.0}) {
      const auto family = [&](double offset) -> std::optional<Path> {
        const Vec2 point =
            middle.position() + side * offset * left_of(unit_vector(middle.heading_rad));
        const Pose2 via{point.x(), point.y(), middle.heading_rad};
        Path path = shortest_dubins(transit.from, via, r).to_path();
        return path.append(shortest_dubins(via, transit.to, r).to_path()) ? std::optional{path}
                                                                          : std::nullopt;
      };
      if (const auto path = member_of_length(family, 0.0, 6.0 * r, 24, length_m, good))
        return *path;
    }
  }
  if (const auto path = with_loops(*base, r, extra, good)) return *path;
  return Error{"no clear path is " + std::to_string(extra) + " m longer than the shortest"};
}

Result<double> least_length_from(const AvoidanceParams& params, const Transit& transit,
                                 double length_m) {
  const auto base =
      shortest_clear_path(params, transit.from, transit.to, transit.radius_m, transit.hazards);
  if (!base) return base.error();
  double length = std::max(length_m, base->length_m());
  const double step = kTwoPi * transit.radius_m / 16.0;
  for (; length <= transit.length_max_m; length += step) {
    if (path_of_length(params, transit, length)) return length;
  }
  return Error{"no path of that length or more is within the range left"};
}

}  // namespace skein::planning
