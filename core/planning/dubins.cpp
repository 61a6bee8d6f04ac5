// SPDX-License-Identifier: Apache-2.0
#include "skein/planning/dubins.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "skein/base/angles.hpp"
#include "skein/base/assert.hpp"

namespace skein::planning {
namespace {

constexpr std::size_t kWords = static_cast<std::size_t>(DubinsWord::count);

/// Senses of the first and last arc (+1 left), and whether the middle is a line.
struct Shape {
  double first;
  double last;
  bool straight;
};
Shape shape_of(DubinsWord word) {
  switch (word) {
    case DubinsWord::LSL:
      return {1, 1, true};
    case DubinsWord::LSR:
      return {1, -1, true};
    case DubinsWord::RSL:
      return {-1, 1, true};
    case DubinsWord::RSR:
      return {-1, -1, true};
    case DubinsWord::RLR:
      return {-1, -1, false};
    case DubinsWord::LRL:
      return {1, 1, false};
    case DubinsWord::count:
      break;
  }
  SKEIN_ASSERT(false);
  return {};
}

/// The angle turned from one heading to another in one sense, in [0, 2 pi). Rounding must not make
/// a whole turn of none.
double turn(double sense, double from_rad, double to_rad) {
  const double angle = wrap_two_pi(sense * (to_rad - from_rad));
  return angle > kTwoPi - 1e-9 ? 0.0 : angle;
}

Vec2 centre(const Pose2& pose, double sense, double radius) {
  return pose.position() + sense * radius * left_of(unit_vector(pose.heading_rad));
}

/// The heading at a point of a circle that is flown in the given sense.
double heading_on(const Vec2& circle_centre, const Vec2& point, double sense) {
  const Vec2 spoke = point - circle_centre;
  const Vec2 along = sense * left_of(spoke);
  return std::atan2(along.y(), along.x());
}

std::optional<DubinsPath> line_word(DubinsWord word, const Shape& shape, const Pose2& from,
                                    const Pose2& to, double r1, double r2) {
  // Between the circles' centres: D = s u + (last r2 - first r1) left(u), u along the line.
  const Vec2 between = centre(to, shape.last, r2) - centre(from, shape.first, r1);
  const double across = shape.last * r2 - shape.first * r1;
  const double squared = between.squaredNorm() - across * across;
  if (squared < 0.0) return std::nullopt;
  const double line = std::sqrt(squared);
  // One circle for both arcs: the line has no direction, and the first arc goes all the way.
  const double heading = between.norm() < 1e-9
                             ? to.heading_rad
                             : std::atan2(between.y(), between.x()) - std::atan2(across, line);
  return DubinsPath{word,
                    from,
                    r1,
                    r2,
                    {turn(shape.first, from.heading_rad, heading) * r1, line,
                     turn(shape.last, heading, to.heading_rad) * r2}};
}

std::optional<DubinsPath> arc_word(DubinsWord word, const Shape& shape, const Pose2& from,
                                   const Pose2& to, double r) {
  const Vec2 c1 = centre(from, shape.first, r);
  const Vec2 c2 = centre(to, shape.last, r);
  const Vec2 between = c2 - c1;
  const double d = between.norm();
  if (d > 4.0 * r || d < 1e-12) return std::nullopt;
  const double height = std::sqrt(std::max(0.0, 4.0 * r * r - d * d / 4.0));
  std::optional<DubinsPath> best;
  for (const double side : {1.0, -1.0}) {
    const Vec2 middle = c1 + between / 2.0 + side * height * left_of(between / d);
    const double h1 = heading_on(c1, (c1 + middle) / 2.0, shape.first);
    const double h2 = heading_on(c2, (middle + c2) / 2.0, shape.last);
    const DubinsPath path{
        word,
        from,
        r,
        r,
        {turn(shape.first, from.heading_rad, h1) * r, turn(-shape.first, h1, h2) * r,
         turn(shape.last, h2, to.heading_rad) * r}};
    if (!best || path.length_m() < best->length_m()) best = path;
  }
  return best;
}

Path two_pieces(const Pose2& from, const Segment& a, const Segment& b) {
  Path path;
  path.start = from;
  const bool fits = path.append(a) && path.append(b);
  SKEIN_ASSERT(fits);
  return path;
}

}  // namespace

std::string_view to_string(DubinsWord word) {
  static constexpr std::array<std::string_view, kWords> kNames{"LSL", "LSR", "RSL",
                                                               "RSR", "RLR", "LRL"};
  return kNames.at(static_cast<std::size_t>(word));
}

Path DubinsPath::to_path() const {
  const Shape shape = shape_of(word);
  const double middle = shape.straight ? 0.0 : -shape.first / start_radius_m;
  Path path;
  path.start = start;
  const bool fits = path.append(Segment{shape.first / start_radius_m, lengths_m[0]}) &&
                    path.append(Segment{middle, lengths_m[1]}) &&
                    path.append(Segment{shape.last / end_radius_m, lengths_m[2]});
  SKEIN_ASSERT(fits);
  return path;
}

std::optional<DubinsPath> dubins_word(DubinsWord word, const Pose2& from, const Pose2& to,
                                      double start_radius_m, double end_radius_m) {
  SKEIN_ASSERT(start_radius_m > 0.0 && end_radius_m > 0.0);
  const Shape shape = shape_of(word);
  if (shape.straight) return line_word(word, shape, from, to, start_radius_m, end_radius_m);
  SKEIN_ASSERT(start_radius_m == end_radius_m);
  return arc_word(word, shape, from, to, start_radius_m);
}

DubinsPath shortest_dubins(const Pose2& from, const Pose2& to, double radius_m) {
  std::optional<DubinsPath> best;
  for (std::size_t i = 0; i < kWords; ++i) {
    const auto path = dubins_word(static_cast<DubinsWord>(i), from, to, radius_m, radius_m);
    if (path && (!best || path->length_m() < best->length_m())) best = path;
  }
  SKEIN_ASSERT(best.has_value());  // LSL and RSR join any two poses
  return *best;
}

double shortest_dubins_length(const Pose2& from, const Pose2& to, double radius_m) {
  return shortest_dubins(from, to, radius_m).length_m();
}

std::optional<DubinsPath> shortest_dubins(const Pose2& from, const Pose2& to, double start_radius_m,
                                          double end_radius_m) {
  std::optional<DubinsPath> best;
  for (const DubinsWord word :
       {DubinsWord::LSL, DubinsWord::LSR, DubinsWord::RSL, DubinsWord::RSR}) {
    const auto path = dubins_word(word, from, to, start_radius_m, end_radius_m);
    if (path && (!best || path->length_m() < best->length_m())) best = path;
  }
  return best;
}

Path shortest_to_point(const Pose2& from, const Vec2& to, double radius_m) {
  SKEIN_ASSERT(radius_m > 0.0);
  std::optional<Path> best;
  const auto offer = [&best](const Path& path) {
    if (!best || path.length_m() < best->length_m()) best = path;
  };
  for (const double sense : {1.0, -1.0}) {
    const Vec2 c = centre(from, sense, radius_m);
    const Vec2 d = to - c;
    if (d.norm() >= radius_m) {  // an arc, then the tangent to the point
      const double line = std::sqrt(std::max(0.0, d.squaredNorm() - radius_m * radius_m));
      const double heading = std::atan2(d.y(), d.x()) - std::atan2(-sense * radius_m, line);
      offer(two_pieces(from, {sense / radius_m, turn(sense, from.heading_rad, heading) * radius_m},
                       {0.0, line}));
      continue;
    }
    // Inside the circle: away from it first, and back on an arc of the same sense.
    const Vec2 away = centre(from, -sense, radius_m);
    const Vec2 between = to - away;
    const double distance = between.norm();
    const double along = (distance * distance + 3.0 * radius_m * radius_m) / (2.0 * distance);
    const double height = std::sqrt(std::max(0.0, 4.0 * radius_m * radius_m - along * along));
    for (const double side : {1.0, -1.0}) {
      const Vec2 second =
          away + along * between / distance + side * height * left_of(between / distance);
      const double h1 = heading_on(away, (away + second) / 2.0, -sense);
      const double h2 = heading_on(second, to, sense);
      offer(two_pieces(from, {-sense / radius_m, turn(-sense, from.heading_rad, h1) * radius_m},
                       {sense / radius_m, turn(sense, h1, h2) * radius_m}));
    }
  }
  return *best;
}

}  // namespace skein::planning
