// SPDX-License-Identifier: Apache-2.0
#include "skein/planning/avoidance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <queue>
#include <string>
#include <utility>
#include <vector>

#include "skein/base/angles.hpp"
#include "skein/base/assert.hpp"
#include "skein/planning/dubins.hpp"

namespace skein::planning {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kTouch_m = 1e-7;         ///< a path that touches a hazard is outside
constexpr double kEndSlack_m = 1e-7;      ///< what the search's end may miss the goal by
constexpr std::size_t kActiveMax = 16;    ///< hazards that one path may have to go around
constexpr double kPassAngle = kPi / 4.0;  ///< between the points where a small hazard is passed

bool piece_is_clear(const Pose2& from, const Segment& piece, const Hazard& hazard) {
  return distance_to_piece(hazard.centre, from, piece.curvature_per_m, piece.length_m) >=
         hazard.radius_m - kTouch_m;
}

/// A circle flown in one sense: +1 to the left, -1 to the right.
struct Circle {
  Vec2 centre{0.0, 0.0};
  double radius_m = 0.0;
  double sense = 1.0;

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
};

Circle turning_circle(const Pose2& pose, double radius_m, double sense) {
  return {pose.position() + sense * radius_m * left_of(unit_vector(pose.heading_rad)), radius_m,
          sense};
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
  if (line_sq < 0.0 || d.squaredNorm() == 0.0) return std::nullopt;
  const double line = std::sqrt(line_sq);
  return Tangent{std::atan2(d.y() * line - d.x() * offset, d.x() * line + d.y() * offset), line};
}

/// The shortest chain of arcs and lines over the circles by which hazards are passed: Dijkstra on
/// the tangent graph. A state is a circle and the one it was joined from, which fixes the heading.
class TangentGraph {
 public:
  TangentGraph(const AvoidanceParams& params, const Pose2& from, const Pose2& to, double radius_m,
               std::span<const Hazard> hazards)
      : from_{from}, to_{to}, hazards_{hazards} {
    circles_ = {turning_circle(from, radius_m, 1.0), turning_circle(from, radius_m, -1.0),
                turning_circle(to, radius_m, 1.0), turning_circle(to, radius_m, -1.0)};
    const Vec2 chord = to.position() - from.position();
    for (const Hazard& hazard : hazards) add_passes(hazard, params.kappa, radius_m, chord);
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

  void add_passes(const Hazard& hazard, double kappa, double radius_m, const Vec2& chord) {
    const double safety_m = kappa * hazard.radius_m;
    for (const double sense : {1.0, -1.0}) {
      if (safety_m >= radius_m) {
        circles_.push_back({hazard.centre, safety_m, sense});
        continue;
      }
      // Too small to fly around: a circle of the turn radius that touches the safety circle from
      // outside at the point of passage.
      const double abeam = std::atan2(chord.y(), chord.x()) - sense * kPi / 2.0;
      for (const double shift : {0.0, kPassAngle, -kPassAngle}) {
        circles_.push_back(
            {hazard.centre - (radius_m - safety_m) * unit_vector(abeam + shift), radius_m, sense});
      }
    }
  }

  [[nodiscard]] bool clear(const Pose2& at, const Segment& piece) const {
    return std::all_of(hazards_.begin(), hazards_.end(),
                       [&](const Hazard& h) { return piece_is_clear(at, piece, h); });
  }
  [[nodiscard]] std::size_t count() const { return circles_.size(); }
  [[nodiscard]] std::size_t state(std::size_t circle, std::size_t before) const {
    return circle * count() + before;
  }
  [[nodiscard]] const std::optional<Tangent>& line(std::size_t a, std::size_t b) const {
    return lines_[a * count() + b];
  }
  /// Heading with which a state's circle is joined.
  [[nodiscard]] double entry_heading(std::size_t s) const {
    const std::size_t circle = s / count();
    const std::size_t before = s % count();
    return circle == before ? from_.heading_rad : line(before, circle)->heading_rad;
  }
  [[nodiscard]] bool arc_is_clear(const Circle& circle, double entry_rad,
                                  const Segment& arc) const {
    const Vec2 p = circle.point_at(entry_rad);
    return clear({p.x(), p.y(), entry_rad}, arc);
  }
  void find_lines();
  [[nodiscard]] Path trace(const std::vector<State>& states, std::size_t last) const;

  Pose2 from_;
  Pose2 to_;
  std::span<const Hazard> hazards_;
  std::vector<Circle> circles_;
  std::vector<std::optional<Tangent>> lines_;
};

void TangentGraph::find_lines() {
  lines_.assign(count() * count(), std::nullopt);
  for (std::size_t a = 0; a < count(); ++a) {
    if (a >= kGoals && a < kPasses) continue;
    for (std::size_t b = kGoals; b < count(); ++b) {
      if (a == b) continue;
      const auto joined = tangent(circles_[a], circles_[b]);
      if (!joined) continue;
      const Vec2 p = circles_[a].point_at(joined->heading_rad);
      if (clear({p.x(), p.y(), joined->heading_rad}, {0.0, joined->length_m})) {
        lines_[a * count() + b] = joined;
      }
    }
  }
}

Path TangentGraph::trace(const std::vector<State>& states, std::size_t last) const {
  std::vector<std::size_t> chain{last};
  while (states[chain.back()].before != chain.back()) chain.push_back(states[chain.back()].before);
  std::reverse(chain.begin(), chain.end());
  Path path{.start = from_, .segments = {}};
  bool fits = true;
  for (std::size_t i = 0; i < chain.size(); ++i) {
    const Circle& circle = circles_[chain[i] / count()];
    const double entry = entry_heading(chain[i]);
    const bool final = i + 1 == chain.size();
    const double leave = final ? to_.heading_rad : entry_heading(chain[i + 1]);
    fits = fits && path.append(circle.arc(entry, leave));
    if (!final) {
      const auto& next = line(chain[i] / count(), chain[i + 1] / count());
      fits = fits && path.append(Segment{0.0, next->length_m});
    }
  }
  if (!fits) path.segments.clear();
  return path;
}

std::optional<Path> TangentGraph::shortest() {
  find_lines();
  std::vector<State> states(count() * count());
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  for (const std::size_t start : {std::size_t{0}, std::size_t{1}}) {
    const std::size_t s = state(start, start);
    states[s] = {0.0, s, false};
    open.emplace(0.0, s);
  }
  double best_m = kInfinity;
  std::size_t best = 0;
  while (!open.empty() && open.top().first < best_m) {
    const std::size_t s = open.top().second;
    open.pop();
    if (std::exchange(states[s].done, true)) continue;
    const std::size_t circle = s / count();
    const double entry = entry_heading(s);
    const double so_far = states[s].length_m;
    if (circle >= kGoals && circle < kPasses) {
      const Segment arc = circles_[circle].arc(entry, to_.heading_rad);
      if (so_far + arc.length_m < best_m && arc_is_clear(circles_[circle], entry, arc)) {
        best_m = so_far + arc.length_m;
        best = s;
      }
      continue;
    }
    for (std::size_t next = kGoals; next < count(); ++next) {
      const auto& joined = line(circle, next);
      const std::size_t t = state(next, circle);
      if (!joined || states[t].done) continue;
      const Segment arc = circles_[circle].arc(entry, joined->heading_rad);
      const double length = so_far + arc.length_m + joined->length_m;
      if (length >= states[t].length_m || !arc_is_clear(circles_[circle], entry, arc)) continue;
      states[t].length_m = length;
      states[t].before = s;
      open.emplace(length, t);
    }
  }
  if (best_m == kInfinity) return std::nullopt;
  return trace(states, best);
}

bool reaches(const Path& path, const Pose2& to) {
  const Pose2 end = path.end();
  return (end.position() - to.position()).norm() < kEndSlack_m;
}

std::optional<Path> shortest_clear_word(const Pose2& from, const Pose2& to, double radius_m,
                                        std::span<const Hazard> hazards) {
  std::optional<Path> best;
  double best_m = kInfinity;
  for (std::uint8_t i = 0; i < static_cast<std::uint8_t>(DubinsWord::count); ++i) {
    const auto word = dubins_word(DubinsWord{i}, from, to, radius_m, radius_m);
    if (!word || word->length_m() >= best_m) continue;
    const Path path = word->to_path();
    if (!is_clear(path, hazards)) continue;
    best = path;
    best_m = word->length_m();
  }
  return best;
}

/// Hazards become part of the graph only once a path meets them: most never do.
std::optional<Path> around_hazards(const AvoidanceParams& params, const Pose2& from,
                                   const Pose2& to, double radius_m, const Path& direct,
                                   std::span<const Hazard> hazards) {
  std::vector<Hazard> active;
  std::vector<char> is_active(hazards.size(), 0);
  Path path = direct;
  while (true) {
    bool added = false;
    for (std::size_t i = 0; i < hazards.size(); ++i) {
      if (is_active[i] != 0 || is_clear(path, hazards.subspan(i, 1))) continue;
      is_active[i] = 1;
      active.push_back(hazards[i]);
      added = true;
    }
    if (!added) return path;
    if (active.size() > kActiveMax) return std::nullopt;
    const auto next = TangentGraph{params, from, to, radius_m, active}.shortest();
    if (!next || !reaches(*next, to)) return std::nullopt;
    path = *next;
  }
}

std::string place(const Pose2& pose) {
  std::string text{"("};
  text += std::to_string(std::lround(pose.x_m)) + ", " + std::to_string(std::lround(pose.y_m));
  return text += ")";
}

std::optional<Error> inside_hazard(const char* what, const Pose2& pose,
                                   std::span<const Hazard> hazards) {
  for (const Hazard& hazard : hazards) {
    if ((pose.position() - hazard.centre).norm() < hazard.radius_m - kTouch_m) {
      return Error{std::string{what} + " " + place(pose) + " lies inside hazard " +
                   std::to_string(hazard.id.value)};
    }
  }
  return std::nullopt;
}

}  // namespace

bool is_clear(const Path& path, std::span<const Hazard> hazards) {
  if (hazards.empty()) return true;
  Pose2 pose = path.start;
  const auto outside = [&](const Segment& piece) {
    return std::all_of(hazards.begin(), hazards.end(),
                       [&](const Hazard& h) { return piece_is_clear(pose, piece, h); });
  };
  if (!outside({0.0, 0.0})) return false;
  for (const Segment& piece : path.segments) {
    if (!outside(piece)) return false;
    pose = advance(pose, piece.curvature_per_m, piece.length_m);
  }
  return true;
}

bool out_of_reach(const AvoidanceParams& params, const Pose2& from, const Pose2& to,
                  double length_m, std::span<const Hazard> hazards) {
  return std::all_of(hazards.begin(), hazards.end(), [&](const Hazard& h) {
    return (h.centre - from.position()).norm() + (h.centre - to.position()).norm() >
           length_m + 2.0 * params.kappa * h.radius_m;
  });
}

Result<double> shortest_clear_length(const AvoidanceParams& params, const Pose2& from,
                                     const Pose2& to, double radius_m,
                                     std::span<const Hazard> hazards) {
  const double direct_m = shortest_dubins_length(from, to, radius_m);
  if (out_of_reach(params, from, to, direct_m, hazards)) return direct_m;
  const auto path = shortest_clear_path(params, from, to, radius_m, hazards);
  if (!path) return path.error();
  return path->length_m();
}

Result<Path> shortest_clear_path(const AvoidanceParams& params, const Pose2& from, const Pose2& to,
                                 double radius_m, std::span<const Hazard> hazards) {
  SKEIN_ASSERT(radius_m > 0.0 && params.kappa > 1.0);
  const Path direct = shortest_dubins(from, to, radius_m).to_path();
  if (out_of_reach(params, from, to, direct.length_m(), hazards)) return direct;
  if (is_clear(direct, hazards)) return direct;
  if (auto error = inside_hazard("The start", from, hazards)) return *error;
  if (auto error = inside_hazard("The goal", to, hazards)) return *error;
  const auto word = shortest_clear_word(from, to, radius_m, hazards);
  const auto around = around_hazards(params, from, to, radius_m, direct, hazards);
  if (around && (!word || around->length_m() < word->length_m())) return *around;
  if (word) return *word;
  return Error{"No path from " + place(from) + " to " + place(to) + " was found around " +
               std::to_string(hazards.size()) + " hazards with a turn radius of " +
               std::to_string(std::lround(radius_m)) + " m"};
}

}  // namespace skein::planning
