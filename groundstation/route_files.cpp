// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "skein/base/angles.hpp"
#include "skein/codec/json_text.hpp"
#include "skein/groundstation/route_planning.hpp"
#include "skein/routes/fly_by.hpp"

namespace skein::groundstation {
namespace {

using codec::Json;
using configuration::Scenario;
using configuration::VehicleRoute;

constexpr double kStep_m = 10.0;  ///< between points of what is flown

/// What is said of heights: of the vehicle's layer above the origin, and of the geoid there.
struct Heights {
  double layer_m = 0.0;
  double geoid_m = 0.0;
};

Heights heights_of(const Scenario& scenario, VehicleId id) {
  for (const auto& vehicle : scenario.vehicles) {
    if (vehicle.spec.id == id) {
      return {vehicle.spec.height_m, vehicle.flight_controller.ardupilot.geoid_height_m};
    }
  }
  return {};
}

/// What is flown: legs and arcs.
std::vector<Vec2> flown(const VehicleRoute& route) {
  std::vector<Vec2> points;
  const auto path = routes::fly_by_path(route.route.waypoints, route.route.turn_radius_m);
  if (!path) return route.route.waypoints;
  const double length = path->length_m();
  const auto steps = static_cast<std::size_t>(std::ceil(length / kStep_m));
  for (std::size_t i = 0; i <= steps; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(steps);
    points.push_back(path->pose_at(share * length).position());
  }
  return points;
}

Wgs84 on_earth(const MissionOrigin& origin, const Vec2& point, double height_m = 0.0) {
  return origin.to_wgs84({point.x(), point.y(), height_m});
}

double decimals(double value, int count) {
  const double scale = std::pow(10.0, count);
  return std::round(value * scale) / scale;
}

/// A height, where it is there, is above the ellipsoid (RFC 7946, section 4).
Json geojson_place(const Wgs84& p) {
  return {decimals(p.longitude_deg, 7), decimals(p.latitude_deg, 7)};
}
Json geojson_position(const Wgs84& p) {
  Json position = geojson_place(p);
  position.push_back(decimals(p.height_m, 1));
  return position;
}

Json feature(Json properties, const char* type, Json coordinates) {
  return {{"type", "Feature"},
          {"properties", std::move(properties)},
          {"geometry", {{"type", type}, {"coordinates", std::move(coordinates)}}}};
}

std::string xml_escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    out += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
  }
  return out;
}

/// After Okabe and Ito (2008), for the colour-blind too.
constexpr std::array<std::string_view, 6> kColours{"#0072b2", "#d55e00", "#00875f",
                                                   "#b8578f", "#c98500", "#3a9fd6"};
std::string_view colour(std::size_t index) { return kColours.at(index % kColours.size()); }

Json circle_ring(const routes::RouteHazard& hazard, const MissionOrigin& origin) {
  constexpr int kCorners = 64;
  Json ring = Json::array();
  for (int i = 0; i <= kCorners; ++i) {
    const Vec2 at =
        hazard.centre + hazard.radius_m * unit_vector(2.0 * kPi * (i % kCorners) / kCorners);
    ring.push_back(geojson_place(on_earth(origin, at)));
  }
  return ring;
}

}  // namespace

std::string routes_geojson(const PlannedRoutes& planned, const Scenario& scenario,
                           const MissionOrigin& origin) {
  Json features = Json::array();
  for (const VehicleRoute& route : planned.file.routes) {
    const double layer_m = heights_of(scenario, route.vehicle).layer_m;
    Json line = Json::array();
    for (const Vec2& point : flown(route)) {
      line.push_back(geojson_position(on_earth(origin, point, layer_m)));
    }
    features.push_back(feature({{"vehicle", route.vehicle.value},
                                {"arrival_s", decimals(route.arrival_s, 3)},
                                {"length_m", decimals(route.length_m, 2)},
                                {"speed_mps", decimals(route.route.speed_mps, 2)},
                                {"height_above_origin_m", decimals(layer_m, 1)}},
                               "LineString", std::move(line)));
  }
  for (const routes::RouteHazard& hazard : planned.problem.hazards) {
    features.push_back(feature({{"hazard", hazard.id.value},
                                {"kind", routes::to_string(hazard.kind)},
                                {"radius_m", decimals(hazard.radius_m, 1)}},
                               "Polygon", Json::array({circle_ring(hazard, origin)})));
  }
  features.push_back(
      feature({{"site", true}}, "Point", geojson_place(on_earth(origin, planned.problem.site))));
  return codec::json_text({{"type", "FeatureCollection"}, {"features", std::move(features)}}) +
         "\n";
}

std::string routes_kml(const PlannedRoutes& planned, const Scenario& scenario,
                       const MissionOrigin& origin) {
  std::string text = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<kml xmlns=\"http://www.opengis.net/kml/2.2\"><Document><name>{}</name>\n",
      xml_escaped(planned.file.title));
  for (const VehicleRoute& route : planned.file.routes) {
    const Heights heights = heights_of(scenario, route.vehicle);
    text += fmt::format(
        "<Placemark><name>vehicle {}</name><description>over the site at {:.2f} s, {:.1f} m above "
        "the mission's origin; heights are above sea level, of a geoid {:.1f} m above the ellipsoid"
        "</description><LineString><altitudeMode>absolute</altitudeMode><coordinates>",
        route.vehicle.value, route.arrival_s, heights.layer_m, heights.geoid_m);
    for (const Vec2& point : flown(route)) {
      const Wgs84 p = on_earth(origin, point, heights.layer_m);
      text += fmt::format("{:.7f},{:.7f},{:.1f} ", p.longitude_deg, p.latitude_deg,
                          p.height_m - heights.geoid_m);
    }
    text += "</coordinates></LineString></Placemark>\n";
  }
  const Wgs84 site = on_earth(origin, planned.problem.site);
  text += fmt::format(
      "<Placemark><name>site</name><Point><coordinates>{:.7f},{:.7f}</coordinates></Point>"
      "</Placemark>\n</Document></kml>\n",
      site.longitude_deg, site.latitude_deg);
  return text;
}

std::string routes_qgc(const VehicleRoute& route, const Scenario& scenario,
                       const MissionOrigin& origin) {
  constexpr int kWaypoint = 16;      // MAV_CMD_NAV_WAYPOINT
  constexpr int kChangeSpeed = 178;  // MAV_CMD_DO_CHANGE_SPEED
  constexpr int kGlobalRelative = 3;
  constexpr int kMissionFrame = 2;
  constexpr int kFixedWing = 1;
  constexpr int kArdupilot = 3;
  const Heights heights = heights_of(scenario, route.vehicle);
  const Wgs84& home = origin.origin();
  const double speed_mps = decimals(route.route.speed_mps, 2);
  Json items = Json::array({{{"type", "SimpleItem"},
                             {"command", kChangeSpeed},
                             {"frame", kMissionFrame},
                             {"autoContinue", true},
                             {"doJumpId", 1},
                             {"params", {1, speed_mps, -1, 0, 0, 0, 0}}}});
  for (const Vec2& point : route.route.waypoints) {
    const Wgs84 p = on_earth(origin, point, heights.layer_m);
    const double above_home_m = decimals(p.height_m - home.height_m, 1);
    items.push_back({{"type", "SimpleItem"},
                     {"command", kWaypoint},
                     {"frame", kGlobalRelative},
                     {"autoContinue", true},
                     {"doJumpId", items.size() + 1},
                     {"Altitude", above_home_m},
                     {"AltitudeMode", 1},
                     {"AMSLAltAboveTerrain", nullptr},
                     {"params",
                      {0, 0, 0, nullptr, decimals(p.latitude_deg, 7), decimals(p.longitude_deg, 7),
                       above_home_m}}});
  }
  const Json plan{
      {"fileType", "Plan"},
      {"version", 1},
      {"groundStation", "Skein"},
      {"geoFence", {{"circles", Json::array()}, {"polygons", Json::array()}, {"version", 2}}},
      {"rallyPoints", {{"points", Json::array()}, {"version", 2}}},
      {"mission",
       {{"version", 2},
        {"firmwareType", kArdupilot},
        {"vehicleType", kFixedWing},
        {"cruiseSpeed", speed_mps},
        {"hoverSpeed", 5},
        {"globalPlanAltitudeMode", 1},
        {"plannedHomePosition",
         {decimals(home.latitude_deg, 7), decimals(home.longitude_deg, 7),
          decimals(home.height_m - heights.geoid_m, 1)}},
        {"items", std::move(items)}}}};
  return codec::json_text(plan) + "\n";
}

std::string routes_svg(const PlannedRoutes& planned) {
  constexpr double kWidth = 800.0;
  constexpr double kMargin = 30.0;
  Vec2 low = planned.problem.site;
  Vec2 high = planned.problem.site;
  const auto see = [&](const Vec2& p, double around) {
    low = low.cwiseMin(Vec2{p.x() - around, p.y() - around});
    high = high.cwiseMax(Vec2{p.x() + around, p.y() + around});
  };
  std::vector<std::vector<Vec2>> lines;
  for (const VehicleRoute& route : planned.file.routes) {
    lines.push_back(flown(route));
    for (const Vec2& p : lines.back()) see(p, 0.0);
  }
  for (const auto& hazard : planned.problem.hazards) see(hazard.centre, hazard.radius_m);
  const double scale = (kWidth - 2.0 * kMargin) / std::max(1.0, (high - low).maxCoeff());
  const double height = (high.y() - low.y()) * scale + 2.0 * kMargin;
  const auto x = [&](double east) { return kMargin + (east - low.x()) * scale; };
  const auto y = [&](double north) { return height - kMargin - (north - low.y()) * scale; };
  std::string text = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" "
      "width=\"{0:.0f}\" height=\"{1:.0f}\" font-family=\"system-ui,sans-serif\" font-size=\"13\">"
      "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
      kWidth, height);
  for (const auto& hazard : planned.problem.hazards) {
    const bool closed = planned.problem.closed(hazard);
    text += fmt::format(
        "<g fill=\"{}\" fill-opacity=\"{}\" stroke=\"#7a838d\"{}><circle cx=\"{:.1f}\" "
        "cy=\"{:.1f}\" r=\"{:.1f}\"/><circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\"/>"
        "<title>{} {}</title></g>\n",
        hazard.kind == routes::HazardKind::keep_out ? "#7a838d" : "#e0b050", closed ? 0.35 : 0.15,
        closed ? "" : " stroke-dasharray=\"4 3\"", x(hazard.centre.x()), y(hazard.centre.y()),
        hazard.radius_m * scale, x(hazard.centre.x()), y(hazard.centre.y()),
        hazard.inner_radius_m * scale, routes::to_string(hazard.kind), hazard.id.value);
  }
  for (std::size_t i = 0; i < lines.size(); ++i) {
    std::string points;
    for (const Vec2& p : lines[i]) points += fmt::format("{:.1f},{:.1f} ", x(p.x()), y(p.y()));
    const VehicleRoute& route = planned.file.routes[i];
    text += fmt::format(
        "<polyline points=\"{0}\" fill=\"none\" stroke=\"{1}\" stroke-width=\"2\"/>"
        "<circle cx=\"{2:.1f}\" cy=\"{3:.1f}\" r=\"5\" fill=\"{1}\"/>"
        "<text x=\"{4:.1f}\" y=\"{5:.1f}\" fill=\"{1}\">vehicle {6}, {7:.1f} m</text>\n",
        points, colour(i), x(lines[i].front().x()), y(lines[i].front().y()),
        x(lines[i].front().x()) + 9.0, y(lines[i].front().y()) - 7.0, route.vehicle.value,
        route.length_m);
    for (const Vec2& p : route.route.waypoints) {
      text += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.5\" fill=\"{}\"/>", x(p.x()),
                          y(p.y()), colour(i));
    }
  }
  text += fmt::format(
      "<path d=\"M{0:.1f} {1:.1f}m-7 0h14m-7 -7v14\" stroke=\"#1c2530\" stroke-width=\"2\"/>"
      "<text x=\"{2:.1f}\" y=\"{3:.1f}\" text-anchor=\"end\" fill=\"#1c2530\">site, {4:.1f} "
      "s</text>"
      "</svg>\n",
      x(planned.problem.site.x()), y(planned.problem.site.y()), x(planned.problem.site.x()) - 9.0,
      y(planned.problem.site.y()) - 9.0, planned.plan.arrival_s);
  return text;
}

}  // namespace skein::groundstation
