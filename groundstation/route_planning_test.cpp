// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/route_planning.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>

namespace skein::groundstation {
namespace {

using ::testing::HasSubstr;

configuration::Scenario routes_3() {
  auto scenario = configuration::load_scenario(SKEIN_SOURCE_DIR "/scenarios/routes-3.yaml");
  EXPECT_TRUE(scenario.ok()) << scenario.error().message;
  EXPECT_TRUE(configuration::check(*scenario).ok());
  return *scenario;
}

TEST(RoutePlanning, PlansTheShippedMissionAndItsFileIsReadBack) {
  const auto scenario = routes_3();
  const auto planned = plan_routes(scenario);
  ASSERT_TRUE(planned.ok()) << planned.error().message;
  EXPECT_TRUE(planned->check.ok()) << routes_text(*planned);
  EXPECT_LT(planned->plan.arrival_s, 1.005 * planned->plan.bound_s);
  EXPECT_THAT(routes_text(*planned), HasSubstr("every rule holds"));

  const auto read = configuration::parse_route_plan(to_yaml(planned->file), "plan.yaml");
  ASSERT_TRUE(read.ok()) << read.error().message;
  auto given = scenario;
  ASSERT_TRUE(configuration::give_routes(*read, given).ok());
  const auto ends = configuration::route_ends(given);
  ASSERT_EQ(ends.size(), 3U);
  for (const auto& end : ends) {
    EXPECT_NEAR(to_seconds(end.planned), planned->plan.arrival_s, 0.01);
  }
  for (const auto& vehicle : given.vehicles) {
    const auto path = configuration::timed_path(vehicle.route, vehicle.spec);
    ASSERT_TRUE(path.ok() && path->has_value());
    EXPECT_LE((*path)->path.curvature_max_per_m(), 1.0 / vehicle.spec.turn_radius_m);
    EXPECT_NEAR((*path)->path.start.heading_rad, vehicle.start.heading_rad, 1e-9);
  }
  EXPECT_EQ(given.hazards.size(), scenario.hazards.size() + scenario.routes.hazards.size());
}

TEST(RoutePlanning, APlanForOthersIsRefused) {
  const auto scenario = routes_3();
  auto plan = plan_routes(scenario)->file;
  auto given = scenario;
  const auto good = plan;
  plan.routes[0].route.turn_radius_m = 1.0;
  auto refused = configuration::give_routes(plan, given);
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().message, HasSubstr("tighter than paths of the vehicle"));
  plan = good;
  plan.routes[0].route.speed_mps = 60.0;
  refused = configuration::give_routes(plan, given);
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().message, HasSubstr("none that the vehicle flies"));
  plan = good;
  plan.routes.pop_back();
  refused = configuration::give_routes(plan, given);
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().message, HasSubstr("no route for vehicle 3"));
  // The world has changed since: a hazard on the way, one beyond the site, another site.
  const auto refused_in = [&](auto&& change) {
    auto changed = scenario;
    change(changed);
    const auto why = configuration::give_routes(good, changed);
    return why ? std::string{"none"} : why.error().message;
  };
  EXPECT_THAT(refused_in([&](auto& s) {
                s.hazards.push_back({{{77}, good.routes[1].route.waypoints[1], 20.0}, Instant{}});
              }),
              HasSubstr("enters hazard 77"));
  EXPECT_THAT(refused_in([&](auto& s) {
                s.hazards.push_back({{{78}, {990.0, 1040.0}, 20.0}, Instant{}});
              }),
              HasSubstr("enters hazard 78"));
  EXPECT_THAT(refused_in([](auto& s) { s.routes.site.x() += 5.0; }), HasSubstr("another site"));
  EXPECT_THAT(refused_in([](auto& s) { s.vehicles[0].start.x_m += 50.0; }),
              HasSubstr("breaks a rule"));
  plan = good;
  plan.routes[0].vehicle = {77};
  refused = configuration::give_routes(plan, given);
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().message, HasSubstr("vehicle 77 has a route, and is not in"));
}

TEST(RoutePlanning, APlanThatLeadsOutOfTheFenceIsRefused) {
  auto scenario = routes_3();
  const auto good = plan_routes(scenario)->file;
  const Vec2 bend = good.routes[1].route.waypoints[1];
  const Vec2 start = good.routes[1].route.waypoints[0];
  const double edge = start.x() + 0.5 * (bend.x() - start.x());
  const double far = bend.x() > start.x() ? -1e5 : 1e5;
  scenario.fence.corners = {{edge, -1e5}, {far, -1e5}, {far, 1e5}, {edge, 1e5}};
  const auto planned = plan_routes(scenario);
  ASSERT_TRUE(planned.ok()) << planned.error().message;
  EXPECT_FALSE(planned->check.ok());
  EXPECT_THAT(routes_text(*planned), HasSubstr("leads out of the fence at ["));
  const auto refused = configuration::give_routes(good, scenario);
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().message, HasSubstr("leads out of the fence at ["));
}

TEST(RoutePlanning, AMissionWithoutRoutesIsRefusedInASentence) {
  const auto refused = plan_routes({});
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().message, HasSubstr("routes.approaches"));
}

TEST(RoutePlanning, WritesWhatOthersRead) {
  const auto scenario = routes_3();
  const auto planned = plan_routes(scenario);
  ASSERT_TRUE(planned.ok());
  const auto folder =
      std::filesystem::temp_directory_path() / ("skein-routes-" + std::to_string(::getpid()));
  const auto files = write_routes(*planned, scenario, folder);
  ASSERT_TRUE(files.ok()) << files.error().message;
  EXPECT_EQ(files->size(), 7U);
  const auto text_of = [&](const std::string& name) {
    std::stringstream text;
    text << std::ifstream{folder / name}.rdbuf();
    return text.str();
  };
  const std::string geojson = text_of("routes.geojson");
  EXPECT_EQ(std::count(geojson.begin(), geojson.end(), '{'),
            std::count(geojson.begin(), geojson.end(), '}'));
  EXPECT_THAT(geojson, HasSubstr("\"type\":\"LineString\""));
  EXPECT_THAT(text_of("routes.kml"), HasSubstr("</Document></kml>"));
  EXPECT_THAT(text_of("vehicle-1.plan"), HasSubstr("\"fileType\":\"Plan\""));
  EXPECT_THAT(text_of("routes.svg"), HasSubstr("</svg>"));
  std::filesystem::remove_all(folder);
}

/// Its vehicles' layers are 100, 110 and 120 m above an origin that is 480 m above the ellipsoid.
TEST(RoutePlanning, EveryFileSaysHeightsInItsOwnFrame) {
  auto scenario = routes_3();
  for (auto& vehicle : scenario.vehicles)
    vehicle.flight_controller.ardupilot.geoid_height_m = -38.5;
  const auto planned = plan_routes(scenario);
  ASSERT_TRUE(planned.ok());
  const auto origin = MissionOrigin::make(scenario.origin);
  ASSERT_TRUE(origin.ok());
  const auto has = [](const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  };
  // Above the ellipsoid; the earth's curvature is 1 cm at vehicle 1's start, 15 cm at the site.
  const std::string geojson = routes_geojson(*planned, scenario, *origin);
  EXPECT_TRUE(has(geojson, ",580.0]")) << geojson.substr(0, 400);
  EXPECT_TRUE(has(geojson, ",600.2]]"));
  EXPECT_TRUE(has(geojson, "\"height_above_origin_m\":120.0"));
  EXPECT_FALSE(has(geojson, ",480.")) << "what lies on the ground has no height";
  // Above the geoid, which lies below the ellipsoid.
  const std::string kml = routes_kml(*planned, scenario, *origin);
  EXPECT_TRUE(has(kml, "<altitudeMode>absolute</altitudeMode>"));
  EXPECT_FALSE(has(kml, "relativeToGround"));
  EXPECT_TRUE(has(kml, ",618.5 ")) << kml.substr(0, 600);
  // Above home, which is at the origin.
  const std::string plan = routes_qgc(planned->file.routes[2], scenario, *origin);
  EXPECT_TRUE(has(plan, "\"plannedHomePosition\":[31.522062,105.044327,518.5]")) << plan;
  EXPECT_TRUE(has(plan, "\"Altitude\":120.0,\"AltitudeMode\":1"));
  EXPECT_TRUE(has(plan, "\"globalPlanAltitudeMode\":1"));
  EXPECT_TRUE(has(plan, "\"command\":16,\"frame\":3"));
  EXPECT_FALSE(has(plan, "600."));
}

TEST(RoutePlanning, APlanAnewLeavesNoRouteOfAnEarlierOneBehind) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("skein-replan-" + std::to_string(::getpid()));
  auto scenario = routes_3();
  auto planned = plan_routes(scenario);
  ASSERT_TRUE(planned.ok());
  ASSERT_TRUE(write_routes(*planned, scenario, folder).ok());
  for (const char* others : {"vehicle-1.plan.old", "vehicle-x.plan", "my.plan"}) {
    std::ofstream{folder / others} << "mine";
  }
  scenario.routes.approaches.erase(scenario.routes.approaches.begin());
  planned = plan_routes(scenario);
  ASSERT_TRUE(planned.ok());
  ASSERT_TRUE(write_routes(*planned, scenario, folder).ok());
  EXPECT_FALSE(std::filesystem::exists(folder / "vehicle-1.plan"));
  for (const char* kept :
       {"vehicle-2.plan", "vehicle-1.plan.old", "vehicle-x.plan", "my.plan", "plan.yaml"}) {
    EXPECT_TRUE(std::filesystem::exists(folder / kept)) << kept;
  }
  std::filesystem::remove_all(folder);
}

TEST(RoutePlanning, HazardsOfRoutesGetNumbersThatNobodyHas) {
  auto scenario = routes_3();
  scenario.hazards.push_back({{{65535}, {-5000.0, 0.0}, 10.0}, Instant{}});
  scenario.hazards.push_back({{{2}, {-6000.0, 0.0}, 10.0}, Instant{}});
  const auto planned = plan_routes(scenario);
  ASSERT_TRUE(planned.ok());
  ASSERT_TRUE(configuration::give_routes(planned->file, scenario).ok());
  std::set<std::uint16_t> numbers;
  for (const auto& known : scenario.hazards) {
    EXPECT_GT(known.hazard.id.value, 0U);
    EXPECT_TRUE(numbers.insert(known.hazard.id.value).second) << known.hazard.id.value;
  }
  EXPECT_EQ(numbers.size(), 12U);
}

}  // namespace
}  // namespace skein::groundstation
