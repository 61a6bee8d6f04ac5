// SPDX-License-Identifier: Apache-2.0
#include "skein/routes/route_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace skein::routes {
namespace {

// Nothing here calls the route model (fly_by.hpp) or a path's own functions, on purpose.

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A straight line or an arc, by its end points and centre.
struct Piece {
  Vec2 from{0.0, 0.0};
  Vec2 to{0.0, 0.0};
  bool arc = false;
  Vec2 centre{0.0, 0.0};
  double radius_m = 0.0;
  double begin_rad = 0.0;  ///< of `from`, seen from the centre
  double sweep_rad = 0.0;  ///< counter-clockwise positive
  double length_m = 0.0;

  [[nodiscard]] Vec2 at(double distance_m) const {
    if (!arc) return from + (length_m > 0.0 ? distance_m / length_m : 0.0) * (to - from);
    const double angle = begin_rad + sweep_rad * (distance_m / length_m);
    return centre + radius_m * Vec2{std::cos(angle), std::sin(angle)};
  }
  [[nodiscard]] double distance_to(const Vec2& point) const {
    if (!arc) {
      const Vec2 d = to - from;
      const double length_sq = d.dot(d);
      const double share =
          length_sq > 0.0 ? std::clamp((point - from).dot(d) / length_sq, 0.0, 1.0) : 0.0;
      return (point - from - share * d).norm();
    }
    const Vec2 out = point - centre;
    const double ends = std::min((point - from).norm(), (point - to).norm());
    double ahead = std::atan2(out.y(), out.x()) - begin_rad;
    if (sweep_rad < 0.0) ahead = -ahead;
    ahead -= kTwoPi * std::floor(ahead / kTwoPi);
    return ahead <= std::abs(sweep_rad) ? std::min(ends, std::abs(out.norm() - radius_m)) : ends;
  }
};

struct Flown {
  std::vector<Piece> pieces;
  double length_m = 0.0;
  double room_m = kInfinity;
  double turn_largest_rad = 0.0;
  double last_straight_m = 0.0;

  [[nodiscard]] Vec2 at(double distance_m) const {
    double left = std::clamp(distance_m, 0.0, length_m);
    for (const Piece& piece : pieces) {
      if (left <= piece.length_m) return piece.at(left);
      left -= piece.length_m;
    }
    return pieces.back().to;
  }
  [[nodiscard]] bool is_arc(double distance_m) const {
    for (const Piece& piece : pieces) {
      if (distance_m <= piece.length_m) return piece.arc;
      distance_m -= piece.length_m;
    }
    return false;
  }
};

/// Angle between two directions, from their normalised half difference: another formula than the
/// model's.
double angle_between(const Vec2& a, const Vec2& b) {
  const Vec2 u = a.normalized();
  const Vec2 v = b.normalized();
  return 2.0 * std::atan2((u - v).norm(), (u + v).norm());
}

Flown fly(const std::vector<Vec2>& waypoints, double radius_m) {
  Flown flown;
  Vec2 at = waypoints.front();
  double used_m = 0.0;  ///< of the leg, by the arc before it
  for (std::size_t i = 1; i < waypoints.size(); ++i) {
    const Vec2 leg = waypoints[i] - waypoints[i - 1];
    double reach = 0.0;
    double turn = 0.0;
    bool left = true;
    Vec2 next{0.0, 0.0};
    if (i + 1 < waypoints.size()) {
      next = waypoints[i + 1] - waypoints[i];
      turn = angle_between(leg, next);
      left = leg.x() * next.y() - leg.y() * next.x() > 0.0;
      reach = radius_m * std::tan(0.5 * turn);
    }
    flown.turn_largest_rad = std::max(flown.turn_largest_rad, turn);
    flown.room_m = std::min(flown.room_m, leg.norm() - used_m - reach);
    flown.last_straight_m = leg.norm() - used_m - reach;
    const Vec2 leave = waypoints[i] - reach * leg.normalized();
    Piece line;
    line.from = at;
    line.to = leave;
    line.length_m = (leave - at).norm();
    flown.pieces.push_back(line);
    at = leave;
    used_m = reach;
    if (reach > 0.0) {
      Piece arc;
      arc.arc = true;
      arc.from = leave;
      arc.to = waypoints[i] + reach * next.normalized();
      arc.radius_m = radius_m;
      const Vec2 along = leg.normalized();
      const Vec2 side = left ? Vec2{-along.y(), along.x()} : Vec2{along.y(), -along.x()};
      arc.centre = leave + radius_m * side;
      arc.begin_rad = std::atan2(-side.y(), -side.x());
      arc.sweep_rad = left ? turn : -turn;
      arc.length_m = radius_m * turn;
      flown.pieces.push_back(arc);
      at = arc.to;
    }
  }
  for (const Piece& piece : flown.pieces) flown.length_m += piece.length_m;
  return flown;
}

std::string number(double value) { return std::to_string(value); }

class Checker {
 public:
  Checker(const RouteProblem& problem, const CooperativePlan& plan, const CheckTolerances& allowed)
      : problem_{problem}, plan_{plan}, allowed_{allowed} {}

  CheckReport run() {
    if (plan_.routes.size() != problem_.vehicles.size()) {
      Violation& broken = report_.violations.emplace_back();
      broken.message = "the plan does not have one route for each vehicle";
      return report_;
    }
    for (std::size_t i = 0; i < problem_.vehicles.size(); ++i) {
      if (!check_waypoints(i)) return report_;
    }
    for (std::size_t i = 0; i < problem_.vehicles.size(); ++i) check_route(i);
    double least = kInfinity;
    double most = -kInfinity;
    for (const RouteMeasures& m : report_.routes) {
      least = std::min(least, m.arrival_error_s);
      most = std::max(most, m.arrival_error_s);
    }
    report_.arrival_spread_s = most - least;
    check_separation();
    return report_;
  }

 private:
  void broken(std::size_t vehicle, const std::string& message) {
    report_.violations.push_back({problem_.vehicles[vehicle].id, message});
  }

  /// False where the route cannot be flown at all.
  bool check_waypoints(std::size_t i) {
    const std::vector<Vec2>& points = plan_.routes[i].waypoints;
    if (plan_.routes[i].id != problem_.vehicles[i].id) broken(i, "the route is another vehicle's");
    if (points.size() < 2 || points.size() > problem_.rules.waypoints_max) {
      broken(i, "has " + std::to_string(points.size()) + " waypoints, not 2 to " +
                    std::to_string(problem_.rules.waypoints_max));
    }
    if (points.size() < 2) return false;
    for (std::size_t k = 0; k < points.size(); ++k) {
      const bool apart = k == 0 || (points[k] - points[k - 1]).norm() > 0.0;
      if (std::isfinite(points[k].x()) && std::isfinite(points[k].y()) && apart) continue;
      broken(i, "waypoint " + std::to_string(k) + " is not finite, or that before it");
      return false;
    }
    return true;
  }

  void check_route(std::size_t i) {
    const RouteVehicle& vehicle = problem_.vehicles[i];
    const std::vector<Vec2>& points = plan_.routes[i].waypoints;
    const RouteRules& rules = problem_.rules;
    Flown flown = fly(points, vehicle.turn_radius_m);
    RouteMeasures m{.id = vehicle.id};
    m.length_m = flown.length_m;
    m.arrival_error_s =
        flown.length_m / vehicle.speed_mps - plan_.arrival_s - vehicle.arrival_offset_s;
    m.turn_largest_rad = flown.turn_largest_rad;
    m.turn_room_m = flown.room_m;
    m.last_straight_m = flown.last_straight_m;
    m.start_angle_rad = angle_between(points[1] - points[0], {std::cos(vehicle.start_heading_rad),
                                                              std::sin(vehicle.start_heading_rad)});
    m.bearing_error_rad = angle_between(
        points.back() - points[points.size() - 2],
        {std::cos(vehicle.approach_heading_rad), std::sin(vehicle.approach_heading_rad)});
    m.clearance_m = kInfinity;
    for (const RouteHazard& hazard : problem_.hazards) {
      if (!problem_.closed(hazard)) continue;
      double clearance = kInfinity;
      for (const Piece& piece : flown.pieces) {
        clearance = std::min(clearance, piece.distance_to(hazard.centre) - hazard.radius_m);
      }
      m.clearance_m = std::min(m.clearance_m, clearance);
      if (clearance < rules.clearance_m - allowed_.distance_m) {
        broken(i,
               "comes to " + number(clearance) + " m of hazard " + std::to_string(hazard.id.value));
      }
    }
    const double climbing_m = m.length_m - rules.last_leg_m;
    const double rise_m = vehicle.arrival_height_m - vehicle.start_height_m;
    m.climb = rise_m == 0.0 ? 0.0 : rise_m / std::max(climbing_m, 1e-9);
    if (std::abs(rise_m) > vehicle.climb_max * climbing_m + allowed_.distance_m) {
      broken(i, "climbs by " + number(100.0 * m.climb) + " %");
    }
    if ((points.front() - vehicle.start).norm() > allowed_.distance_m) {
      broken(i, "does not begin at its start");
    }
    if ((points.back() - problem_.site).norm() > allowed_.distance_m) {
      broken(i, "does not end at the site");
    }
    if (m.turn_room_m < -allowed_.distance_m) {
      broken(i, "turns overlap by " + number(-m.turn_room_m) + " m");
    }
    if (m.turn_largest_rad > rules.turn_max_rad + allowed_.angle_rad) {
      broken(i, "turns by " + number(degrees(m.turn_largest_rad)) + " deg at once");
    }
    if (m.start_angle_rad > vehicle.start_cone_rad + allowed_.angle_rad) {
      broken(i, "leaves " + number(degrees(m.start_angle_rad)) + " deg off its start heading");
    }
    if (m.bearing_error_rad > allowed_.angle_rad) {
      broken(i, "arrives " + number(degrees(m.bearing_error_rad)) + " deg off its bearing");
    }
    if (m.last_straight_m < rules.last_leg_m - allowed_.distance_m) {
      broken(i, "has a last straight leg of " + number(m.last_straight_m) + " m only");
    }
    if (m.length_m > vehicle.range_m + allowed_.distance_m) {
      broken(i, "is " + number(m.length_m) + " m long, beyond the range");
    }
    if (std::abs(m.arrival_error_s) > allowed_.arrival_s) {
      broken(i, "arrives " + number(m.arrival_error_s) + " s late");
    }
    if (std::abs(m.length_m - plan_.routes[i].length_m) > allowed_.distance_m) {
      broken(i, "is " + number(m.length_m) + " m long, and says " +
                    number(plan_.routes[i].length_m) + " m");
    }
    report_.routes.push_back(m);
    flown_.push_back(std::move(flown));
  }

  [[nodiscard]] Vec2 apart(std::size_t i, std::size_t j, double t) const {
    return flown_[i].at(problem_.vehicles[i].speed_mps * t) -
           flown_[j].at(problem_.vehicles[j].speed_mps * t);
  }

  struct Nearest {
    double distance_m = kInfinity;
    double at_s = 0.0;

    void see(double distance, double at) {
      if (distance >= distance_m) return;
      distance_m = distance;
      at_s = at;
    }
  };

  /// Least distance in [from, to]: away from its middle the distance falls by no more than both
  /// speeds allow; halves that cannot hold a smaller one than is known are left.
  void bisect(std::size_t i, std::size_t j, double from, double to, Nearest& nearest) const {
    const double middle = 0.5 * (from + to);
    const double here = apart(i, j, middle).norm();
    nearest.see(here, middle);
    const double closing = problem_.vehicles[i].speed_mps + problem_.vehicles[j].speed_mps;
    const double bound = here - 0.5 * (to - from) * closing;
    if (bound >= nearest.distance_m - 0.5 * allowed_.distance_m) return;
    bisect(i, j, from, middle, nearest);
    bisect(i, j, middle, to, nearest);
  }

  /// Where both fly straight the difference of their positions moves along a line.
  void straight(std::size_t i, std::size_t j, double from, double to, Nearest& nearest) const {
    const Vec2 a = apart(i, j, from);
    const Vec2 d = apart(i, j, to) - a;
    const double moved_sq = d.dot(d);
    const double share = moved_sq > 0.0 ? std::clamp(-a.dot(d) / moved_sq, 0.0, 1.0) : 0.0;
    nearest.see((a + share * d).norm(), from + share * (to - from));
  }

  void times_of_pieces(std::size_t i, std::vector<double>& times) const {
    double flown_m = 0.0;
    for (const Piece& piece : flown_[i].pieces) {
      flown_m += piece.length_m;
      times.push_back(flown_m / problem_.vehicles[i].speed_mps);
    }
  }

  [[nodiscard]] double height(std::size_t i, double t) const {
    const RouteVehicle& v = problem_.vehicles[i];
    const double level_at_s = level_s(i);
    if (t >= level_at_s) return v.arrival_height_m;
    return v.start_height_m + (v.arrival_height_m - v.start_height_m) * t / level_at_s;
  }
  [[nodiscard]] double level_s(std::size_t i) const {
    return (flown_[i].length_m - problem_.rules.last_leg_m) / problem_.vehicles[i].speed_mps;
  }

  /// Moments at which two vehicles begin or cease to be apart in height: their difference is linear
  /// between the moments at which one of them levels out.
  void times_of_heights(std::size_t i, std::size_t j, double until,
                        std::vector<double>& times) const {
    const double limit = problem_.rules.separation_height_m;
    std::vector<double> bends = {0.0, level_s(i), level_s(j), until};
    std::sort(bends.begin(), bends.end());
    for (std::size_t k = 1; k < bends.size(); ++k) {
      const double from = height(i, bends[k - 1]) - height(j, bends[k - 1]);
      const double to = height(i, bends[k]) - height(j, bends[k]);
      for (const double level : {limit, -limit}) {
        if ((from - level) * (to - level) >= 0.0) continue;
        const double share = (level - from) / (to - from);
        times.push_back(bends[k - 1] + share * (bends[k] - bends[k - 1]));
      }
    }
  }

  void look_along(std::size_t i, std::size_t j, double until, Nearest& nearest) const {
    std::vector<double> times = {0.0, until};
    times_of_pieces(i, times);
    times_of_pieces(j, times);
    const bool heights = std::isfinite(problem_.rules.separation_height_m);
    if (heights) times_of_heights(i, j, until, times);
    std::sort(times.begin(), times.end());
    for (std::size_t k = 1; k < times.size() && times[k] <= until; ++k) {
      const double middle = 0.5 * (times[k - 1] + times[k]);
      if (heights &&
          std::abs(height(i, middle) - height(j, middle)) >= problem_.rules.separation_height_m) {
        continue;
      }
      const bool arcs = flown_[i].is_arc(problem_.vehicles[i].speed_mps * middle) ||
                        flown_[j].is_arc(problem_.vehicles[j].speed_mps * middle);
      if (arcs) {
        bisect(i, j, times[k - 1], times[k], nearest);
      } else {
        straight(i, j, times[k - 1], times[k], nearest);
      }
    }
  }

  void check_separation() {
    const double wanted = problem_.rules.separation_m;
    report_.separation_m = kInfinity;
    for (std::size_t i = 0; i < flown_.size(); ++i) {
      for (std::size_t j = i + 1; j < flown_.size(); ++j) {
        const double speed_i = problem_.vehicles[i].speed_mps;
        const double speed_j = problem_.vehicles[j].speed_mps;
        const double end_i = flown_[i].length_m / speed_i;
        const double end_j = flown_[j].length_m / speed_j;
        double until = std::min(end_i, end_j);
        if (std::abs(end_i - end_j) * std::max(speed_i, speed_j) < wanted) {
          const double last_i = end_i - flown_[i].last_straight_m / speed_i;
          const double last_j = end_j - flown_[j].last_straight_m / speed_j;
          until = std::min(until, std::max(last_i, last_j));
        }
        // Above both the least so far and what is wanted, the distance of a pair does not matter.
        Nearest nearest{std::max(report_.separation_m, wanted), 0.0};
        look_along(i, j, until, nearest);
        if (nearest.distance_m < report_.separation_m) {
          report_.separation_m = nearest.distance_m;
          report_.separation_at_s = nearest.at_s;
        }
        if (nearest.distance_m < wanted - allowed_.distance_m) {
          broken(i, "comes to " + number(nearest.distance_m) + " m of vehicle " +
                        std::to_string(problem_.vehicles[j].id.value) + " at " +
                        number(nearest.at_s) + " s");
        }
      }
    }
  }

  const RouteProblem& problem_;
  const CooperativePlan& plan_;
  const CheckTolerances& allowed_;
  CheckReport report_;
  std::vector<Flown> flown_;
};

}  // namespace

CheckReport check_routes(const RouteProblem& problem, const CooperativePlan& plan,
                         const CheckTolerances& tolerances) {
  return Checker{problem, plan, tolerances}.run();
}

}  // namespace skein::routes
