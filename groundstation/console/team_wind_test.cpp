// SPDX-License-Identifier: Apache-2.0
#include "skein/console/team_wind.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "skein/base/angles.hpp"

namespace skein::console {
namespace {

using ::testing::HasSubstr;

/// A plane that turns at 0.3 rad/s through the air, in that wind.
mission::Telemetry plane(std::uint16_t id, double time_s, const Vec2& wind_mps,
                         double climb_mps = 0.0) {
  mission::Telemetry told;
  told.vehicle = {id};
  VehicleState& s = told.state;
  s.time = at_seconds(time_s);
  s.heading_rad = 0.3 * time_s + id;
  s.airspeed_mps = 20.0;
  s.climb_mps = climb_mps;
  const double level = std::sqrt(s.airspeed_mps * s.airspeed_mps - climb_mps * climb_mps);
  const Vec2 over_ground = level * unit_vector(s.heading_rad) + wind_mps;
  s.course_rad = std::atan2(over_ground.y(), over_ground.x());
  s.groundspeed_mps = over_ground.norm();
  s.z_m = 100.0;
  s.phase = FlightPhase::flying;
  return told;
}

TEST(TeamWind, IsWhatIsOverTheGroundAndNotThroughTheAir) {
  TeamWind wind;
  // From 350 and 010 deg: what lies between is 000, and not 180.
  const Vec2 from_350 = -5.0 * unit_vector(heading_from_compass_deg(350.0));
  const Vec2 from_010 = -5.0 * unit_vector(heading_from_compass_deg(10.0));
  for (int i = 0; i < 100; ++i) {
    const double t = 0.2 * i;
    wind.on_telemetry(plane(1, t, from_350), at_seconds(t));
    wind.on_telemetry(plane(2, t, from_010, 4.0), at_seconds(t));
  }
  const auto team = wind.estimate({}, at_seconds(20.0));
  ASSERT_TRUE(team);
  EXPECT_EQ(team->vehicles.size(), 2U);
  EXPECT_NEAR(wrap_pi(radians(team->wind.from_deg())), 0.0, 1e-6);
  EXPECT_NEAR(team->wind.mean_mps.norm(), 5.0 * std::cos(radians(10.0)), 1e-6);
  EXPECT_NEAR(team->spread_mps, 5.0 * std::sin(radians(10.0)), 1e-6);
  EXPECT_NEAR(team->vehicles.at({1}).from_deg(), 350.0, 1e-6);
  EXPECT_NEAR(team->wind.gust_mps, 5.0, 1e-6);
}

TEST(TeamWind, GustsAreWhatThreeSecondsHave) {
  TeamWind wind;
  for (int i = 0; i < 100; ++i) {
    const double t = 0.2 * i + 0.01;  // no time is the edge of a second
    const bool blows = t >= 7.0 && t < 10.0;
    wind.on_telemetry(plane(1, t, {blows ? 9.0 : 4.0, 0.0}), at_seconds(t));
  }
  const auto team = wind.estimate({}, at_seconds(19.9));
  ASSERT_TRUE(team);
  EXPECT_NEAR(team->wind.gust_mps, 9.0, 1e-6);
  EXPECT_NEAR(team->wind.mean_mps.x(), (17.0 * 4.0 + 3.0 * 9.0) / 20.0, 1e-6);
}

TEST(TeamWind, CountsWhoFliesAndTellsNow) {
  TeamWind wind;
  auto on_ground = plane(2, 1.0, {3.0, 0.0});
  on_ground.state.phase = FlightPhase::disarmed;
  auto hovers = plane(3, 1.0, {3.0, 0.0});
  hovers.state.airspeed_mps = 2.0;
  for (double t = 0.0; t < 10.0; t += 0.5) {
    wind.on_telemetry(plane(1, t, {3.0, 0.0}), at_seconds(t));
    wind.on_telemetry(on_ground, at_seconds(t));
    wind.on_telemetry(hovers, at_seconds(t));
    wind.on_telemetry(plane(4, t, {0.0, 0.0}), at_seconds(t));
  }
  auto team = wind.estimate({VehicleId{4}}, at_seconds(10.0));
  ASSERT_TRUE(team);
  EXPECT_EQ(team->vehicles.size(), 1U);
  EXPECT_NEAR(team->wind.mean_mps.x(), 3.0, 1e-6);
  EXPECT_FALSE(wind.estimate({VehicleId{4}}, at_seconds(26.0)));  // too little is left of it
  EXPECT_FALSE(TeamWind{}.estimate({}, at_seconds(1.0)));
}

TEST(TeamWind, IsToldInCompassDegrees) {
  TeamWind wind;
  for (double t = 0.0; t < 10.0; t += 0.5) {
    wind.on_telemetry(plane(1, t, -4.0 * unit_vector(heading_from_compass_deg(240.0))),
                      at_seconds(t));
  }
  const auto team = wind.estimate({}, at_seconds(12.0));
  EXPECT_THAT(wind_text(team, at_seconds(12.0)),
              HasSubstr("from 240 deg at 4.0 m/s, gusts 4.0 m/s; 1 plane tells"));
  EXPECT_THAT(wind_json(team, at_seconds(12.0)), HasSubstr("\"from_deg\":240"));
  EXPECT_EQ(wind_json({}, at_seconds(12.0)), "null");
}

}  // namespace
}  // namespace skein::console
