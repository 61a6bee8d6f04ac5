// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <limits>

#include "process_fields.hpp"
#include "skein/configuration/routes_config.hpp"
#include "skein/routes/fly_by.hpp"

namespace skein::configuration {
namespace {

constexpr std::array<std::string_view, 2> kClosed{"closed", "cost"};
constexpr Range kRadius{0.0, 1e5, "m"};
constexpr Range kSpeed{0.1, 300.0, "m/s"};

void site_point(FieldVisitor& v, Vec2& site) {
  v.number({"east_m", "of the site", kRequired}, kMetres, site.x());
  v.number({"north_m", "of the site", kRequired}, kMetres, site.y());
}

void approach_fields(FieldVisitor& v, RouteApproach& approach) {
  id(v, {"vehicle", "whose route it is", kRequired}, approach.vehicle);
  compass(v, {"bearing_deg", "compass direction of travel over the site", kRequired},
          approach.heading_rad);
  v.number({"offset_s", "arrives so much after the common time"}, kSeconds, approach.offset_s);
  angle(v, {"start_cone_deg", "most between the first leg and the start's heading"},
        {0.0, 180.0, "deg"}, approach.start_cone_rad);
}

void route_hazard_fields(FieldVisitor& v, routes::RouteHazard& hazard) {
  id(v, {"id", "number of the hazard, its own", kRequired}, hazard.id);
  std::array<std::string_view, static_cast<std::size_t>(routes::HazardKind::count)> kinds;
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    kinds.at(i) = routes::to_string(static_cast<routes::HazardKind>(i));
  }
  auto kind = static_cast<std::size_t>(hazard.kind);
  v.choice({"kind", "what being near costs", kRequired}, kinds, kind);
  hazard.kind = static_cast<routes::HazardKind>(kind);
  v.number({"east_m", "centre", kRequired}, kMetres, hazard.centre.x());
  v.number({"north_m", "centre", kRequired}, kMetres, hazard.centre.y());
  v.number({"radius_m", "outside of it is none", kRequired}, {1.0, 1e5, "m"}, hazard.radius_m);
  v.number({"inner_radius_m", "inside of it is most"}, kRadius, hazard.inner_radius_m);
  v.number({"peak", "most, of a ramp"}, {0.0, 1000.0}, hazard.peak);
  v.require(hazard.inner_radius_m < hazard.radius_m, "inner_radius_m",
            "must be less than radius_m; lower it");
}

void closed(FieldVisitor& v, const Field& field, bool& value) {
  std::size_t index = value ? 0 : 1;
  v.choice(field, kClosed, index);
  value = index == 0;
}

void rules_fields(FieldVisitor& v, routes::RouteRules& rules) {
  v.number({"last_leg_m", "straight run into the site"}, {1.0, 1e5, "m"}, rules.last_leg_m);
  angle(v, {"turn_max_deg", "most at one waypoint"}, {1.0, 179.0, "deg"}, rules.turn_max_rad);
  whole(v, {"waypoints_max", "start and site included"},
        {3.0, static_cast<double>(routes::kWaypointsMax)}, rules.waypoints_max);
  v.number({"separation_m", "least distance of two vehicles on their ways; 0: not asked for"},
           kRadius, rules.separation_m);
  std::optional<double> contact;
  if (std::isfinite(rules.contact_m)) contact = rules.contact_m;
  v.number({"contact_m", "wished for as the largest distance of two"}, kRadius, contact);
  rules.contact_m = contact.value_or(std::numeric_limits<double>::infinity());
  v.number({"clearance_m", "beyond the radius of what is closed"}, kRadius, rules.clearance_m);
  closed(v, {"detections", "whether they may be entered at a cost; keep-outs never may"},
         rules.detections_closed);
  closed(v, {"ramps", "the same of these"}, rules.ramps_closed);
}

void weights_fields(FieldVisitor& v, routes::CostWeights& weights) {
  const Range weight{0.0, 1000.0};
  v.number({"exposure_weight", "of the hazards' values along the way"}, weight, weights.exposure);
  v.number({"length_weight", "of the length over the straight distance"}, weight, weights.length);
  v.number({"turning_weight", "of differences between successive turns"}, weight, weights.turning);
}

void vehicle_route_fields(FieldVisitor& v, VehicleRoute& route) {
  id(v, {"vehicle", "whose route it is", kRequired}, route.vehicle);
  compass(v, {"bearing_deg", "compass direction of travel over the site", kRequired},
          route.heading_rad);
  v.number({"arrival_s", "mission time over the site", kRequired}, kSeconds, route.arrival_s);
  v.number({"length_m", "of legs and arcs", kRequired}, {0.0, 1e7, "m"}, route.length_m);
  v.number({"bound_m", "no route is shorter"}, {0.0, 1e7, "m"}, route.bound_m);
  flight_route_fields(v, route.route);
}

}  // namespace

void flight_route_fields(FieldVisitor& v, FlightRoute& route) {
  v.number({"turn_radius_m", "of the arcs"}, kRadius, route.turn_radius_m);
  v.number({"speed_mps", "over the ground"}, {0.0, 300.0, "m/s"}, route.speed_mps);
  v.list({"waypoints", "from the start to the site"},
         list_of(route.waypoints, routes::kWaypointsMax,
                 [](FieldVisitor& inner, Vec2& point) { inner.point({}, kMetres, point); }));
  v.require(route.waypoints.empty() || route.speed_mps >= kSpeed.low, "speed_mps",
            "must be above 0 m/s where there are waypoints");
}

void flight_route_section(FieldVisitor& v, FlightRoute& route) {
  v.section({"route", "flown from mission time 0 on, before anything else; none without waypoints"},
            [&route](FieldVisitor& inner) { flight_route_fields(inner, route); });
}

void routes_section(FieldVisitor& v, RoutesConfig& config) {
  v.section({"routes", "planned together before the mission; none without approaches"},
            [&config](FieldVisitor& inner) {
              inner.number({"site_east_m", "where they end"}, kMetres, config.site.x());
              inner.number({"site_north_m", "where they end"}, kMetres, config.site.y());
              inner.list({"approaches", "one for each vehicle that has a route"},
                         unique_groups_of(
                             config.approaches, kVehiclesMax, approach_fields, "vehicle",
                             [](const RouteApproach& approach) { return approach.vehicle.value; }));
              inner.list({"hazards", "known before the mission"},
                         unique_groups_of(
                             config.hazards, kListMax, route_hazard_fields, "hazard",
                             [](const routes::RouteHazard& hazard) { return hazard.id.value; }));
              rules_fields(inner, config.rules);
              weights_fields(inner, config.weights);
            });
}

void fields(FieldVisitor& v, RoutePlan& plan) {
  version_field(v);
  v.text({"title", "one line", kRequired}, plan.title);
  whole(v, {"seed", "with which it was planned"}, {0.0, 9e18}, plan.seed);
  v.section({"site", "where the routes end", kRequired},
            [&plan](FieldVisitor& inner) { site_point(inner, plan.site); });
  v.number({"arrival_s", "the common mission time over the site", kRequired}, kSeconds,
           plan.arrival_s);
  v.number({"bound_s", "no plan has an earlier one"}, kSeconds, plan.bound_s);
  v.list({"routes", "one for each vehicle", kRequired},
         unique_groups_of(plan.routes, kVehiclesMax, vehicle_route_fields, "vehicle",
                          [](const VehicleRoute& route) { return route.vehicle.value; }));
}

}  // namespace skein::configuration
