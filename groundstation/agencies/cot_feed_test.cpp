// SPDX-License-Identifier: Apache-2.0
#include "skein/agencies/cot_feed.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "skein/base/angles.hpp"

namespace skein::agencies {
namespace {

constexpr std::int64_t kEpoch_unix_ns = 1'700'000'000'000'000'000;

std::int64_t unix_of(double now_s) { return kEpoch_unix_ns + from_seconds(now_s).count(); }

ShownVehicle vehicle(double measured_s, std::uint16_t id = 3) {
  ShownVehicle shown;
  shown.id = {id};
  shown.state.time = at_seconds(measured_s);
  shown.state.course_rad = heading_from_compass_deg(90.0);
  shown.state.groundspeed_mps = 20.0;
  shown.state.battery_percent = 80;
  shown.place = {59.0, 17.0, 130.0};
  shown.activity = mission::Activity::searching;
  shown.range_left_m = 12'340.0;
  shown.loads = 2;
  return shown;
}

struct CotFeedTest : ::testing::Test {
  std::vector<CotEvent> at(double now_s) {
    return feed.update(shown, at_seconds(now_s), unix_of(now_s));
  }
  CotFeed feed{"alpha", kEpoch_unix_ns};
  Shown shown;
};

TEST_F(CotFeedTest, AVehicleIsSaidAsItSaysItself) {
  shown.vehicles = {vehicle(9.9)};
  shown.vehicles[0].problems = {"low battery"};
  const auto events = at(10.0);
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].uid, "alpha-vehicle-3");
  EXPECT_EQ(events[0].type, "a-f-A-M-F-Q");
  EXPECT_EQ(events[0].callsign, "alpha-3");
  EXPECT_EQ(events[0].time_unix_ns, unix_of(9.9)) << "when it was there";
  EXPECT_EQ(events[0].stale_unix_ns, unix_of(19.9));
  EXPECT_NEAR(events[0].track->course_deg, 90.0, 1e-9);
  EXPECT_EQ(events[0].track->speed_mps, 20.0);
  EXPECT_EQ(events[0].battery_percent, 80U);
  EXPECT_EQ(events[0].place.height_m, 130.0);
  EXPECT_EQ(events[0].remarks, "searching, 12.3 km left, 2 loads, battery 80 %; low battery");
  shown.vehicles = {vehicle(9.9, 4)};
  shown.vehicles[0].copter = true;
  shown.vehicles[0].state.battery_percent = kBatteryNotTold;
  const auto other = at(11.0);
  ASSERT_EQ(other.size(), 2U);
  EXPECT_EQ(other[0].type, "a-f-A-M-H-Q");
  EXPECT_FALSE(other[0].battery_percent);
}

TEST_F(CotFeedTest, AVehicleIsSaidOnceAPeriodAndOnlyWithNewerStates) {
  shown.vehicles = {vehicle(10.0)};
  EXPECT_EQ(at(10.0).size(), 1U);
  shown.vehicles = {vehicle(10.2)};
  EXPECT_EQ(at(10.2).size(), 0U);
  shown.vehicles = {vehicle(10.9)};
  EXPECT_EQ(at(10.95).size(), 1U);
  EXPECT_EQ(at(60.0).size(), 0U) << "a silent one becomes stale";
}

TEST_F(CotFeedTest, AVehiclesStateIsSaidWhenItComesOrNot) {
  // Telemetry each 0.4 s, a tenth of a second on its way.
  std::int64_t oldest_ns = 0;
  int said = 0;
  for (int i = 0; i < 400; ++i) {
    const double now_s = 20.0 + 0.05 * i;
    shown.vehicles = {vehicle(0.4 * std::floor((now_s - 0.1) / 0.4))};
    for (const auto& event : at(now_s)) {
      ++said;
      if (i > 0) oldest_ns = std::max(oldest_ns, unix_of(now_s) - event.time_unix_ns);
    }
  }
  EXPECT_NEAR(said, 25, 2) << "with every second state";
  EXPECT_LT(oldest_ns, 200'000'000);
}

TEST_F(CotFeedTest, SitesHazardsAndTracksAreSaidBeforeTheyAreStale) {
  shown.sites = {{{7}, {59.0, 17.0, 0.0}, "led by vehicle 2", false}};
  shown.hazards = {{{2}, {59.1, 17.0, 0.0}, 150.0}};
  shown.tracks = {{{3}, {{59.0, 17.0, 30.0}, {59.1, 17.0, 30.0}}}};
  const auto events = at(1.0);
  ASSERT_EQ(events.size(), 3U);
  EXPECT_EQ(events[0].uid, "alpha-site-1700000000-7") << "of this mission";
  EXPECT_EQ(events[0].remarks, "led by vehicle 2");
  EXPECT_EQ(events[1].uid, "alpha-hazard-1700000000-2");
  EXPECT_EQ(events[1].type, "u-d-c-c");
  EXPECT_EQ(events[1].radius_m, 150.0);
  EXPECT_EQ(events[2].uid, "alpha-track-3");
  EXPECT_EQ(events[2].type, "u-d-f");
  EXPECT_EQ(events[2].line.size(), 2U);
  EXPECT_EQ(at(1.1).size(), 0U);
  shown.sites[0].state = "done";
  EXPECT_EQ(at(1.5).size(), 0U) << "not at every change";
  const auto changed = at(2.0);
  ASSERT_EQ(changed.size(), 1U);
  EXPECT_EQ(changed[0].remarks, "done");
  const auto again = at(21.0);
  EXPECT_EQ(again.size(), 2U);
  for (const auto& event : again) EXPECT_LT(unix_of(21.0), event.stale_unix_ns);
}

TEST_F(CotFeedTest, WhatIsWithdrawnIsEndedAndSaidSoThreeTimes) {
  shown.sites = {{{7}, {59.0, 17.0, 0.0}, "found", false}};
  EXPECT_EQ(at(1.0).size(), 1U);
  shown.sites.clear();
  for (const double now_s : {1.1, 2.1, 3.1}) {
    const auto ended = at(now_s);
    ASSERT_EQ(ended.size(), 1U) << now_s;
    EXPECT_EQ(ended[0].uid, "alpha-site-1700000000-7");
    EXPECT_EQ(ended[0].stale_unix_ns, unix_of(now_s));
    EXPECT_EQ(at(now_s + 0.5).size(), 0U);
  }
  EXPECT_EQ(at(4.1).size(), 0U);
  EXPECT_EQ(at(100.0).size(), 0U);
}

TEST_F(CotFeedTest, WhatComesBackIsSaidAtOnce) {
  shown.vehicles = {vehicle(1.0)};
  EXPECT_EQ(at(1.0).size(), 1U);
  shown.vehicles.clear();
  EXPECT_EQ(at(1.1).size(), 1U);
  shown.vehicles = {vehicle(1.2)};
  const auto back = at(1.2);
  ASSERT_EQ(back.size(), 1U);
  EXPECT_GT(back[0].stale_unix_ns, back[0].time_unix_ns);
}

TEST_F(CotFeedTest, ANewStartSaysTheSameUids) {
  shown.vehicles = {vehicle(1.0)};
  shown.sites = {{{7}, {59.0, 17.0, 0.0}, "found", false}};
  const auto before = at(1.0);
  CotFeed other{"alpha", kEpoch_unix_ns};
  const auto after = other.update(shown, at_seconds(50.0), unix_of(50.0));
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t i = 0; i < after.size(); ++i) {
    EXPECT_EQ(after[i].uid, before[i].uid);
    EXPECT_TRUE(after[i].uid.starts_with(feed.uid_prefix()));
  }
}

}  // namespace
}  // namespace skein::agencies
