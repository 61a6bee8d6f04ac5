// SPDX-License-Identifier: Apache-2.0
#include "skein/planning/avoidance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "avoidance_graph.hpp"
#include "avoidance_margin.hpp"
#include "skein/base/angles.hpp"
#include "skein/base/assert.hpp"
#include "skein/planning/dubins.hpp"

namespace skein::planning {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kEndSlack_m = 1e-7;  ///< what the search's end may miss the goal by
constexpr double kInside_m = 1e-6;    ///< by which a circle is smaller than an end's distance
/// Parts of the margin that are tried, in this order, where there is no path with the whole of it.
constexpr std::array<double, 4> kMargins = {1.0, 0.5, 0.25, 0.0};
constexpr int kTurnsOut = 90;  ///< tried on each side to leave a hazard
constexpr int kBisections = 60;

std::string place(const Pose2& pose) {
  std::string text{"("};
  text += std::to_string(std::lround(pose.x_m)) + ", " + std::to_string(std::lround(pose.y_m));
  return text += ")";
}
std::string metres(double m) { return std::to_string(std::lround(m)) + " m"; }
std::string name(const Hazard& hazard) { return "hazard " + std::to_string(hazard.id.value); }

const Hazard* hazard_around(const Vec2& point, std::span<const Hazard> hazards) {
  const auto around = std::find_if(hazards.begin(), hazards.end(), [&](const Hazard& h) {
    return (point - h.centre).norm() < h.radius_m - kTouch_m;
  });
  return around == hazards.end() ? nullptr : &*around;
}

/// The largest distance that a vehicle at the pose can keep from the point: its own where it flies
/// away from the point, otherwise that of the better of its two tightest turns.
double room_to(const Vec2& point, const Pose2& pose, double radius_m) {
  const Vec2 forward = unit_vector(pose.heading_rad);
  const Vec2 offset = point - pose.position();
  if (forward.dot(offset) <= 0.0) return offset.norm();
  double room = 0.0;
  for (const double side : {1.0, -1.0}) {
    const double to_centre = (offset - side * radius_m * left_of(forward)).norm();
    room = std::max(room, std::abs(to_centre - radius_m));
  }
  return room;
}

Pose2 backwards(const Pose2& pose) { return {pose.x_m, pose.y_m, pose.heading_rad + kPi}; }

/// The hazards grown by a part of the margin, as far as both ends have room for it.
std::vector<Hazard> circles_around(const AvoidanceParams& params, const Pose2& from,
                                   const Pose2& to, double radius_m,
                                   std::span<const Hazard> hazards, double part) {
  std::vector<Hazard> circles{hazards.begin(), hazards.end()};
  for (Hazard& circle : circles) {
    const double room = std::min(room_to(circle.centre, from, radius_m),
                                 room_to(circle.centre, backwards(to), radius_m));
    const double safety_m = std::min(params.safety_radius_m(circle), room - kInside_m);
    circle.radius_m += part * std::max(0.0, safety_m - circle.radius_m);
  }
  return circles;
}

std::optional<Path> shortest_clear_word(const Pose2& from, const Pose2& to, double radius_m,
                                        std::span<const Hazard> circles) {
  std::optional<Path> best;
  double best_m = kInfinity;
  for (std::uint8_t i = 0; i < static_cast<std::uint8_t>(DubinsWord::count); ++i) {
    const auto word = dubins_word(DubinsWord{i}, from, to, radius_m, radius_m);
    if (!word || word->length_m() >= best_m) continue;
    const Path path = word->to_path();
    if (!is_clear(path, circles)) continue;
    best = path;
    best_m = word->length_m();
  }
  return best;
}

std::optional<Path> clear_of(const Pose2& from, const Pose2& to, double radius_m,
                             std::span<const Hazard> circles) {
  const auto word = shortest_clear_word(from, to, radius_m, circles);
  const auto around = shortest_by_tangents(from, to, radius_m, circles);
  const bool reaches = around && (around->end().position() - to.position()).norm() < kEndSlack_m;
  return reaches && (!word || around->length_m() < word->length_m()) ? around : word;
}

/// Why nothing was found, as far as one hazard alone explains it.
Error barred(const Pose2& from, const Pose2& to, double radius_m, std::span<const Hazard> hazards) {
  const auto within_turn = [&](const Pose2& end) {
    return std::find_if(hazards.begin(), hazards.end(), [&](const Hazard& h) {
      return room_to(h.centre, end, radius_m) < h.radius_m - kTouch_m;
    });
  };
  if (const auto h = within_turn(from); h != hazards.end()) {
    return Error{"From " + place(from) + " no turn of " + metres(radius_m) +
                 " is tight enough to miss " + name(*h)};
  }
  if (const auto h = within_turn(backwards(to)); h != hazards.end()) {
    return Error{"The goal " + place(to) + " cannot be approached on its heading: " + name(*h) +
                 " lies closer before it than a turn of " + metres(radius_m)};
  }
  return Error{"No path from " + place(from) + " to " + place(to) + " was found around " +
               std::to_string(hazards.size()) + " hazards with a turn radius of " +
               metres(radius_m)};
}

/// The start outside all hazards.
Result<ClearPath> find_from_outside(const AvoidanceParams& params, const Pose2& from,
                                    const Pose2& to, double radius_m,
                                    std::span<const Hazard> hazards) {
  const Path direct = shortest_dubins(from, to, radius_m).to_path();
  for (const double part : kMargins) {
    auto circles = circles_around(params, from, to, radius_m, hazards, part);
    if (is_clear(direct, circles)) return ClearPath{{from, {}}, direct, std::move(circles)};
    if (const auto path = clear_of(from, to, radius_m, circles)) {
      return ClearPath{{from, {}}, *path, std::move(circles)};
    }
  }
  return barred(from, to, radius_m, hazards);
}

/// How far it is straight on until the pose is outside all hazards.
double straight_out_m(const Pose2& from, std::span<const Hazard> hazards) {
  const Vec2 forward = unit_vector(from.heading_rad);
  double out_m = 0.0;
  for (bool moved = true; moved;) {
    moved = false;
    for (const Hazard& h : hazards) {
      const Vec2 p = from.position() + out_m * forward - h.centre;
      const double outside_m = h.radius_m + kInside_m;
      if (p.norm() >= h.radius_m) continue;
      const double along = p.dot(forward);
      out_m += std::sqrt(along * along + outside_m * outside_m - p.squaredNorm()) - along;
      moved = true;
    }
  }
  return out_m;
}

/// The shortest way out of all hazards that turns to one side, then flies straight.
Path way_out(const Pose2& from, double radius_m, double side, std::span<const Hazard> hazards) {
  const auto straight_m = [&](double turn_rad) {
    return straight_out_m(advance(from, side / radius_m, turn_rad * radius_m), hazards);
  };
  const auto length_m = [&](double turn_rad) { return radius_m * turn_rad + straight_m(turn_rad); };
  constexpr double kStep_rad = kTwoPi / kTurnsOut;
  double best_rad = 0.0;
  for (int i = 1; i < kTurnsOut; ++i) {
    if (length_m(i * kStep_rad) < length_m(best_rad)) best_rad = i * kStep_rad;
  }
  double low = std::max(0.0, best_rad - kStep_rad);
  double high = best_rad + kStep_rad;
  for (int k = 0; k < kBisections; ++k) {
    const double a = low + (high - low) / 3.0;
    const double b = high - (high - low) / 3.0;
    (length_m(a) <= length_m(b) ? high : low) = length_m(a) <= length_m(b) ? b : a;
  }
  if (length_m(low) < length_m(best_rad)) best_rad = low;
  Path path{.start = from, .segments = {}};
  SKEIN_ASSERT(path.append(Segment{side / radius_m, radius_m * best_rad}) &&
               path.append(Segment{0.0, straight_m(best_rad)}));
  return path;
}

}  // namespace

WaysOut ways_out(const Pose2& from, double radius_m, std::span<const Hazard> hazards) {
  if (hazard_around(from.position(), hazards) == nullptr) return std::nullopt;
  std::array<Path, 2> ways = {way_out(from, radius_m, 1.0, hazards),
                              way_out(from, radius_m, -1.0, hazards)};
  if (ways[1].length_m() < ways[0].length_m()) std::swap(ways[0], ways[1]);
  return ways;
}

Result<ClearPath> find_clear_path(const AvoidanceParams& params, const Pose2& from, const Pose2& to,
                                  double radius_m, std::span<const Hazard> hazards,
                                  const WaysOut& ways) {
  SKEIN_ASSERT(radius_m > 0.0 && params.kappa > 1.0);
  if (const Hazard* around = hazard_around(to.position(), hazards)) {
    return Error{"The goal " + place(to) + " lies inside " + name(*around)};
  }
  if (!ways) return find_from_outside(params, from, to, radius_m, hazards);
  for (const Path& way : *ways) {
    auto rest = find_from_outside(params, way.end(), to, radius_m, hazards);
    if (!rest) continue;
    rest->way_out = way;
    return rest;
  }
  return Error{"The start " + place(from) + " lies inside " +
               name(*hazard_around(from.position(), hazards)) + ". " +
               barred(ways->front().end(), to, radius_m, hazards).message};
}

Result<ClearPath> find_clear_path(const AvoidanceParams& params, const Pose2& from, const Pose2& to,
                                  double radius_m, std::span<const Hazard> hazards) {
  return find_clear_path(params, from, to, radius_m, hazards, ways_out(from, radius_m, hazards));
}

const Hazard* first_entered(const Path& path, std::span<const Hazard> hazards) {
  if (hazards.empty()) return nullptr;
  Pose2 pose = path.start;
  const auto entered = [&](const Segment& piece) {
    const auto h = std::find_if(hazards.begin(), hazards.end(), [&](const Hazard& hazard) {
      return !piece_is_clear(pose, piece, hazard);
    });
    return h == hazards.end() ? nullptr : &*h;
  };
  if (const Hazard* here = entered({0.0, 0.0})) return here;
  for (const Segment& piece : path.segments) {
    if (const Hazard* there = entered(piece)) return there;
    pose = advance(pose, piece.curvature_per_m, piece.length_m);
  }
  return nullptr;
}

bool is_clear(const Path& path, std::span<const Hazard> hazards) {
  return first_entered(path, hazards) == nullptr;
}

bool out_of_reach(const AvoidanceParams& params, const Pose2& from, const Pose2& to,
                  double length_m, std::span<const Hazard> hazards) {
  return std::all_of(hazards.begin(), hazards.end(), [&](const Hazard& h) {
    return (h.centre - from.position()).norm() + (h.centre - to.position()).norm() >
           length_m + 2.0 * params.safety_radius_m(h);
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
  const DubinsPath direct = shortest_dubins(from, to, radius_m);
  if (out_of_reach(params, from, to, direct.length_m(), hazards)) return direct.to_path();
  auto found = find_clear_path(params, from, to, radius_m, hazards);
  if (!found) return found.error();
  if (!found->way_out.append(found->path)) return Error{"The path has too many pieces"};
  return found->way_out;
}

}  // namespace skein::planning
