// SPDX-License-Identifier: Apache-2.0
#include "skein/console/team_traffic.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

namespace skein::console {
namespace {

using ::testing::HasSubstr;

TEST(TeamTraffic, NamesTheNearestFirstAndWhomItConcerns) {
  const Instant now = at_seconds(20.0);
  mission::Fleet fleet{{.expected = {{3}}}};
  mission::Telemetry telemetry;
  telemetry.vehicle = {3};
  telemetry.state.time = now;
  telemetry.state.z_m = 100.0;
  fleet.on_message(mission::Message{telemetry}, now);
  Picture picture{{}};
  EXPECT_EQ(traffic_text(picture, fleet, now), "no aircraft is heard\n");

  std::map<std::uint32_t, mission::SeenAircraft> all;
  mission::SeenAircraft& far = all[0x400001];
  far.aircraft = {0x400001, {9000.0, 0.0}, 900.0, 0.0, 0.0, 0.0, now};
  mission::SeenAircraft& near = all[0x4ca2d6];
  near.callsign = "SKEIN1";
  near.aircraft.address = 0x4ca2d6;
  near.aircraft.time = at_seconds(18.0);
  near.aircraft.position = {-1080.0, 0.0};
  near.aircraft.east_mps = 40.0;
  near.aircraft.height_m = 60.0;
  picture.on_event(
      {{3}, now, {}, {}, mission::event::TrafficWarning{0x4ca2d6, 0.0, 40.0, {}, true}});
  picture.on_traffic(all);
  const std::string text = traffic_text(picture, fleet, now);
  EXPECT_THAT(text, ::testing::StartsWith("4ca2d6 SKEIN1  60 m above the origin, 40 m/s towards "
                                          "090 deg; 1000 m from vehicle 3, 40 m below it, nearest "
                                          "in 25 s at 0 m; vehicle 3 gives way; heard 2 s ago\n"));
  EXPECT_THAT(text, HasSubstr("\n400001 -       900 m above the origin; 9000 m from "));
}

}  // namespace
}  // namespace skein::console
