// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/ground_traffic.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

namespace skein::mission {
namespace {

struct GroundTrafficTest : ::testing::Test {
  GroundTrafficTest() { hear(0.0, {0.0, 0.0}); }

  void hear(double now_s, const Vec2& place) {
    Telemetry telemetry;
    telemetry.vehicle = VehicleId{3};
    telemetry.state.time = at_seconds(now_s);
    telemetry.state.x_m = place.x();
    telemetry.state.y_m = place.y();
    telemetry.state.z_m = 100.0;
    fleet.on_message(telemetry, at_seconds(now_s));
  }
  static SeenAircraft seen(double now_s, std::uint32_t address, const Vec2& place,
                           const Vec2& velocity = {0.0, 0.0}, double height_m = 300.0) {
    return {.aircraft = {.address = address,
                         .position = place,
                         .height_m = height_m,
                         .east_mps = velocity.x(),
                         .north_mps = velocity.y(),
                         .climb_mps = 0.0,
                         .time = at_seconds(now_s)}};
  }
  std::optional<Traffic> told(double now_s) {
    traffic.on_timeout(fleet, at_seconds(now_s));
    const auto message = traffic.poll_message();
    if (!message) return std::nullopt;
    return std::get<Traffic>(*message);
  }

  Fleet fleet{{.expected = {VehicleId{3}}}};
  GroundTraffic traffic;
};

TEST_F(GroundTrafficTest, WithoutAircraftNothingIsSaid) {
  EXPECT_FALSE(told(1.0));
  EXPECT_EQ(traffic.next_timeout(), Instant::max());
}

TEST_F(GroundTrafficTest, WhoIsNearIsToldOfOnceASecondAndItsEndOnce) {
  traffic.on_aircraft(seen(1.0, 0xabcdef, {4000.0, 0.0}), fleet, at_seconds(1.0));
  const auto first = told(1.0);
  ASSERT_TRUE(first);
  ASSERT_EQ(first->aircraft.size(), 1U);
  EXPECT_EQ(first->aircraft[0].address, 0xabcdefU);
  EXPECT_FALSE(told(1.5));
  EXPECT_TRUE(told(2.0));
  const auto none = told(32.0);
  ASSERT_TRUE(none);
  EXPECT_TRUE(none->aircraft.empty()) << "forgotten, 30 s after its last word";
  EXPECT_FALSE(told(33.0));
  EXPECT_TRUE(traffic.all().empty());
}

TEST_F(GroundTrafficTest, TheNearestComeFirstAndSixteenAtMost) {
  for (std::uint32_t i = 1; i <= 30; ++i) {
    traffic.on_aircraft(seen(1.0, i, {200.0 * (31.0 - i), 0.0}), fleet, at_seconds(1.0));
  }
  const auto all = told(1.0);
  ASSERT_TRUE(all);
  ASSERT_EQ(all->aircraft.size(), kAircraftMax);
  EXPECT_EQ(all->aircraft.front().address, 30U);
  EXPECT_EQ(all->aircraft.back().address, 15U);
}

TEST_F(GroundTrafficTest, WhoIsFarHighOrOnTheGroundIsNotToldOf) {
  traffic.on_aircraft(seen(1.0, 1, {40'000.0, 0.0}, {-100.0, 0.0}), fleet, at_seconds(1.0));
  traffic.on_aircraft(seen(1.0, 2, {4000.0, 0.0}, {-200.0, 0.0}, 9000.0), fleet, at_seconds(1.0));
  SeenAircraft rolls = seen(1.0, 3, {1000.0, 0.0});
  rolls.on_ground = true;
  traffic.on_aircraft(rolls, fleet, at_seconds(1.0));
  EXPECT_FALSE(told(1.0));
  EXPECT_EQ(traffic.all().size(), 3U) << "but is shown";
  // Fast ones from farther away: within 90 s of the team.
  traffic.on_aircraft(seen(2.0, 4, {20'000.0, 0.0}, {-250.0, 0.0}), fleet, at_seconds(2.0));
  const auto fast = told(2.0);
  ASSERT_TRUE(fast);
  EXPECT_EQ(fast->aircraft.size(), 1U);
}

TEST_F(GroundTrafficTest, OfMoreThanItKeepsTheFarthestGo) {
  for (std::uint32_t i = 1; i <= 100; ++i) {
    traffic.on_aircraft(seen(1.0, i, {100.0 * i, 0.0}), fleet, at_seconds(1.0));
  }
  EXPECT_EQ(traffic.all().size(), GroundTraffic::kKnownMax);
  EXPECT_TRUE(traffic.all().contains(1));
  EXPECT_FALSE(traffic.all().contains(100));
}

TEST_F(GroundTrafficTest, AnOlderWordDoesNotReplaceANewerOne) {
  traffic.on_aircraft(seen(5.0, 1, {1000.0, 0.0}), fleet, at_seconds(5.0));
  traffic.on_aircraft(seen(4.0, 1, {2000.0, 0.0}), fleet, at_seconds(5.1));
  EXPECT_EQ(traffic.all().at(1).aircraft.position.x(), 1000.0);
}

TEST_F(GroundTrafficTest, TheNearestMemberIsFoundByWhereBothAreNow) {
  const auto there = seen(0.0, 1, {3000.0, 400.0}, {-50.0, 0.0}, 250.0).aircraft;
  const auto nearest = nearest_member(there, fleet, at_seconds(10.0));
  ASSERT_TRUE(nearest);
  EXPECT_EQ(nearest->vehicle, VehicleId{3});
  EXPECT_NEAR(nearest->distance_m, std::hypot(2500.0, 400.0), 0.1);
  EXPECT_NEAR(nearest->above_m, 150.0, 1e-9);
  EXPECT_NEAR(nearest->closest_m, 400.0, 0.1);
  EXPECT_NEAR(nearest->closest_in_s, 50.0, 0.1);
  EXPECT_FALSE(nearest_member(there, Fleet{{.expected = {VehicleId{3}}}}, at_seconds(1.0)));
}

}  // namespace
}  // namespace skein::mission
