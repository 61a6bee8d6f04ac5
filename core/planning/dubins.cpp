// SPDX-License-Identifier: Apache-2.0
#include "skein/planning/dubins.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "dubins_lanes.hpp"
#include "skein/base/angles.hpp"
#include "skein/base/assert.hpp"

namespace skein::planning {
namespace {

double slack_of(double radius_m) { return DubinsLanes<2>::slack_m(radius_m); }

/// Two ways to compute one length differ by less, but where one of them goes full circle.
constexpr double kAgree_m = 1e-6;

constexpr std::array<DubinsWord, 6> kWords = {DubinsWord::LSL, DubinsWord::LSR, DubinsWord::RSL,
                                              DubinsWord::RSR, DubinsWord::RLR, DubinsWord::LRL};

/// +1 for left, -1 for right.
struct Senses {
  double first;
  double last;
  bool csc;
};

constexpr Senses senses_of(DubinsWord word) {
  switch (word) {
    case DubinsWord::LSL:
      return {1.0, 1.0, true};
    case DubinsWord::LSR:
      return {1.0, -1.0, true};
    case DubinsWord::RSL:
      return {-1.0, 1.0, true};
    case DubinsWord::RSR:
      return {-1.0, -1.0, true};
    case DubinsWord::RLR:
      return {-1.0, -1.0, false};
    case DubinsWord::LRL:
    case DubinsWord::count:
      break;
  }
  return {1.0, 1.0, false};
}

/// Both poses as seen from the first: the goal's position in its frame, and how much it turns.
struct Relative {
  double x_m;
  double y_m;
  double turn_rad;
  double sin_turn;
  double cos_turn;
};

Relative relative(const Pose2& from, const Pose2& to) {
  const double c = std::cos(from.heading_rad);
  const double s = std::sin(from.heading_rad);
  const double dx = to.x_m - from.x_m;
  const double dy = to.y_m - from.y_m;
  const double turn = wrap_pi(to.heading_rad - from.heading_rad);
  return {c * dx + s * dy, c * dy - s * dx, turn, std::sin(turn), std::cos(turn)};
}

/// The turn in [0, 2 pi), where a full circle less what moves the end by no more than the slack
/// is none at all.
double turn_of(double rad, double reach_m, double slack_m) {
  const double turn = wrap_two_pi(rad);
  return (kTwoPi - turn) * reach_m < slack_m ? 0.0 : turn;
}

struct Turns {
  double first_rad;
  double middle;  ///< metres for a line, radians for an arc
  double last_rad;
};

/// Circle centres c1, c2 and senses s: a line of heading t leaves the first circle at
/// c1 - s1 r1 n(t) and enters the last at c2 - s2 r2 n(t), n the left normal. So c2 - c1 =
/// line u(t) + (s2 r2 - s1 r1) n(t), which has one solution with line >= 0.
std::optional<Turns> csc(const Relative& g, const Senses& s, double r1, double r2) {
  const double wx = -s.last * r2 * g.sin_turn;
  const double wy = s.last * r2 * g.cos_turn - s.first * r1;
  const double dx = g.x_m + wx;
  const double dy = g.y_m + wy;
  const double offset = s.last * r2 - s.first * r1;
  // |d|^2 - offset^2, arranged so that near poses do not cancel.
  const double half = std::sin(g.turn_rad / 2.0);
  const double line_sq = g.x_m * g.x_m + g.y_m * g.y_m + 2.0 * (g.x_m * wx + g.y_m * wy) +
                         4.0 * s.first * s.last * r1 * r2 * half * half;
  const double slack_m = slack_of(std::max(r1, r2));
  if (line_sq < -2.0 * slack_m * std::abs(offset)) return std::nullopt;
  double heading = 0.0;
  double line = 0.0;
  if (offset != 0.0 || std::hypot(dx, dy) > slack_m) {
    line = offset != 0.0 ? std::sqrt(std::max(line_sq, 0.0)) : std::hypot(dx, dy);
    heading = std::atan2(dy * line - dx * offset, dx * line + dy * offset);
  }
  const double first = turn_of(s.first * heading, r1 + line, slack_m);
  const double last = turn_of(s.last * (g.turn_rad - heading), r2, slack_m);
  return Turns{first, line, last};
}

/// With middle turn m: c2 - c1 = 4 r sin(m / 2) u(t), t the heading halfway round the middle arc.
std::optional<Turns> ccc(const Relative& g, const Senses& s, double r, bool major) {
  const double dx = g.x_m - s.last * r * g.sin_turn;
  const double dy = g.y_m + s.last * r * g.cos_turn - s.first * r;
  const double distance = std::hypot(dx, dy);
  const double slack_m = slack_of(r);
  if (distance > 4.0 * r + slack_m) return std::nullopt;
  const double minor = 2.0 * std::asin(std::min(1.0, distance / (4.0 * r)));
  const double middle = major ? kTwoPi - minor : minor;
  const double halfway = distance > slack_m ? std::atan2(dy, dx) : 0.0;
  const double leave = halfway + s.first * middle / 2.0;
  const double enter = halfway - s.first * middle / 2.0;
  return Turns{turn_of(s.first * leave, 4.0 * r, slack_m), middle,
               turn_of(s.first * (g.turn_rad - enter), r, slack_m)};
}

std::optional<Turns> word_turns(DubinsWord word, const Relative& g, double r1, double r2) {
  const Senses s = senses_of(word);
  if (s.csc) return csc(g, s, r1, r2);
  if (r1 != r2) return std::nullopt;
  const auto minor = ccc(g, s, r1, false);
  const auto major = ccc(g, s, r1, true);
  if (!minor || !major) return std::nullopt;
  const auto sum = [](const Turns& t) { return t.first_rad + t.middle + t.last_rad; };
  return sum(*minor) <= sum(*major) ? minor : major;
}

DubinsPath make_path(DubinsWord word, const Pose2& from, const Turns& t, double r1, double r2) {
  const double middle_m = senses_of(word).csc ? t.middle : t.middle * r1;
  return {word, from, r1, r2, {t.first_rad * r1, middle_m, t.last_rad * r2}};
}

bool same_pose(const Relative& g, double radius_m) {
  const double slack_m = slack_of(radius_m);
  return std::hypot(g.x_m, g.y_m) < slack_m && std::abs(g.turn_rad) * radius_m < slack_m;
}

/// Lengths of all words: the left-first ones in one lane, the right-first ones in the other.
using Pair = DubinsLanes<2>;
struct WordLengths {
  Pair::Real same = Pair::infinity();   ///< LSL, RSR
  Pair::Real other = Pair::infinity();  ///< LSR, RSL
  Pair::Real ccc = Pair::infinity();    ///< LRL, RLR; infinite where it is not the shortest
  double shortest_m = 0.0;
};

double least_of(const Pair::Real& pair) { return pair[1] < pair[0] ? pair[1] : pair[0]; }

WordLengths word_lengths(const Pose2& from, const Pose2& to, double radius_m) {
  const Pair::Real headings = Pair::tame(Pair::Real{from.heading_rad, to.heading_rad});
  const Pair::SinCos both = Pair::sin_cos(headings);
  Pair::Goal goal = Pair::goal_of(Pair::splat(to.x_m - from.x_m), Pair::splat(to.y_m - from.y_m),
                                  Pair::splat(headings[1] - headings[0]),
                                  {Pair::splat(both.sin[0]), Pair::splat(both.cos[0])},
                                  {Pair::splat(both.sin[1]), Pair::splat(both.cos[1])});
  WordLengths result;
  if (Pair::any(Pair::is_here(goal, radius_m))) return result;
  const Pair::Real side{1.0, -1.0};
  goal = {goal.x, goal.y * side, goal.sin * side, goal.cos, goal.versine, goal.turn * side};
  Pair::Centres centres{};
  result.same = Pair::lsl(goal, radius_m, centres);
  result.other = Pair::lsr(goal, radius_m);
  result.shortest_m = least_of(Pair::least(result.same, result.other));
  const auto may_win =
      Pair::ccc_may_win(goal.turn, centres.distance, radius_m, Pair::splat(result.shortest_m));
  if (Pair::any(may_win)) {
    result.ccc = Pair::select(may_win, Pair::ccc(goal.turn, centres, radius_m), Pair::infinity());
    result.shortest_m = std::min(result.shortest_m, least_of(result.ccc));
  }
  return result;
}

/// The point in the frame of the start pose, reached by one arc and a line, or by two arcs.
struct ToPoint {
  double length_m = std::numeric_limits<double>::infinity();
  std::array<Segment, 2> pieces{};
};

void consider(ToPoint& best, double sense, double first_rad, Segment second, double radius_m) {
  const double length = first_rad * radius_m + second.length_m;
  if (length < best.length_m) {
    best = {length, {Segment{sense / radius_m, first_rad * radius_m}, second}};
  }
}

void consider_arc_and_line(ToPoint& best, const Vec2& goal, double sense, double r) {
  const Vec2 d = goal - Vec2{0.0, sense * r};
  // |d|^2 - r^2, arranged so that a goal near the start does not cancel.
  const double line_sq = goal.squaredNorm() - 2.0 * sense * r * goal.y();
  const double slack_m = slack_of(r);
  if (line_sq < -slack_m * r) return;
  const double line = std::sqrt(std::max(line_sq, 0.0));
  const double heading =
      std::atan2(d.y() * line + sense * r * d.x(), d.x() * line - sense * r * d.y());
  consider(best, sense, turn_of(sense * heading, r + line, slack_m), {0.0, line}, r);
}

/// The second circle touches the first and runs through the goal.
void consider_two_arcs(ToPoint& best, const Vec2& goal, double sense, double r) {
  const Vec2 centre{0.0, sense * r};
  const Vec2 d = goal - centre;
  const double distance = d.norm();
  if (distance < r || distance > 3.0 * r) return;
  const double slack_m = slack_of(r);
  const double between =
      std::acos(std::clamp((3.0 * r * r + distance * distance) / (4.0 * r * distance), -1.0, 1.0));
  for (const double side : {1.0, -1.0}) {
    const double direction = std::atan2(d.y(), d.x()) + side * between;
    const Vec2 second = centre + 2.0 * r * unit_vector(direction);
    // Heading on a circle: a quarter turn from the spoke, in the sense of flight.
    const double heading = direction + sense * kPi / 2.0;
    const Vec2 out = goal - second;
    const double spoke_turn = -sense * (std::atan2(out.y(), out.x()) - (direction + kPi));
    const double turn = turn_of(spoke_turn, r, slack_m);
    consider(best, sense, turn_of(sense * heading, 3.0 * r, slack_m), {-sense / r, turn * r}, r);
  }
}

}  // namespace

std::string_view to_string(DubinsWord word) {
  static constexpr std::array<std::string_view, static_cast<std::size_t>(DubinsWord::count)> kNames{
      "LSL", "LSR", "RSL", "RSR", "RLR", "LRL"};
  return word < DubinsWord::count ? kNames.at(static_cast<std::size_t>(word)) : "unknown";
}

Path DubinsPath::to_path() const {
  const Senses s = senses_of(word);
  const double middle = s.csc ? 0.0 : -s.first / start_radius_m;
  Path path{.start = start, .segments = {}};
  SKEIN_ASSERT(path.append(Segment{s.first / start_radius_m, lengths_m[0]}) &&
               path.append(Segment{middle, lengths_m[1]}) &&
               path.append(Segment{s.last / end_radius_m, lengths_m[2]}));
  return path;
}

std::optional<DubinsPath> dubins_word(DubinsWord word, const Pose2& from, const Pose2& to,
                                      double start_radius_m, double end_radius_m) {
  SKEIN_ASSERT(start_radius_m > 0.0 && end_radius_m > 0.0);
  const auto turns = word_turns(word, relative(from, to), start_radius_m, end_radius_m);
  if (!turns) return std::nullopt;
  return make_path(word, from, *turns, start_radius_m, end_radius_m);
}

std::optional<DubinsPath> dubins_ccc(DubinsWord word, const Pose2& from, const Pose2& to,
                                     double radius_m, bool major) {
  SKEIN_ASSERT(radius_m > 0.0);
  const Senses s = senses_of(word);
  SKEIN_ASSERT(!s.csc);
  const auto turns = ccc(relative(from, to), s, radius_m, major);
  if (!turns) return std::nullopt;
  return make_path(word, from, *turns, radius_m, radius_m);
}

DubinsPath shortest_dubins(const Pose2& from, const Pose2& to, double radius_m) {
  SKEIN_ASSERT(radius_m > 0.0);
  const WordLengths lengths = word_lengths(from, to, radius_m);
  const std::array<double, 6> by_word = {lengths.same[0], lengths.other[0], lengths.other[1],
                                         lengths.same[1], lengths.ccc[1],   lengths.ccc[0]};
  const auto least = std::min_element(by_word.begin(), by_word.end()) - by_word.begin();
  const auto word =
      dubins_word(kWords[static_cast<std::size_t>(least)], from, to, radius_m, radius_m);
  if (word && std::abs(word->length_m() - lengths.shortest_m) < kAgree_m) return *word;
  // The same pose, or on the edge where a word begins to exist.
  const auto best = shortest_dubins(from, to, radius_m, radius_m);
  SKEIN_ASSERT(best.has_value());
  return *best;
}

double shortest_dubins_length(const Pose2& from, const Pose2& to, double radius_m) {
  SKEIN_ASSERT(radius_m > 0.0);
  return word_lengths(from, to, radius_m).shortest_m;
}

std::optional<DubinsPath> shortest_dubins(const Pose2& from, const Pose2& to, double start_radius_m,
                                          double end_radius_m) {
  SKEIN_ASSERT(start_radius_m > 0.0 && end_radius_m > 0.0);
  const Relative g = relative(from, to);
  if (same_pose(g, std::max(start_radius_m, end_radius_m))) {
    return DubinsPath{DubinsWord::LSL, from, start_radius_m, end_radius_m, {}};
  }
  std::optional<DubinsPath> best;
  for (const DubinsWord word : kWords) {
    const auto turns = word_turns(word, g, start_radius_m, end_radius_m);
    if (!turns) continue;
    const DubinsPath path = make_path(word, from, *turns, start_radius_m, end_radius_m);
    if (!best || path.length_m() < best->length_m()) best = path;
  }
  return best;
}

Path shortest_to_point(const Pose2& from, const Vec2& to, double radius_m) {
  SKEIN_ASSERT(radius_m > 0.0);
  Path path{.start = from, .segments = {}};
  const Relative g = relative(from, {to.x(), to.y(), from.heading_rad});
  const Vec2 goal{g.x_m, g.y_m};
  if (goal.norm() < slack_of(radius_m)) return path;
  ToPoint best;
  for (const double sense : {1.0, -1.0}) {
    consider_arc_and_line(best, goal, sense, radius_m);
    consider_two_arcs(best, goal, sense, radius_m);
  }
  for (const Segment& piece : best.pieces) SKEIN_ASSERT(path.append(piece));
  return path;
}

}  // namespace skein::planning
