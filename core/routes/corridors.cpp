// SPDX-License-Identifier: Apache-2.0
#include "skein/routes/corridors.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <queue>
#include <utility>

#include "skein/base/assert.hpp"

namespace skein::routes {
namespace {

constexpr double kTouch_m = 1e-7;
/// A turn so near to a full one is none, by rounding.
constexpr double kFullTurn_rad = 1e-9;
/// A taut route turns further around a disc only to come back.
constexpr double kTurnAroundDisc_rad = 1.25 * kPi;
/// Ways looked at before the search gives up finding more; reached only among crowds of discs.
constexpr std::size_t kWaysMax = 200'000;

constexpr std::size_t kStart = 0;  ///< the start itself: a circle of radius 0
constexpr std::size_t kNobody = static_cast<std::size_t>(-1);

struct Circle {
  Vec2 centre{0.0, 0.0};
  double radius_m = 0.0;
  double sense = 1.0;
  std::size_t disc = kNobody;
  enum class Role : std::uint8_t { around, start, goal } role = Role::around;
  double end_heading_rad = 0.0;  ///< where a turning circle begins (start) or ends (goal)

  [[nodiscard]] Vec2 point_at(double heading_rad) const {
    return centre - sense * radius_m * left_of(unit_vector(heading_rad));
  }
  [[nodiscard]] double turn(double from_rad, double to_rad) const {
    const double rad = wrap_two_pi(sense * (to_rad - from_rad));
    return kTwoPi - rad < kFullTurn_rad ? 0.0 : rad;
  }
};

/// The straight line from one circle to another: where it leaves and joins, if nothing is in its
/// way.
struct Line {
  bool known = false;
  bool open = false;
  double heading_rad = 0.0;
  double length_m = 0.0;
};

class Search {
 public:
  Search(const CorridorEnds& ends, std::span<const Disc> discs) : ends_{ends} {
    for (const Disc& disc : discs) {
      const bool holds_end = (disc.centre - ends.start).norm() < disc.radius_m - kTouch_m ||
                             (disc.centre - ends.goal).norm() < disc.radius_m - kTouch_m;
      if (!holds_end) discs_.push_back(disc);
    }
    add_ends();
    const double least_m = ends.turns_at_ends_only ? 0.0 : ends.turn_radius_m;
    for (std::size_t i = 0; i < discs_.size(); ++i) {
      for (const double sense : {1.0, -1.0}) {
        circles_.push_back({discs_[i].centre, std::max(discs_[i].radius_m, least_m), sense, i,
                            Circle::Role::around, 0.0});
      }
    }
    lines_.resize(circles_.size() * circles_.size());
    near_.resize(circles_.size());
    for (std::size_t c = 0; c < circles_.size(); ++c) {
      for (std::size_t i = 0; i < discs_.size(); ++i) {
        const double apart = (discs_[i].centre - circles_[c].centre).norm();
        if (i != circles_[c].disc && apart < circles_[c].radius_m + discs_[i].radius_m) {
          near_[c].push_back(i);
        }
      }
    }
  }

  [[nodiscard]] std::vector<Corridor> run(std::size_t count, double length_max_m);

 private:
  /// A state: on a circle, having come by a way.
  struct Way {
    std::size_t circle = 0;
    std::size_t before = kNobody;  ///< way
    double heading_rad = 0.0;      ///< where the circle is joined
    double length_m = 0.0;         ///< up to there
    bool complete = false;         ///< the length is that of the whole corridor
  };

  void add_ends() {
    circles_.push_back({ends_.start, 0.0, 1.0, kNobody, Circle::Role::start, 0.0});
    if (ends_.start_cone_rad < kPi) {
      for (const double sense : {1.0, -1.0}) {
        const double heading = ends_.start_heading_rad + sense * ends_.start_cone_rad;
        circles_.push_back(turning(ends_.start, heading, sense, Circle::Role::start));
      }
    }
    starts_ = circles_.size();
    if (!ends_.goal_heading_rad) {
      circles_.push_back({ends_.goal, 0.0, 1.0, kNobody, Circle::Role::goal, 0.0});
      return;
    }
    for (const double sense : {1.0, -1.0}) {
      circles_.push_back(turning(ends_.goal, *ends_.goal_heading_rad, sense, Circle::Role::goal));
    }
  }
  [[nodiscard]] Circle turning(const Vec2& at, double heading_rad, double sense,
                               Circle::Role role) const {
    return {at + sense * ends_.turn_radius_m * left_of(unit_vector(heading_rad)),
            ends_.turn_radius_m,
            sense,
            kNobody,
            role,
            heading_rad};
  }

  [[nodiscard]] const Line& line(std::size_t a, std::size_t b) {
    Line& line = lines_[a * circles_.size() + b];
    if (!std::exchange(line.known, true)) draw(circles_[a], circles_[b], line);
    return line;
  }
  void draw(const Circle& a, const Circle& b, Line& line) const {
    const Vec2 d = b.centre - a.centre;
    const double offset = b.sense * b.radius_m - a.sense * a.radius_m;
    const double length_sq = d.squaredNorm() - offset * offset;
    if (length_sq < 0.0 || d.squaredNorm() == 0.0) return;
    line.length_m = std::sqrt(length_sq);
    line.heading_rad =
        std::atan2(d.y() * line.length_m - d.x() * offset, d.x() * line.length_m + d.y() * offset);
    const Vec2 from = a.point_at(line.heading_rad);
    const Vec2 to = b.point_at(line.heading_rad);
    line.open = std::all_of(discs_.begin(), discs_.end(), [&](const Disc& disc) {
      return distance_to_segment(disc.centre, from, to) >= disc.radius_m - kTouch_m;
    });
  }
  [[nodiscard]] bool arc_is_open(std::size_t circle, double heading_rad, double turn_rad) const {
    const Circle& c = circles_[circle];
    const Vec2 p = c.point_at(heading_rad);
    return std::all_of(near_[circle].begin(), near_[circle].end(), [&](std::size_t i) {
      if (c.radius_m == 0.0) return true;
      return distance_to_piece(discs_[i].centre, {p.x(), p.y(), heading_rad}, c.sense / c.radius_m,
                               c.radius_m * turn_rad) >= discs_[i].radius_m - kTouch_m;
    });
  }
  [[nodiscard]] bool visited(std::size_t way, std::size_t circle) const {
    for (std::size_t w = way; w != kNobody; w = ways_[w].before) {
      const std::size_t c = ways_[w].circle;
      if (c == circle || (circles_[c].disc != kNobody && circles_[c].disc == circles_[circle].disc))
        return true;
    }
    return false;
  }
  void push(const Way& way, double bound_m) {
    if (ways_.size() >= kWaysMax) return;
    ways_.push_back(way);
    open_.emplace(bound_m, ways_.size() - 1);
  }
  void expand(std::size_t w, double length_max_m);
  [[nodiscard]] Corridor corridor(std::size_t last);

  CorridorEnds ends_;
  std::vector<Disc> discs_;
  std::vector<Circle> circles_;
  std::size_t starts_ = 0;  ///< circles at the start
  std::vector<Line> lines_;
  std::vector<std::vector<std::size_t>> near_;  ///< discs that overlap a circle
  std::vector<Way> ways_;
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open_;
};

void Search::expand(std::size_t w, double length_max_m) {
  const Way way = ways_[w];
  const Circle& here = circles_[way.circle];
  if (here.role == Circle::Role::goal) {
    const double turn =
        ends_.goal_heading_rad ? here.turn(way.heading_rad, here.end_heading_rad) : 0.0;
    if (!arc_is_open(way.circle, way.heading_rad, turn)) return;
    const double length = way.length_m + here.radius_m * turn;
    if (length <= length_max_m) push({way.circle, w, here.end_heading_rad, length, true}, length);
    return;
  }
  for (std::size_t next = starts_; next < circles_.size(); ++next) {
    if (visited(w, next)) continue;
    const Line& out = line(way.circle, next);
    if (!out.open) continue;
    double turn = 0.0;
    if (way.circle == kStart) {
      const double off = std::abs(wrap_pi(out.heading_rad - ends_.start_heading_rad));
      if (ends_.start_cone_rad < kPi && off > ends_.start_cone_rad) continue;
    } else {
      turn = here.turn(way.heading_rad, out.heading_rad);
      if (here.role == Circle::Role::around && turn > kTurnAroundDisc_rad) continue;
      if (!arc_is_open(way.circle, way.heading_rad, turn)) continue;
    }
    const double length = way.length_m + here.radius_m * turn + out.length_m;
    const double bound = length + (ends_.goal - circles_[next].point_at(out.heading_rad)).norm();
    if (bound <= length_max_m) push({next, w, out.heading_rad, length, false}, bound);
  }
}

Corridor Search::corridor(std::size_t last) {
  Corridor result{.length_m = ways_[last].length_m, .bends = {}};
  std::vector<std::size_t> chain;
  for (std::size_t w = last; w != kNobody; w = ways_[w].before) chain.push_back(w);
  std::reverse(chain.begin(), chain.end());
  for (std::size_t k = 0; k + 1 < chain.size(); ++k) {
    const Way& way = ways_[chain[k]];
    const Circle& circle = circles_[way.circle];
    // The last way is the goal's circle again, at its end.
    const double turn = circle.turn(way.heading_rad, ways_[chain[k + 1]].heading_rad);
    if (circle.radius_m == 0.0 || turn == 0.0) continue;
    result.bends.push_back({circle.centre, circle.radius_m, circle.sense, way.heading_rad, turn});
  }
  return result;
}

std::vector<Corridor> Search::run(std::size_t count, double length_max_m) {
  std::vector<Corridor> found;
  const double straight = (ends_.goal - ends_.start).norm();
  for (std::size_t c = 0; c < starts_; ++c) {
    push({c, kNobody, circles_[c].end_heading_rad, 0.0, false}, straight);
  }
  while (!open_.empty() && found.size() < count) {
    const std::size_t w = open_.top().second;
    open_.pop();
    if (ways_[w].complete) {
      found.push_back(corridor(w));
    } else {
      expand(w, length_max_m);
    }
  }
  return found;
}

}  // namespace

std::vector<Corridor> shortest_corridors(const CorridorEnds& ends, std::span<const Disc> discs,
                                         std::size_t count, double length_max_m) {
  return Search{ends, discs}.run(count, length_max_m);
}

std::vector<Vec2> corners_of(const Corridor& corridor, double corner_max_rad) {
  SKEIN_ASSERT(corner_max_rad > 0.0 && corner_max_rad < kPi);
  std::vector<Vec2> corners;
  for (const Bend& bend : corridor.bends) {
    const auto count =
        static_cast<std::size_t>(std::max(1.0, std::ceil(bend.turn_rad / corner_max_rad - 1e-9)));
    const double corner = bend.turn_rad / static_cast<double>(count);
    const double out_m = bend.radius_m / std::cos(0.5 * corner);
    for (std::size_t k = 0; k < count; ++k) {
      const double heading =
          bend.heading_rad + bend.sense * (static_cast<double>(k) + 0.5) * corner;
      corners.emplace_back(bend.centre - bend.sense * out_m * left_of(unit_vector(heading)));
    }
  }
  return corners;
}

}  // namespace skein::routes
