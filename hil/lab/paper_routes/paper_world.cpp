// SPDX-License-Identifier: Apache-2.0
#include "skein/paper_routes/paper_world.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "skein/base/angles.hpp"

namespace skein::routes {
namespace {

constexpr std::size_t kRandomHazards = 10;

RouteHazard detection(double x, double y, double radius_m, double k_m) {
  return {
      .kind = HazardKind::detection, .centre = {x, y}, .radius_m = radius_m, .inner_radius_m = k_m};
}
RouteHazard keep_out(double x, double y, double radius_m) {
  return {.kind = HazardKind::keep_out, .centre = {x, y}, .radius_m = radius_m};
}
RouteHazard ramp(double x, double y, double radius_m, double inner_radius_m, double peak) {
  return {.kind = HazardKind::ramp,
          .centre = {x, y},
          .radius_m = radius_m,
          .inner_radius_m = inner_radius_m,
          .peak = peak};
}

void number(std::vector<RouteHazard>& hazards) {
  std::uint16_t id = 0;
  for (RouteHazard& hazard : hazards) hazard.id = HazardId{++id};
}

RouteHazard random_hazard(Random& random) {
  const Vec2 centre{random.uniform(0.0, 1000.0), random.uniform(0.0, 1000.0)};
  const double radius = random.uniform(50.0, 175.0);
  const double share = random.uniform(0.65, 0.75);
  switch (random.index(3)) {
    case 0:
      return detection(centre.x(), centre.y(), radius, random.uniform(0.75, 0.85));
    case 1:
      return ramp(centre.x(), centre.y(), radius, share * radius, random.uniform(0.8, 1.0));
    default:
      return keep_out(centre.x(), centre.y(), radius);
  }
}

}  // namespace

std::vector<RouteHazard> paper_hazards() {
  std::vector<RouteHazard> hazards = {
      detection(334.2, 698.8, 173.7, 0.77),  keep_out(30.67, 744.1, 69.7),
      keep_out(480, 904.8, 115.1),           ramp(576.8, 183, 160.9, 107.8, 0.9),
      ramp(886.6, 28.7, 76, 56.24, 0.82),    detection(168, 978.7, 113.5, 0.81),
      ramp(500.5, 471.1, 147, 108.78, 0.99), keep_out(682, 42.5, 49),
      ramp(521.7, 96.8, 50.8, 37.08, 0.97),  ramp(659.7, 518.6, 62.6, 43.75, 0.97)};
  number(hazards);
  return hazards;
}

std::vector<Vec2> paper_starts() { return {{0, 0}, {10, 350}, {360, 30}}; }

Vec2 paper_site() { return {990, 990}; }

CurveProblem paper_curve(const Vec2& start) {
  return {.start = start,
          .site = paper_site(),
          .hazards = paper_hazards(),
          .reading = CostReading::as_printed};
}

CurveProblem random_curve(Random random) {
  CurveProblem problem{.start = paper_starts().front(),
                       .site = paper_site(),
                       .hazards = {},
                       .reading = CostReading::as_printed};
  while (problem.hazards.size() < kRandomHazards) {
    const RouteHazard hazard = random_hazard(random);
    if (hazard.value_at(problem.start) == 0.0 && hazard.value_at(problem.site) == 0.0) {
      problem.hazards.push_back(hazard);
    }
  }
  number(problem.hazards);
  return problem;
}

RouteProblem paper_team() {
  RouteProblem problem{.site = paper_site(), .hazards = paper_hazards()};
  problem.rules.last_leg_m = 100.0;
  problem.rules.separation_m = 30.0;
  const std::array<std::pair<Vec2, double>, 3> cases = {
      {{{10, 350}, 150}, {{0, 0}, 270}, {{360, 30}, 390}}};
  for (const auto& [start, entry_deg] : cases) {
    RouteVehicle vehicle;
    vehicle.id = VehicleId{static_cast<std::uint16_t>(problem.vehicles.size() + 1)};
    vehicle.start = start;
    vehicle.speed_mps = 20.0;
    vehicle.turn_radius_m = 20.0;
    vehicle.range_m = 2500.0;
    vehicle.approach_heading_rad = wrap_pi(radians(entry_deg) + kPi);
    problem.vehicles.push_back(vehicle);
  }
  return problem;
}

RouteProblem random_team(std::size_t vehicles, std::size_t hazards, Random random) {
  constexpr double kFree_m = 300.0;
  constexpr double kStartsApart_m = 40.0;
  const double side = 1000.0 * std::sqrt(static_cast<double>(hazards) / 10.0);
  RouteProblem problem;
  problem.site = {0.8 * side, 0.8 * side};
  problem.rules.last_leg_m = 150.0;
  problem.rules.separation_m = 20.0;
  while (problem.hazards.size() < hazards) {
    RouteHazard hazard =
        keep_out(random.uniform(0.0, side), random.uniform(0.0, side), random.uniform(50.0, 150.0));
    const bool near_edge = hazard.centre.minCoeff() < hazard.radius_m + kStartsApart_m;
    if ((hazard.centre - problem.site).norm() > hazard.radius_m + kFree_m && !near_edge) {
      problem.hazards.push_back(hazard);
    }
  }
  number(problem.hazards);
  const double first = random.uniform(-kPi, kPi);
  while (problem.vehicles.size() < vehicles) {
    const double along = random.uniform(0.0, side);
    RouteVehicle vehicle;
    vehicle.start = random.chance(0.5) ? Vec2{0.0, along} : Vec2{along, 0.0};
    const bool crowded = std::any_of(problem.vehicles.begin(), problem.vehicles.end(),
                                     [&](const RouteVehicle& other) {
                                       return (other.start - vehicle.start).norm() < kStartsApart_m;
                                     });
    if (crowded) continue;
    const auto k = static_cast<double>(problem.vehicles.size());
    vehicle.id = VehicleId{static_cast<std::uint16_t>(problem.vehicles.size() + 1)};
    vehicle.speed_mps = 20.0;
    vehicle.turn_radius_m = 20.0;
    vehicle.range_m = 4.0 * side;
    vehicle.approach_heading_rad = wrap_pi(first + k * kTwoPi / static_cast<double>(vehicles));
    problem.vehicles.push_back(vehicle);
  }
  return problem;
}

}  // namespace skein::routes
