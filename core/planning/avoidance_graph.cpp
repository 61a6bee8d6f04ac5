// SPDX-License-Identifier: Apache-2.0
#include "avoidance_graph.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include "skein/base/angles.hpp"

namespace skein::planning {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kActiveMax = 16;    ///< circles that one path may have to go around
constexpr std::size_t kCirclesMax = 400;  ///< of a graph; beyond, special ones are left out
constexpr int kRelaxations = 40;          ///< of the points where small circles are touched
/// Where a small circle is tried first, from abeam of the line between the ends.
constexpr std::array<double, 8> kPasses_rad = {
    0.0, kPi / 4.0, -kPi / 4.0, kPi / 2.0, -kPi / 2.0, 3.0 * kPi / 4.0, -3.0 * kPi / 4.0, kPi};

constexpr std::size_t kAny = std::numeric_limits<std::size_t>::max();
/// By which rounding makes the square of a line between touching circles negative.
constexpr double kLineSlack_m2 = 1e-7;

/// A circle flown in one sense: +1 to the left, -1 to the right.
struct Circle {
  Vec2 centre{0.0, 0.0};
  double radius_m = 0.0;
  double sense = 1.0;
  const Hazard* inside = nullptr;  ///< the smaller circle that it goes around and touches
  std::size_t only_from = kAny;    ///< the one circle that it is joined from,
  std::size_t only_to = kAny;      ///< or left to

  [[nodiscard]] Vec2 point_at(double heading_rad) const {
    return centre - sense * radius_m * left_of(unit_vector(heading_rad));
  }
  [[nodiscard]] double turn(double from_rad, double to_rad) const {
    const double rad = wrap_two_pi(sense * (to_rad - from_rad));
    return kTwoPi - rad < 1e-12 ? 0.0 : rad;
  }
  [[nodiscard]] Segment arc(double from_rad, double to_rad) const {
    return {sense / radius_m, turn(from_rad, to_rad) * radius_m};
  }
  /// Moved so that it touches the smaller circle where it has this heading.
  void touch_at(double heading_rad) {
    centre =
        inside->centre + (radius_m - inside->radius_m) * sense * left_of(unit_vector(heading_rad));
  }
};

Circle turning_circle(const Pose2& pose, double radius_m, double sense) {
  return {pose.position() + sense * radius_m * left_of(unit_vector(pose.heading_rad)), radius_m,
          sense};
}

/// The points at given distances from two others.
std::vector<Vec2> meetings(const Vec2& a, double from_a_m, const Vec2& b, double from_b_m) {
  const Vec2 d = b - a;
  const double along =
      (d.squaredNorm() + from_a_m * from_a_m - from_b_m * from_b_m) / (2.0 * d.norm());
  const double across_sq = from_a_m * from_a_m - along * along;
  if (!(across_sq > 0.0)) return {};
  const Vec2 u = d.normalized();
  const Vec2 across = std::sqrt(across_sq) * left_of(u);
  return {a + along * u + across, a + along * u - across};
}

/// The line by which one circle is left and another joined; heading and length.
struct Tangent {
  double heading_rad = 0.0;
  double length_m = kInfinity;
};

std::optional<Tangent> tangent(const Circle& from, const Circle& to) {
  const Vec2 d = to.centre - from.centre;
  const double offset = to.sense * to.radius_m - from.sense * from.radius_m;
  const double line_sq = d.squaredNorm() - offset * offset;
  if (line_sq < -kLineSlack_m2 || d.squaredNorm() == 0.0) return std::nullopt;
  const double line = std::sqrt(std::max(line_sq, 0.0));
  return Tangent{std::atan2(d.y() * line - d.x() * offset, d.x() * line + d.y() * offset), line};
}

/// A state of the search is a circle and the one it was joined from, which fixes the heading.
class TangentGraph {
 public:
  TangentGraph(const Pose2& from, const Pose2& to, double radius_m, std::span<const Hazard> around)
      : from_{from}, to_{to}, around_{around} {
    circles_ = {turning_circle(from, radius_m, 1.0), turning_circle(from, radius_m, -1.0),
                turning_circle(to, radius_m, 1.0), turning_circle(to, radius_m, -1.0)};
    const Vec2 chord = to.position() - from.position();
    const double course = std::atan2(chord.y(), chord.x());
    for (const Hazard& circle : around) add_passes(circle, radius_m, course);
    for (const Hazard& circle : around) {
      for (std::size_t end = 0; end < kPasses; ++end) add_grazes(circle, end);
    }
    for (const Hazard& circle : around) add_close_passes(circle, radius_m);
    lines_.resize(count() * count());
    states_.resize(count() * count());
  }

  [[nodiscard]] std::optional<Path> shortest();

 private:
  static constexpr std::size_t kGoals = 2;   ///< circles 2 and 3 end at the goal
  static constexpr std::size_t kPasses = 4;  ///< from here on, around hazards

  struct State {
    double length_m = kInfinity;
    std::size_t before = 0;  ///< state
    bool done = false;
  };
  struct Line {
    bool known = false;
    bool clear = false;
    std::optional<Tangent> tangent;
  };
  using Chain = std::vector<Circle>;

  void add_passes(const Hazard& circle, double radius_m, double course_rad) {
    for (const double sense : {1.0, -1.0}) {
      if (circle.radius_m >= radius_m) {
        circles_.push_back({circle.centre, circle.radius_m, sense});
        continue;
      }
      Circle pass{circle.centre, radius_m, sense, &circle};
      for (const double shift : kPasses_rad) {
        pass.touch_at(course_rad + shift);
        circles_.push_back(pass);
      }
    }
  }

  /// Those that touch a second circle as well, from either side: between two circles there may be
  /// room for no other.
  void add_close_passes(const Hazard& circle, double radius_m) {
    if (circle.radius_m >= radius_m) return;
    for (const Hazard& other : around_) {
      if (&other == &circle || circles_.size() > kCirclesMax) continue;
      for (const double reach_m : {radius_m + other.radius_m, radius_m - other.radius_m}) {
        if (reach_m <= 0.0) continue;
        for (const Vec2& centre :
             meetings(circle.centre, radius_m - circle.radius_m, other.centre, reach_m)) {
          for (const double sense : {1.0, -1.0}) {
            circles_.push_back({centre, radius_m, sense, &circle});
          }
        }
      }
    }
  }

  /// The turn at an end goes over into the opposite turn, which grazes the circle, or goes around
  /// it where it is small.
  void add_grazes(const Hazard& circle, std::size_t end) {
    const Circle turning = circles_[end];
    const double radius_m = turning.radius_m;
    for (const double reach_m : {radius_m + circle.radius_m, radius_m - circle.radius_m}) {
      if (reach_m <= 0.0) continue;
      for (const Vec2& centre : meetings(turning.centre, 2.0 * radius_m, circle.centre, reach_m)) {
        Circle graze{centre, radius_m, -turning.sense};
        (end < kGoals ? graze.only_from : graze.only_to) = end;
        circles_.push_back(graze);
      }
    }
  }

  [[nodiscard]] bool clear(const Pose2& at, const Segment& piece) const {
    return std::all_of(around_.begin(), around_.end(),
                       [&](const Hazard& h) { return piece_is_clear(at, piece, h); });
  }
  [[nodiscard]] std::size_t count() const { return circles_.size(); }
  [[nodiscard]] static bool is_goal(std::size_t circle) {
    return circle >= kGoals && circle < kPasses;
  }
  [[nodiscard]] Line& line(std::size_t a, std::size_t b) {
    Line& result = lines_[a * count() + b];
    if (!std::exchange(result.known, true)) result.tangent = tangent(circles_[a], circles_[b]);
    return result;
  }
  /// Heading with which a state's circle is joined.
  [[nodiscard]] double entry_heading(std::size_t s) {
    const std::size_t circle = s / count();
    const std::size_t before = s % count();
    return circle == before ? from_.heading_rad : line(before, circle).tangent->heading_rad;
  }
  [[nodiscard]] bool arc_is_clear(const Circle& circle, double entry_rad,
                                  const Segment& arc) const {
    const Vec2 p = circle.point_at(entry_rad);
    return clear({p.x(), p.y(), entry_rad}, arc);
  }
  void expand(std::size_t s);
  void push(std::size_t s, double bound_m) { open_.emplace(bound_m, s); }
  [[nodiscard]] Chain chain_to(std::size_t last) const;
  [[nodiscard]] std::optional<Path> fly(const Chain& chain) const;
  [[nodiscard]] static Chain relaxed(Chain chain);

  Pose2 from_;
  Pose2 to_;
  std::span<const Hazard> around_;
  std::vector<Circle> circles_;
  std::vector<Line> lines_;
  std::vector<State> states_;
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open_;
  double best_m_ = kInfinity;
  std::size_t best_ = 0;
};

void TangentGraph::expand(std::size_t s) {
  const std::size_t circle = s / count();
  const double entry = entry_heading(s);
  const double so_far = states_[s].length_m;
  if (is_goal(circle)) {
    const Segment arc = circles_[circle].arc(entry, to_.heading_rad);
    if (so_far + arc.length_m < best_m_ && arc_is_clear(circles_[circle], entry, arc)) {
      best_m_ = so_far + arc.length_m;
      best_ = s;
    }
    return;
  }
  for (std::size_t next = kGoals; next < count(); ++next) {
    const std::size_t t = next * count() + circle;
    if (next == circle || states_[t].done) continue;
    if (circles_[next].only_from != kAny && circles_[next].only_from != circle) continue;
    if (circles_[circle].only_to != kAny && circles_[circle].only_to != next) continue;
    Line& way = line(circle, next);
    if (!way.tangent) continue;
    const Segment arc = circles_[circle].arc(entry, way.tangent->heading_rad);
    const double length = so_far + arc.length_m + way.tangent->length_m;
    if (length >= std::min(states_[t].length_m, best_m_)) continue;
    if (!way.clear) {
      const Vec2 p = circles_[circle].point_at(way.tangent->heading_rad);
      way.clear = clear({p.x(), p.y(), way.tangent->heading_rad}, {0.0, way.tangent->length_m});
      if (!way.clear) way.tangent.reset();
      if (!way.clear) continue;
    }
    if (!arc_is_clear(circles_[circle], entry, arc)) continue;
    states_[t].length_m = length;
    states_[t].before = s;
    const Vec2 joined = circles_[next].point_at(way.tangent->heading_rad);
    push(t, length + (to_.position() - joined).norm());
  }
}

TangentGraph::Chain TangentGraph::chain_to(std::size_t last) const {
  Chain chain;
  for (std::size_t s = last;; s = states_[s].before) {
    chain.push_back(circles_[s / count()]);
    if (states_[s].before == s) break;
  }
  std::reverse(chain.begin(), chain.end());
  return chain;
}

/// The path along the circles, where it is clear.
std::optional<Path> TangentGraph::fly(const Chain& chain) const {
  Path path{.start = from_, .segments = {}};
  double heading = from_.heading_rad;
  const auto turn_to = [&](const Circle& circle, double leave_rad) {
    const Segment arc = circle.arc(heading, leave_rad);
    return arc_is_clear(circle, heading, arc) && path.append(arc);
  };
  for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
    const auto next = tangent(chain[i], chain[i + 1]);
    if (!next || !turn_to(chain[i], next->heading_rad)) return std::nullopt;
    heading = next->heading_rad;
    const Vec2 p = chain[i].point_at(heading);
    const Segment line{0.0, next->length_m};
    if (!clear({p.x(), p.y(), heading}, line) || !path.append(line)) return std::nullopt;
  }
  if (!turn_to(chain.back(), to_.heading_rad)) return std::nullopt;
  return path;
}

/// A small circle is best touched halfway round the arc by which it is passed.
TangentGraph::Chain TangentGraph::relaxed(Chain chain) {
  for (int k = 0; k < kRelaxations; ++k) {
    Chain before = chain;
    double moved = 0.0;
    for (std::size_t i = 1; i + 1 < chain.size(); ++i) {
      if (chain[i].inside == nullptr) continue;
      const auto in = tangent(before[i - 1], before[i]);
      const auto out = tangent(before[i], before[i + 1]);
      if (!in || !out) return before;
      const double half = wrap_pi(out->heading_rad - in->heading_rad) / 2.0;
      chain[i].touch_at(in->heading_rad + half);
      moved = std::max(moved, (chain[i].centre - before[i].centre).norm());
    }
    if (moved < kTouch_m) break;
  }
  return chain;
}

std::optional<Path> TangentGraph::shortest() {
  const double chord = (to_.position() - from_.position()).norm();
  for (std::size_t start = 0; start < kGoals; ++start) {
    const std::size_t s = start * count() + start;
    states_[s] = {0.0, s, false};
    push(s, chord);
  }
  while (!open_.empty() && open_.top().first < best_m_) {
    const std::size_t s = open_.top().second;
    open_.pop();
    if (!std::exchange(states_[s].done, true)) expand(s);
  }
  if (best_m_ == kInfinity) return std::nullopt;
  const Chain chain = chain_to(best_);
  const auto path = fly(chain);
  const auto closer = fly(relaxed(chain));
  return closer && (!path || closer->length_m() < path->length_m()) ? closer : path;
}

}  // namespace

bool piece_is_clear(const Pose2& from, const Segment& piece, const Hazard& circle) {
  const double reach_m = circle.radius_m + piece.length_m;  // most pieces are nowhere near
  if ((circle.centre - from.position()).squaredNorm() > reach_m * reach_m) return true;
  return distance_to_piece(circle.centre, from, piece.curvature_per_m, piece.length_m) >=
         circle.radius_m - kTouch_m;
}

std::optional<Path> shortest_by_tangents(const Pose2& from, const Pose2& to, double radius_m,
                                         std::span<const Hazard> circles) {
  // Circles become part of the graph only once a path meets them: most never do. The shortest
  // path around some of them is the shortest around all where it is clear of all.
  std::vector<Hazard> around;
  std::vector<char> is_around(circles.size(), 0);
  while (around.size() <= kActiveMax) {
    const auto path = TangentGraph{from, to, radius_m, around}.shortest();
    if (!path) return std::nullopt;
    bool added = false;
    for (std::size_t i = 0; i < circles.size(); ++i) {
      if (is_around[i] != 0) continue;
      Pose2 pose = path->start;
      bool met = false;
      for (const Segment& piece : path->segments) {
        met = met || !piece_is_clear(pose, piece, circles[i]);
        pose = advance(pose, piece.curvature_per_m, piece.length_m);
      }
      if (!met) continue;
      is_around[i] = 1;
      around.push_back(circles[i]);
      added = true;
    }
    if (!added) return path;
  }
  return std::nullopt;
}

}  // namespace skein::planning
