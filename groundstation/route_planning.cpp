// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/route_planning.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <system_error>

#include "plan_folder.hpp"
#include "skein/base/angles.hpp"
#include "skein/base/random.hpp"

namespace skein::groundstation {
namespace {

using configuration::RoutePlan;
using configuration::Scenario;

RoutePlan file_of(const Scenario& scenario, const routes::RouteProblem& problem,
                  const routes::CooperativePlan& plan) {
  RoutePlan file;
  file.title = scenario.title;
  file.seed = scenario.seed;
  file.site = problem.site;
  file.arrival_s = plan.arrival_s;
  file.bound_s = plan.bound_s;
  for (std::size_t i = 0; i < plan.routes.size(); ++i) {
    const routes::PlannedRoute& route = plan.routes[i];
    const routes::RouteVehicle& vehicle = problem.vehicles[i];
    file.routes.push_back({route.id,
                           {route.waypoints, vehicle.turn_radius_m, vehicle.speed_mps},
                           vehicle.approach_heading_rad,
                           route.arrival_s,
                           route.length_m,
                           route.bound_m});
  }
  return file;
}

/// Is it a vehicle-N.plan, as write_routes() names them?
bool is_vehicle_plan(const std::string& name) {
  constexpr std::string_view kBegin = "vehicle-";
  constexpr std::string_view kEnd = ".plan";
  if (name.size() <= kBegin.size() + kEnd.size() || !name.starts_with(kBegin) ||
      !name.ends_with(kEnd)) {
    return false;
  }
  return std::all_of(name.begin() + kBegin.size(), name.end() - kEnd.size(),
                     [](char c) { return c >= '0' && c <= '9'; });
}

/// Of an earlier plan into the same folder: nobody should load them.
Result<void> delete_vehicle_plans(const std::filesystem::path& folder) {
  std::error_code failed;
  std::vector<std::filesystem::path> old;
  for (const auto& entry : std::filesystem::directory_iterator{folder, failed}) {
    if (is_vehicle_plan(entry.path().filename().string())) old.push_back(entry.path());
  }
  for (const auto& file : old) {
    if (!failed) std::filesystem::remove(file, failed);
  }
  if (failed)
    return Error{folder.string() + ": an old plan cannot be deleted: " + failed.message()};
  return {};
}

}  // namespace

Result<PlannedRoutes> plan_routes(const Scenario& scenario,
                                  const routes::RoutePlannerParams& params) {
  if (!scenario.flies_routes()) {
    return Error{"the mission plans no routes; name its vehicles under routes.approaches"};
  }
  PlannedRoutes planned;
  planned.problem = configuration::route_problem(scenario);
  auto plan = routes::plan_routes(planned.problem, params, Random{scenario.seed});
  if (!plan) return plan.error();
  planned.plan = *std::move(plan);
  planned.check = routes::check_routes(planned.problem, planned.plan);
  planned.file = file_of(scenario, planned.problem, planned.plan);
  for (auto& out : configuration::outside_fence(planned.file, scenario)) {
    planned.check.violations.push_back(std::move(out));
  }
  return planned;
}

std::string routes_text(const PlannedRoutes& planned) {
  const routes::CooperativePlan& plan = planned.plan;
  std::string text = fmt::format(
      "{} routes, together over the site at {:.2f} s; no plan can be there before {:.2f} s "
      "({:+.2f} %)\n\n"
      "vehicle  length m   bound m  waypoints  exposure  length/straight  turning  bearing off  "
      "clear by\n",
      plan.routes.size(), plan.arrival_s, plan.bound_s,
      100.0 * (plan.arrival_s / plan.bound_s - 1.0));
  for (std::size_t i = 0; i < plan.routes.size(); ++i) {
    const routes::PlannedRoute& route = plan.routes[i];
    const routes::RouteMeasures& measured = planned.check.routes.at(i);
    const std::string clearance =
        std::isfinite(measured.clearance_m) ? fmt::format("{:.1f} m", measured.clearance_m) : "-";
    text += fmt::format(
        "{:>7}  {:8.1f}  {:8.1f}  {:>9}  {:8.3f}  {:15.3f}  {:7.3f}  {:7.3f} deg  {:>8}\n",
        route.id.value, route.length_m, route.bound_m, route.waypoints.size(), route.costs.exposure,
        route.costs.length_ratio, route.costs.turning, degrees(measured.bearing_error_rad),
        clearance);
  }
  text += fmt::format(
      "\ntotal cost {:.3f}, of which spacing {:.3f}; arrivals within {:.4f} s of each other",
      plan.total_cost, plan.spacing_cost, planned.check.arrival_spread_s);
  if (std::isfinite(planned.check.separation_m)) {
    text += fmt::format("; least separation {:.1f} m, at {:.1f} s", planned.check.separation_m,
                        planned.check.separation_at_s);
  }
  text += fmt::format("; {} routes tried\n", plan.evaluations);
  for (const routes::Violation& violation : planned.check.violations) {
    text += fmt::format("broken: vehicle {}: {}\n", violation.vehicle.value, violation.message);
  }
  text += planned.check.ok() ? "every rule holds\n" : "";
  return text;
}

Result<std::vector<std::string>> write_routes(const PlannedRoutes& planned,
                                              const Scenario& scenario,
                                              const std::filesystem::path& folder) {
  const auto origin = MissionOrigin::make(scenario.origin);
  if (!origin) return origin.error();
  if (auto made = make_folder(folder); !made) return made.error();
  if (auto deleted = delete_vehicle_plans(folder); !deleted) return deleted.error();
  NamedTexts files{{"plan.yaml", to_yaml(planned.file)},
                   {"routes.geojson", routes_geojson(planned, scenario, *origin)},
                   {"routes.kml", routes_kml(planned, scenario, *origin)},
                   {"routes.svg", routes_svg(planned)}};
  for (const configuration::VehicleRoute& route : planned.file.routes) {
    files.emplace_back(fmt::format("vehicle-{}.plan", route.vehicle.value),
                       routes_qgc(route, scenario, *origin));
  }
  return write_files(folder, files);
}

}  // namespace skein::groundstation
