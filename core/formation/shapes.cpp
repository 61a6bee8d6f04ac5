// SPDX-License-Identifier: Apache-2.0
#include "skein/formation/shapes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "skein/base/angles.hpp"
#include "skein/base/assert.hpp"
#include "skein/base/geometry.hpp"

namespace skein::formation {
namespace {

constexpr double kSpacingMax = 1000.0;
constexpr double kCoordinateMax = 1e6;
constexpr double kReachMax = 10'000.0;
constexpr double kFifth = kTwoPi / 5.0;

double real(std::size_t n) { return static_cast<double>(n); }

/// The i-th of 0, 1, -1, 2, -2, ...
double to_both_sides(std::size_t i) { return i % 2 == 1 ? real((i + 1) / 2) : -real(i / 2); }

/// Indices around a ring of `n`, from the first to both sides.
std::vector<std::size_t> ring_order(std::size_t n) {
  std::vector<std::size_t> order;
  order.reserve(n);
  for (std::size_t i = 0; i < n; ++i) order.push_back(i % 2 == 1 ? (i + 1) / 2 : (n - i / 2) % n);
  return order;
}

std::vector<Vec3> in_line(std::size_t n, const Vec3& step) {
  std::vector<Vec3> out;
  out.reserve(n);
  for (std::size_t i = 0; i < n; ++i) out.emplace_back(real(i) * step);
  return out;
}

std::vector<Vec3> line_abreast(std::size_t n, double spacing) {
  std::vector<Vec3> out;
  out.reserve(n);
  for (std::size_t i = 0; i < n; ++i) out.emplace_back(0.0, to_both_sides(i) * spacing, 0.0);
  return out;
}

/// Row r holds r + 1 vehicles, filled from its ends inwards: each flies [2 b, b pi / 4] behind one
/// or two of the row ahead.
std::vector<Vec3> wedge(std::size_t n, double b) {
  std::vector<Vec3> out;
  out.reserve(n);
  for (std::size_t row = 0; out.size() < n; ++row) {
    for (std::size_t i = 0; i <= row && out.size() < n; ++i) {
      const double aside = real(row) - 2.0 * real(i / 2);
      const double side = i % 2 == 0 ? 1.0 : -1.0;
      out.emplace_back(-2.0 * b * real(row), side * aside * b * kPi / 4.0, 0.0);
    }
  }
  return out;
}

/// Ring k is a regular pentagon of 5 k places whose corners lie k spacings from the centre: five
/// sectors of the lattice that two corners of the first ring span.
Vec3 pentagon_slot(std::size_t ring, std::size_t slot, double spacing) {
  const std::size_t side = slot / ring;
  const std::size_t along = slot % ring;
  const Vec2 from = unit_vector(kFifth * real(side));
  const Vec2 to = unit_vector(kFifth * real(side + 1));
  const Vec2 at = spacing * (real(ring - along) * from + real(along) * to);
  return {at.x(), at.y(), 0.0};
}

std::vector<Vec3> pentagon(std::size_t n, double spacing) {
  std::vector<Vec3> out;
  out.reserve(n);
  if (n == 1) return {Vec3::Zero()};
  if (n < 5) {
    for (const std::size_t i : ring_order(n)) {
      const Vec2 at = spacing * unit_vector(kTwoPi * real(i) / real(n));
      out.emplace_back(at.x(), at.y(), 0.0);
    }
    return out;
  }
  for (std::size_t ring = 1; out.size() < n; ++ring) {
    const std::size_t slots = 5 * ring;
    const std::size_t here = std::min(slots, n - out.size());
    for (const std::size_t i : ring_order(here)) {
      const std::size_t slot = (2 * i * slots + here) / (2 * here);  // i slots / here, rounded
      out.push_back(pentagon_slot(ring, slot % slots, spacing));
    }
  }
  return out;
}

/// `n` points at equal distances along the outline; one that is closed has one more piece.
std::vector<Vec3> along_outline(const std::vector<Vec3>& points, bool closed, std::size_t n) {
  std::vector<Vec3> corners = points;
  if (closed) corners.push_back(points.front());
  double length = 0.0;
  for (std::size_t i = 1; i < corners.size(); ++i) length += (corners[i] - corners[i - 1]).norm();
  const double step = n > 1 ? length / real(closed ? n : n - 1) : 0.0;

  std::vector<Vec3> out;
  out.reserve(n);
  std::size_t piece = 1;
  double before = 0.0;  // along the outline, to the start of the piece
  for (std::size_t i = 0; i < n; ++i) {
    const double wanted = std::min(step * real(i), length);
    double piece_length = (corners[piece] - corners[piece - 1]).norm();
    while (before + piece_length < wanted && piece + 1 < corners.size()) {
      before += piece_length;
      ++piece;
      piece_length = (corners[piece] - corners[piece - 1]).norm();
    }
    const double share = piece_length > 0.0 ? (wanted - before) / piece_length : 0.0;
    out.emplace_back(corners[piece - 1] +
                     std::min(share, 1.0) * (corners[piece] - corners[piece - 1]));
  }
  return out;
}

double least_distance(const std::vector<Vec3>& points) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      least = std::min(least, (points[i] - points[j]).squaredNorm());
    }
  }
  return std::sqrt(least);
}

Result<std::vector<Vec3>> free_shape(const ShapeSpec& shape, std::size_t n) {
  const std::vector<Vec3>& points = shape.points;
  if (points.empty() || points.size() > kPlacesMax) {
    return Error{"a free shape has 1 to " + std::to_string(kPlacesMax) + " points, not " +
                 std::to_string(points.size()) + "; mend its file"};
  }
  const bool good = std::all_of(points.begin(), points.end(), [](const Vec3& point) {
    return point.allFinite() && point.cwiseAbs().maxCoeff() <= kCoordinateMax;
  });
  if (!good) return Error{"a point of the free shape is beyond 1000 km; mend its file"};
  if (n == 1) return std::vector<Vec3>{Vec3::Zero()};
  if (points.size() == 1) {
    return Error{"a free shape of one point has room for one vehicle, not for " +
                 std::to_string(n) + "; give its file more points"};
  }

  const std::vector<Vec3> drawn =
      n == points.size() ? points : along_outline(points, shape.closed, n);
  Vec3 reach = Vec3::Zero();
  for (const Vec3& place : drawn) reach = reach.cwiseMax((place - drawn.front()).cwiseAbs());
  const double least = least_distance(drawn);
  // A little more than needed, so that rounding does not take it away again.
  const double scale = std::max(1.0, shape.spacing_m / least * (1.0 + 1e-12));
  if (!(scale * reach.norm() <= kReachMax)) {  // also where two coincide
    return Error{"the free shape brings two of " + std::to_string(n) +
                 " places so near to each other that it would have to be larger than 10 km to "
                 "keep the spacing; draw its lines farther apart, say that it is open if it does "
                 "not end where it begins, or fly it with fewer vehicles"};
  }
  std::vector<Vec3> out;
  out.reserve(n);
  if (shape.closed) {
    for (const std::size_t i : ring_order(n)) out.emplace_back(scale * drawn[i]);
  } else {
    for (const Vec3& place : drawn) out.emplace_back(scale * place);
  }
  return out;
}

Result<std::vector<Vec3>> offsets(const ShapeSpec& shape, std::size_t n) {
  const double s = shape.spacing_m;
  switch (shape.kind) {
    case ShapeKind::line_abreast:
      return line_abreast(n, s);
    case ShapeKind::column:
      return in_line(n, {-s, 0.0, 0.0});
    case ShapeKind::echelon:
      return in_line(n, Vec3{-1.0, -1.0, 0.0} * (s / std::numbers::sqrt2));
    case ShapeKind::wedge:
      return wedge(n, s);
    case ShapeKind::pentagon:
      return pentagon(n, s);
    case ShapeKind::free:
    case ShapeKind::count:
      break;
  }
  SKEIN_ASSERT(shape.kind == ShapeKind::free);
  return free_shape(shape, n);
}

}  // namespace

std::string_view to_string(ShapeKind kind) {
  static constexpr std::array<std::string_view, static_cast<std::size_t>(ShapeKind::count)> kNames{
      "line_abreast", "column", "echelon", "wedge", "pentagon", "free"};
  return kNames.at(static_cast<std::size_t>(kind));
}

Result<std::vector<Vec3>> places(const ShapeSpec& shape, std::size_t n) {
  if (n < 1 || n > kPlacesMax) {
    return Error{"a shape has places for 1 to " + std::to_string(kPlacesMax) +
                 " vehicles, not for " + std::to_string(n) + "; name as many"};
  }
  if (!(shape.spacing_m > 0.0 && shape.spacing_m <= kSpacingMax)) {
    return Error{"the spacing of a shape is above 0 m and at most 1000 m; choose one of these"};
  }
  if (!std::isfinite(shape.heading_rad) || !shape.centre.allFinite() ||
      shape.centre.cwiseAbs().maxCoeff() > kCoordinateMax) {
    return Error{"the heading or centre of the shape is no number, or beyond 1000 km; mend it"};
  }
  Result<std::vector<Vec3>> out = offsets(shape, n);
  if (!out) return out;

  Vec3 mean = Vec3::Zero();
  for (const Vec3& offset : *out) mean += offset / real(n);
  const Vec2 ahead = unit_vector(shape.heading_rad);
  const Vec2 left = left_of(ahead);
  for (Vec3& place : *out) {
    const Vec3 offset = place - mean;
    const Vec2 at = shape.centre.head<2>() + offset.x() * ahead + offset.y() * left;
    place = {at.x(), at.y(), shape.centre.z() + offset.z()};
  }
  return out;
}

}  // namespace skein::formation
