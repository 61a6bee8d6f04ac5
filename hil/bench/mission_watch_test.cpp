// SPDX-License-Identifier: Apache-2.0
#include "mission_watch.hpp"

#include <gtest/gtest.h>

namespace skein::hil {
namespace {

configuration::Scenario two_vehicles_one_site() {
  configuration::Scenario scenario;
  for (const VehicleId id : {VehicleId{1}, VehicleId{2}}) {
    scenario.vehicles.emplace_back();
    scenario.vehicles.back().spec.id = id;
  }
  scenario.sites.emplace_back();
  scenario.sites.back().id = {7};
  return scenario;
}

mission::MissionEvent site_done(SiteId site) {
  mission::MissionEvent event;
  event.vehicle = {1};
  event.task.site = site;
  event.body = mission::event::SiteDone{};
  return event;
}

mission::Telemetry telemetry(VehicleId vehicle, mission::Activity activity, FlightPhase phase) {
  mission::Telemetry t;
  t.vehicle = vehicle;
  t.activity = activity;
  t.state.phase = phase;
  return t;
}

TEST(MissionWatch, SitesThatTheOperatorHasToldDoNotCount) {
  const auto scenario = two_vehicles_one_site();
  MissionWatch watch{scenario};
  EXPECT_TRUE(watch.on_event(site_done({10004})));
  EXPECT_FALSE(watch.work_done(Instant{}));
}

TEST(MissionWatch, WorkIsDoneWithTheLastSiteEachCountedOnce) {
  const auto scenario = two_vehicles_one_site();
  MissionWatch watch{scenario};
  EXPECT_FALSE(watch.work_done(Instant{}));
  EXPECT_TRUE(watch.on_event(site_done({7})));
  EXPECT_FALSE(watch.on_event(site_done({7}))) << "told again";
  EXPECT_EQ(watch.sites_done(), 1U);
  EXPECT_TRUE(watch.work_done(Instant{}));
}

TEST(MissionWatch, IsOverWhenTheRangesOfAllHaveEnded) {
  using mission::Activity;
  const auto scenario = two_vehicles_one_site();
  MissionWatch watch{scenario};
  watch.on_telemetry(telemetry({1}, Activity::landed, FlightPhase::disarmed));
  watch.on_killed({2});  // it starts anew, and goes on
  EXPECT_FALSE(watch.over(Instant{}));
  watch.on_telemetry(telemetry({2}, Activity::landed, FlightPhase::disarmed));
  EXPECT_TRUE(watch.over(Instant{}));
  EXPECT_FALSE(watch.work_done(Instant{}));
}

TEST(MissionWatch, AllHaveLandedWhenWhoIsNotKilledRestsOnTheGround) {
  using mission::Activity;
  const auto scenario = two_vehicles_one_site();
  MissionWatch watch{scenario};
  watch.on_telemetry(telemetry({1}, Activity::landed, FlightPhase::disarmed));
  EXPECT_FALSE(watch.all_landed());
  watch.on_telemetry(telemetry({2}, Activity::landed, FlightPhase::landed));
  EXPECT_FALSE(watch.all_landed()) << "it is armed still";
  watch.on_telemetry(telemetry({2}, Activity::landed, FlightPhase::disarmed));
  EXPECT_TRUE(watch.all_landed());
  watch.on_telemetry(telemetry({2}, Activity::searching, FlightPhase::flying));
  EXPECT_FALSE(watch.all_landed()) << "it took off again";
  watch.on_killed({2});
  EXPECT_TRUE(watch.all_landed());
}

}  // namespace
}  // namespace skein::hil
