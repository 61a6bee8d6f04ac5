// SPDX-License-Identifier: Apache-2.0
#include "return_holds.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "skein/base/angles.hpp"

namespace skein::planning {
namespace {

constexpr int kHeadings = 8;
/// Between orbits of the lattice there is room for a way through that keeps its margin.
constexpr double kLatticeRoom = 2.5;
/// Of the lattice, around a home: room for some thousands of orbits.
constexpr double kRings = 40.0;

using Holds = std::vector<std::optional<ReturnHold>>;

/// As planned ways do, an orbit keeps more than the radius.
bool is_clear_of(const Ring& ring, std::span<const Hazard> hazards,
                 const AvoidanceParams& avoidance) {
  return std::ranges::all_of(hazards, [&](const Hazard& hazard) {
    return distance_m(ring, hazard.centre) >= avoidance.safety_radius_m(hazard);
  });
}

class Assignment {
 public:
  Assignment(const ReturnParams& params, std::span<const ReturningVehicle> vehicles,
             std::span<const Hazard> hazards)
      : params_{params}, vehicles_{vehicles}, hazards_{hazards}, holds_(vehicles.size()) {}

  /// The orbit of a way that is flown already.
  void keep(std::size_t i) {
    const TimedPath& flies = *vehicles_[i].flies;
    const double curvature = flies.tail_curvature_per_m;
    holds_[i] = ReturnHold{ring_of(flies.path.end(), curvature), curvature, {}, 0.0};
  }

  /// Passing over home.
  bool at_home(std::size_t i) {
    const ReturningVehicle& v = vehicles_[i];
    const Vec2 way = v.home - v.start.position();
    const double direct =
        way.norm() > v.turn_radius_m ? std::atan2(way.y(), way.x()) : v.start.heading_rad;
    const int headings = v.arrival_heading_rad ? 1 : kHeadings;
    for (int k = 0; k < headings; ++k) {
      const double heading = v.arrival_heading_rad.value_or(direct + k * kTwoPi / kHeadings);
      const Pose2 entry{v.home.x(), v.home.y(), wrap_pi(heading)};
      for (const double side : {1.0, -1.0}) {
        if (take(i, {ring_of(entry, side / v.turn_radius_m), side / v.turn_radius_m, entry, 0.0})) {
          return true;
        }
      }
    }
    return false;
  }

  /// The nearest free place of a hexagonal lattice, the densest way to put circles side by side.
  bool near_home(std::size_t i) {
    const ReturningVehicle& v = vehicles_[i];
    for (const auto& [distance_m, side, x, y] : places_around(v)) {
      const double curvature = side / v.turn_radius_m;
      ReturnHold hold{{{x, y}, v.turn_radius_m}, curvature, {}, 0.0};
      hold.off_home_m = planning::distance_m(hold.ring, v.home);
      if (take(i, hold)) return true;
    }
    return false;
  }

  [[nodiscard]] Holds result() { return std::move(holds_); }

 private:
  bool take(std::size_t i, const ReturnHold& hold) {
    if (!is_clear_of(hold.ring, hazards_, params_.avoidance)) return false;
    for (std::size_t j = 0; j < vehicles_.size(); ++j) {
      if (!holds_[j] || apart_in_height(params_, vehicles_[i], vehicles_[j])) continue;
      if (distance_m(hold.ring, holds_[j]->ring) < params_.separation_horizontal_m) return false;
    }
    holds_[i] = hold;
    return true;
  }

  using Place = std::tuple<double, double, double, double>;  ///< distance, side, x, y
  [[nodiscard]] std::vector<Place> places_around(const ReturningVehicle& v) const {
    double radius_m = 0.0;
    for (const ReturningVehicle& other : vehicles_) {
      if (!apart_in_height(params_, v, other)) radius_m = std::max(radius_m, other.turn_radius_m);
    }
    // One lattice for all, whose homes may be a few metres from each other.
    const double pitch_m = 2.0 * radius_m + kLatticeRoom * params_.separation_horizontal_m;
    const double row_m = pitch_m * std::sqrt(0.75);
    const double within_m = std::min(params_.hold_within_m, kRings * pitch_m);
    const double reach_m = within_m + v.turn_radius_m;
    std::vector<Place> places;
    const auto first = static_cast<long>(std::floor((v.home.y() - reach_m) / row_m));
    const auto last = static_cast<long>(std::ceil((v.home.y() + reach_m) / row_m));
    for (long row = first; row <= last; ++row) {
      const double shift_m = row % 2 == 0 ? 0.0 : pitch_m / 2.0;
      const auto left = static_cast<long>(std::floor((v.home.x() - reach_m - shift_m) / pitch_m));
      const auto right = static_cast<long>(std::ceil((v.home.x() + reach_m - shift_m) / pitch_m));
      for (long column = left; column <= right; ++column) {
        const Vec2 centre{static_cast<double>(column) * pitch_m + shift_m,
                          static_cast<double>(row) * row_m};
        const double off_m = distance_m(Ring{centre, v.turn_radius_m}, v.home);
        if (off_m > within_m) continue;
        for (const double side : {-1.0, 1.0}) {
          places.emplace_back(off_m, side, centre.x(), centre.y());
        }
      }
    }
    std::ranges::sort(places);
    return places;
  }

  const ReturnParams& params_;
  std::span<const ReturningVehicle> vehicles_;
  std::span<const Hazard> hazards_;
  Holds holds_;
};

}  // namespace

Pose2 entry_at(const ReturnHold& hold, double heading_rad) {
  const Vec2 at = hold.ring.centre - left_of(unit_vector(heading_rad)) / hold.curvature_per_m;
  return {at.x(), at.y(), wrap_pi(heading_rad)};
}

Pose2 entry_of(const ReturnHold& hold, const Pose2& from) {
  if (hold.entry) return *hold.entry;
  const Vec2 to_centre = hold.ring.centre - from.position();
  const double away_m = to_centre.norm();
  const double side = hold.curvature_per_m > 0.0 ? 1.0 : -1.0;
  double heading = from.heading_rad;
  if (away_m > hold.ring.radius_m) {
    // A left-hand orbit has its centre to the left of the tangent.
    heading = std::atan2(to_centre.y(), to_centre.x()) -
              side * std::asin(std::min(1.0, hold.ring.radius_m / away_m));
  }
  return entry_at(hold, heading);
}

bool apart_in_height(const ReturnParams& params, const ReturningVehicle& a,
                     const ReturningVehicle& b) {
  return std::abs(a.height_m - b.height_m) >= params.separation_vertical_m;
}

std::vector<std::optional<ReturnHold>> assign_holds(const ReturnParams& params,
                                                    std::span<const ReturningVehicle> vehicles,
                                                    std::span<const Hazard> hazards,
                                                    const std::vector<bool>& wanted) {
  Assignment assignment{params, vehicles, hazards};
  std::vector<std::size_t> later;
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    if (wanted[i] && vehicles[i].flies) assignment.keep(i);
  }
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    if (wanted[i] && !vehicles[i].flies && !assignment.at_home(i)) later.push_back(i);
  }
  for (const std::size_t i : later) (void)assignment.near_home(i);
  return assignment.result();
}

}  // namespace skein::planning
