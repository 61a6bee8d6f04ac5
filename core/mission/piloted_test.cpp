// SPDX-License-Identifier: Apache-2.0
// A vehicle whose pilot, or a failsafe of whose autopilot, has taken it.
#include <gtest/gtest.h>

#include "agent_parts_test.hpp"

namespace skein::mission {
namespace {

const Vec2 kFlownTo{-300.0, 200.0};

coalition::Announcement call_at(double now_s) {
  coalition::Announcement call;
  call.round = {{{2}, {9}, 1}, 1};
  call.site = test_site(5);
  call.tasks = tasks_after_survey(call.site);
  call.announced_at = at_seconds(now_s);
  call.bids_until = at_seconds(now_s + 2.0);
  call.formed_at = at_seconds(now_s + 6.0);
  call.reward = 1.0;
  call.leader_at_formation = call.site.position;
  return call;
}

const MissionEvent* find(const FlownAgent& vehicle, EventKind kind) {
  const auto found = std::ranges::find_if(
      vehicle.events, [kind](const MissionEvent& e) { return e.kind() == kind; });
  return found == vehicle.events.end() ? nullptr : &*found;
}

TEST(Piloted, NeitherBidsNorSearchesUntilItIsGivenBackWhereItIs) {
  FlownAgent vehicle{plane_config()};
  vehicle.fly(10.0);
  ASSERT_EQ(vehicle.agent.activity(), Activity::searching);
  vehicle.be_piloted(true);
  EXPECT_EQ(vehicle.agent.activity(), Activity::holding);
  EXPECT_EQ(vehicle.agent.telemetry().detail, ActivityDetail::piloted);
  vehicle.tell(coalition::Message{call_at(10.5)});
  EXPECT_EQ(find(vehicle, EventKind::bid_sent), nullptr);
  const auto* declined = find(vehicle, EventKind::bid_declined);
  ASSERT_NE(declined, nullptr);
  EXPECT_EQ(std::get<event::BidDeclined>(declined->body).why.reason, coalition::Reason::piloted);

  vehicle.fly(20.0);
  vehicle.beside_m = kFlownTo;
  vehicle.fly(1.0);
  const Vec2 here{vehicle.state.x_m, vehicle.state.y_m};
  vehicle.beside_m = {0.0, 0.0};  // from here on it is where its plan has it
  vehicle.be_piloted(false);
  vehicle.fly(0.5);
  EXPECT_EQ(vehicle.agent.activity(), Activity::searching);
  EXPECT_LT((Vec2{vehicle.state.x_m, vehicle.state.y_m} - here).norm(),
            3.0 * kTestSpeed_mps * kFlownStep_s);
  vehicle.tell(coalition::Message{call_at(33.0)});
  EXPECT_NE(find(vehicle, EventKind::bid_sent), nullptr);
}

TEST(Piloted, TheSurveyOfASiteIsLeftAndTakenUpAgain) {
  FlownAgent vehicle{plane_config()};
  vehicle.fly(2.0);
  vehicle.tell(SiteReport{{4}, test_site(5)});
  ASSERT_EQ(vehicle.agent.activity(), Activity::surveying);
  vehicle.be_piloted(true);
  EXPECT_EQ(vehicle.agent.activity(), Activity::holding);
  vehicle.fly(30.0);
  EXPECT_EQ(vehicle.agent.activity(), Activity::holding);
  vehicle.be_piloted(false);
  vehicle.fly(1.0);
  EXPECT_EQ(vehicle.agent.activity(), Activity::surveying);
}

TEST(Piloted, WhatWasOrderedIsObeyedFromWhereItIsGivenBack) {
  for (const CommandKind order : {CommandKind::hold, CommandKind::return_home}) {
    FlownAgent vehicle{plane_config()};
    vehicle.fly(20.0);
    vehicle.be_piloted(true);
    vehicle.order(order);
    vehicle.fly(30.0);
    vehicle.beside_m = kFlownTo;
    vehicle.fly(1.0);
    const Vec2 here{vehicle.state.x_m, vehicle.state.y_m};
    vehicle.beside_m = {0.0, 0.0};
    vehicle.be_piloted(false);
    vehicle.fly(0.5);
    EXPECT_LT((Vec2{vehicle.state.x_m, vehicle.state.y_m} - here).norm(),
              3.0 * kTestSpeed_mps * kFlownStep_s);
    EXPECT_EQ(vehicle.agent.telemetry().detail,
              order == CommandKind::hold ? ActivityDetail::ordered : ActivityDetail::returning);
  }
}

}  // namespace
}  // namespace skein::mission
