// SPDX-License-Identifier: Apache-2.0
#include "skein/planning/circle_cover.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "skein/base/angles.hpp"
#include "skein/planning/area_search.hpp"

namespace skein::planning {
namespace {

constexpr double kSlack_m = 0.01;  ///< that rounding takes from a circle
constexpr double kWorth = 0.01;    ///< of the polygon, that another circle must save
constexpr int kSamples = 90;       ///< each way, of what circles shut out
constexpr std::size_t kDirectionsMax = 12;

bool holds(const Circle& circle, const Vec2& point) {
  return (point - circle.centre).norm() <= circle.radius_m + 1e-9;
}

Circle through(const Vec2& a, const Vec2& b) { return {0.5 * (a + b), 0.5 * (b - a).norm()}; }

/// None where they lie in a line.
std::optional<Circle> through(const Vec2& a, const Vec2& b, const Vec2& c) {
  const Vec2 ab = b - a;
  const Vec2 ac = c - a;
  const double twice = 2.0 * cross(ab, ac);
  if (std::abs(twice) < 1e-12) return std::nullopt;
  const Vec2 middle =
      (ab.squaredNorm() * Vec2{ac.y(), -ac.x()} + ac.squaredNorm() * Vec2{-ab.y(), ab.x()}) / twice;
  return Circle{a + middle, middle.norm()};
}

/// The smallest that holds all points: two or three of them lie on it.
Circle smallest_around(const std::vector<Vec2>& points) {
  Circle circle{points[0], 0.0};
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (holds(circle, points[i])) continue;
    circle = {points[i], 0.0};
    for (std::size_t j = 0; j < i; ++j) {
      if (holds(circle, points[j])) continue;
      circle = through(points[i], points[j]);
      for (std::size_t k = 0; k < j; ++k) {
        if (holds(circle, points[k])) continue;
        const auto three = through(points[i], points[j], points[k]);
        if (three) circle = *three;
      }
    }
  }
  return circle;
}

/// What of the outline lies on the side where `along` . p >= at. Of one with notches pieces may be
/// joined along the cut: their corners are all that counts here.
std::vector<Vec2> cut(const std::vector<Vec2>& outline, const Vec2& along, double at) {
  std::vector<Vec2> kept;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec2& a = outline[i];
    const Vec2& b = outline[(i + 1) % outline.size()];
    const double from = along.dot(a) - at;
    const double to = along.dot(b) - at;
    if (from >= 0.0) kept.push_back(a);
    if ((from < 0.0) != (to < 0.0)) kept.push_back(a + from / (from - to) * (b - a));
  }
  return kept;
}

std::vector<Circle> circles_of(const std::vector<Vec2>& outline, double direction_rad, int rows,
                               int columns) {
  const Vec2 along = unit_vector(direction_rad);
  const Vec2 aside = left_of(along);
  const auto span_of = [&outline](const Vec2& axis) {
    const auto [low, high] =
        std::ranges::minmax(outline, {}, [&axis](const Vec2& p) { return axis.dot(p); });
    return std::pair{axis.dot(low), axis.dot(high)};
  };
  const auto [low, high] = span_of(aside);
  std::vector<Circle> circles;
  for (int row = 0; row < rows; ++row) {
    const double from = low + (high - low) * row / rows;
    const double to = low + (high - low) * (row + 1) / rows;
    const auto strip = cut(cut(outline, aside, from), -aside, -to);
    if (strip.size() < 3) continue;
    const auto [west, east] =
        std::ranges::minmax(strip, {}, [&along](const Vec2& p) { return along.dot(p); });
    const double first = along.dot(west);
    const double last = along.dot(east);
    for (int column = 0; column < columns; ++column) {
      const double begin = first + (last - first) * column / columns;
      const double end = first + (last - first) * (column + 1) / columns;
      const auto piece = cut(cut(strip, along, begin), -along, -end);
      if (piece.size() < 3) continue;
      Circle circle = smallest_around(piece);
      circle.radius_m += kSlack_m;
      circles.push_back(circle);
    }
  }
  return circles;
}

double union_m2(const std::vector<Circle>& circles) {
  Vec2 low = circles[0].centre;
  Vec2 high = low;
  for (const Circle& circle : circles) {
    const Vec2 reach{circle.radius_m, circle.radius_m};
    low = low.cwiseMin(circle.centre - reach);
    high = high.cwiseMax(circle.centre + reach);
  }
  const Vec2 step = (high - low) / kSamples;
  int inside = 0;
  for (int i = 0; i < kSamples; ++i) {
    for (int k = 0; k < kSamples; ++k) {
      const Vec2 at = low + Vec2{(i + 0.5) * step.x(), (k + 0.5) * step.y()};
      if (std::ranges::any_of(circles, [&at](const Circle& c) { return holds(c, at); })) ++inside;
    }
  }
  return inside * step.x() * step.y();
}

}  // namespace

Result<CircleCover> cover_with_circles(std::span<const Vec2> corners) {
  if (auto why = why_no_area(corners)) return Error{*std::move(why)};
  const std::vector<Vec2> outline{corners.begin(), corners.end()};
  std::vector<double> directions;
  for (std::size_t i = 0; i < outline.size() && directions.size() < kDirectionsMax; ++i) {
    const Vec2 edge = outline[(i + 1) % outline.size()] - outline[i];
    directions.push_back(std::atan2(edge.y(), edge.x()));
  }
  CircleCover best;
  best.polygon_m2 = area_m2(outline);
  double least = std::numeric_limits<double>::infinity();
  for (const double direction : directions) {
    for (int rows = 1; rows <= 4; ++rows) {
      for (int columns = 1; columns <= static_cast<int>(kCoverCirclesMax); ++columns) {
        auto circles = circles_of(outline, direction, rows, columns);
        if (circles.empty() || circles.size() > kCoverCirclesMax) continue;
        const double shut_m2 = union_m2(circles);
        const double cost =
            shut_m2 + kWorth * best.polygon_m2 * static_cast<double>(circles.size());
        if (cost >= least) continue;
        least = cost;
        best.circles = std::move(circles);
        best.circles_m2 = shut_m2;
      }
    }
  }
  return best;
}

}  // namespace skein::planning
