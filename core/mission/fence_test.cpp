// SPDX-License-Identifier: Apache-2.0
// What a vehicle does at its fence.
#include "skein/domain/fence.hpp"

#include <gtest/gtest.h>

#include "agent_parts_test.hpp"
#include "scout.hpp"
#include "task_flyer.hpp"

namespace skein::mission {
namespace {

/// Around the start and the test's site; the point of the search lies outside, to the east.
Fence fence() {
  Fence fence;
  fence.corners = {{-500.0, -500.0}, {1000.0, -500.0}, {1000.0, 900.0}, {-500.0, 900.0}};
  fence.height_max_m = 150.0;
  return fence;
}

VehicleAgentConfig fenced(const Fence& within = fence()) {
  VehicleAgentConfig config = plane_config();
  config.vehicle.height_m = 120.0;
  config.fence = within;
  return config;
}

std::ptrdiff_t told(const HeardAgent& vehicle) {
  return count_trouble(vehicle.events, event::Trouble::left_fence);
}

TEST(FenceWatch, WhoIsBlownOutComesHome) {
  VehicleAgentConfig config = fenced();
  config.search = {{900.0, 0.0}, {900.0, 700.0}};
  FlownAgent vehicle{config};
  vehicle.fly(20.0);
  EXPECT_EQ(told(vehicle), 0);
  vehicle.beside_m = {600.0, 0.0};
  vehicle.fly(0.5);
  EXPECT_EQ(told(vehicle), 1);
  vehicle.beside_m = {0.0, 0.0};
  vehicle.fly(100.0);
  EXPECT_LT(vehicle.plan.timed.path.end().position().norm(), 200.0) << "it is at home";
  vehicle.order(CommandKind::resume);
  vehicle.fly(1.0);
  EXPECT_GT(vehicle.plan.timed.path.end().position().x(), 700.0) << "it may search on";
  vehicle.beside_m = {1200.0, 0.0};
  vehicle.fly(1.0);
  EXPECT_EQ(told(vehicle), 2) << "and comes home again";
}

TEST(FenceWatch, WhereEveryTurnLeadsOutItIsToldBeforeTheVehicleIsOut) {
  Fence narrow = fence();
  narrow.corners[1].x() = narrow.corners[2].x() = 30.0;
  narrow.corners[0].x() = narrow.corners[3].x() = -30.0;
  FlownAgent vehicle{fenced(narrow)};
  EXPECT_GT(narrow.inside_m({vehicle.state.x_m, vehicle.state.y_m}), 0.0);
  vehicle.fly(0.5);
  EXPECT_EQ(told(vehicle), 1);
}

TEST(FenceWatch, APointOutsideIsLeftOut) {
  FlownAgent vehicle{fenced()};
  for (int i = 0; i < 300; ++i) {
    vehicle.fly(0.5);
    ASSERT_GT(fence().inside_m({vehicle.state.x_m, vehicle.state.y_m}), 0.0) << i;
  }
  EXPECT_EQ(told(vehicle), 0);
}

TEST(FenceWatch, WhatItIsOrderedComesFirst) {
  FlownAgent vehicle{fenced()};
  vehicle.fly(10.0);
  vehicle.order(CommandKind::hold);
  vehicle.beside_m = {1200.0, 0.0};
  vehicle.fly(60.0);
  EXPECT_EQ(told(vehicle), 1);
  EXPECT_EQ(vehicle.agent.activity(), Activity::holding);
}

TEST(FenceWatch, AboveItIsOutside) {
  VehicleAgentConfig config = fenced();
  config.search = {{300.0, 0.0}};
  config.vehicle.height_m = 151.0;
  FlownAgent vehicle{config};
  vehicle.fly(5.0);
  EXPECT_EQ(told(vehicle), 1);
}

TEST(FenceWatch, WithoutAFenceNothingIsWatched) {
  FlownAgent vehicle{fenced({})};
  vehicle.fly(200.0);
  EXPECT_GT(vehicle.state.x_m, 1500.0);
  EXPECT_EQ(told(vehicle), 0);
}

TEST(FenceWatch, ASurveyThatLeadsOutIsNotFlown) {
  Fence near_site = fence();
  near_site.corners[1].x() = near_site.corners[2].x() = 650.0;  // the site is at x 600
  PartsBench bench{fenced(near_site)};
  Scout scout{bench.ownship, bench.outbox};
  scout.on_site_report({bench.ownship.spec().id, test_site(1)}, bench.now);
  EXPECT_FALSE(scout.take_up(bench.now));
  EXPECT_EQ(scout.state(), Scout::State::idle);
  EXPECT_EQ(bench.reported(EventKind::task_failed), 1);
}

TEST(FenceWatch, NobodyBidsForASiteOutside) {
  Fence without_site = fence();
  without_site.corners[2].y() = without_site.corners[3].y() = 250.0;  // the site is at y 300
  PartsBench bench{fenced(without_site)};
  TaskFlyer flyer{bench.ownship, bench.outbox};
  coalition::Announcement call;
  call.round = {{{7}, {1}, 1}, 1};
  call.site = test_site(1);
  call.tasks = tasks_after_survey(call.site);
  call.bids_until = bench.now + std::chrono::seconds{1};
  call.formed_at = bench.now + std::chrono::seconds{2};
  flyer.answer_call(call, coalition::Reason::none, bench.now);
  const auto event = bench.outbox.events.pop();
  ASSERT_TRUE(event);
  const auto* declined = std::get_if<event::BidDeclined>(&event->body);
  ASSERT_NE(declined, nullptr);
  EXPECT_EQ(declined->why.reason, coalition::Reason::outside_fence);
}

TEST(FenceOrdered, WhatIsSearchedLiesWithinTheNewOneFromThenOn) {
  VehicleAgentConfig config = plane_config();
  config.vehicle.height_m = 120.0;
  FlownAgent vehicle{config};
  vehicle.fly(10.0);
  EXPECT_GT(vehicle.plan.timed.path.end().position().x(), 1500.0) << "as there was none";
  EXPECT_EQ(vehicle.keep(fence()), "");
  for (int i = 0; i < 300; ++i) {
    vehicle.fly(0.5);
    ASSERT_GT(fence().inside_m({vehicle.state.x_m, vehicle.state.y_m}), 0.0) << i;
  }
  EXPECT_EQ(told(vehicle), 0);
}

TEST(FenceOrdered, OneBelowItsLayerIsNotTakenWhereverTheVehicleIs) {
  VehicleAgentConfig config = plane_config();
  config.vehicle.height_m = 120.0;
  FlownAgent vehicle{config};
  vehicle.fly(1.0);
  Fence low = fence();
  low.height_max_m = 60.0;
  EXPECT_EQ(vehicle.keep(low), "its layer of height is above it");
}

TEST(FenceOrdered, OneWithoutItsHomeIsNotTaken) {
  FlownAgent vehicle{fenced()};
  vehicle.fly(20.0);
  Fence away = fence();
  away.corners[0].x() = away.corners[3].x() = 20.0;
  ASSERT_GT(away.inside_m({vehicle.state.x_m, vehicle.state.y_m}), 0.0);
  EXPECT_EQ(vehicle.keep(away), "its home is outside of it");
  EXPECT_EQ(vehicle.keep(fence()), "");
}

}  // namespace
}  // namespace skein::mission
