// SPDX-License-Identifier: Apache-2.0
#include "skein/formation/place_assignment.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "place_check.hpp"
#include "place_colony.hpp"
#include "skein/base/assert.hpp"

namespace skein::formation {
namespace {

constexpr std::array<std::string_view, static_cast<std::size_t>(PlaceMethod::count)> kNames = {
    "least_squares", "least_sum", "least_longest", "colony"};

bool is_within(const Vec3& point) {  // false for what is not a number
  return std::abs(point.x()) <= kPlaceCoordinateMax_m &&
         std::abs(point.y()) <= kPlaceCoordinateMax_m &&
         std::abs(point.z()) <= kPlaceCoordinateMax_m;
}

Result<void> check_points(std::span<const Vec3> points, std::string_view what) {
  bool within = true;
  for (const Vec3& point : points) within = within && is_within(point);
  if (within) return {};
  const auto bad = std::find_if_not(points.begin(), points.end(), is_within);
  return Error{std::string{what} + " " + std::to_string(bad - points.begin()) +
               " has a coordinate that is not a number or beyond 1e8 m"};
}

}  // namespace

std::string_view to_string(PlaceMethod method) {
  const auto index = static_cast<std::size_t>(method);
  return index < kNames.size() ? kNames[index] : "unknown";
}

std::optional<PlaceMethod> place_method(std::string_view name) {
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) return std::nullopt;
  return static_cast<PlaceMethod>(found - kNames.begin());
}

Result<void> check_places(std::span<const Vec3> vehicles, std::span<const Vec3> places) {
  if (vehicles.size() != places.size()) {
    return Error{std::to_string(vehicles.size()) + " vehicles cannot take " +
                 std::to_string(places.size()) + " places one each: give equally many"};
  }
  if (auto checked = check_points(vehicles, "vehicle"); !checked) return checked;
  return check_points(places, "place");
}

PlaceLengths lengths_of(std::span<const int> place_of, std::span<const Vec3> vehicles,
                        std::span<const Vec3> places) {
  PlaceLengths lengths;
  for (std::size_t i = 0; i < place_of.size(); ++i) {
    const double square =
        (vehicles[i] - places[static_cast<std::size_t>(place_of[i])]).squaredNorm();
    const double length = std::sqrt(square);
    lengths.sum_m += length;
    lengths.sum_of_squares_m2 += square;
    lengths.longest_m = std::max(lengths.longest_m, length);
  }
  return lengths;
}

Result<PlaceAssignment> assign_places(const PlaceParams& params, std::span<const Vec3> vehicles,
                                      std::span<const Vec3> places, Random random,
                                      const planning::PlanningBudget& budget) {
  PlaceAssignment result;
  if (params.method != PlaceMethod::colony) {
    PlaceSolver solver;
    if (auto solved = solver.solve(params.method, vehicles, places, result); !solved) {
      return solved.error();
    }
    return result;
  }
  if (auto checked = check_places(vehicles, places); !checked) return checked.error();
  const PlaceColonyParams& colony = params.colony;
  if (!(colony.threat_weight >= 0.0 && colony.threat_weight <= 1.0)) {
    return Error{"the colony's weight of the threat, k1, must be from 0 to 1, not " +
                 std::to_string(colony.threat_weight)};
  }
  if (colony.ants < 1 || colony.iterations < 1) {
    return Error{"the colony needs at least one ant and one iteration"};
  }
  result.method = PlaceMethod::colony;
  result.place_of = colony_places(colony, vehicles, places, random, budget);
  return result;
}

}  // namespace skein::formation
