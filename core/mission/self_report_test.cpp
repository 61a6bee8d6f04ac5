// SPDX-License-Identifier: Apache-2.0
#include "self_report.hpp"

#include <gtest/gtest.h>

namespace skein::mission {
namespace {

SelfReport made() {
  Health base;
  base.vehicle = {7};
  return {base, at_seconds(0.0)};
}

FlightPlan plan(std::uint32_t number) {
  FlightPlan made;
  made.number = number;
  made.timed.speed_mps = 50.0;
  return made;
}

TEST(SelfReport, SendsAPlanAtOnceAndAgainFromTimeToTime) {
  SelfReport report = made();
  EXPECT_FALSE(report.plan_due(at_seconds(100.0)));
  report.on_plan(plan(1));
  EXPECT_EQ(report.plan_due(at_seconds(100.0)).value().plan.number, 1U);
  EXPECT_FALSE(report.plan_due(at_seconds(104.9)));
  EXPECT_EQ(report.plan_due(at_seconds(105.0)).value().vehicle, VehicleId{7});
  report.on_plan(plan(2));
  EXPECT_EQ(report.plan_due(at_seconds(105.1)).value().plan.number, 2U);
}

TEST(SelfReport, SendsAPlanThatIsWantedOnceInASecondAtMost) {
  SelfReport report = made();
  report.plan_wanted();
  EXPECT_FALSE(report.plan_due(at_seconds(100.0))) << "there is none";
  report.on_plan(plan(1));
  report.plan_wanted();
  EXPECT_TRUE(report.plan_due(at_seconds(100.0)));
  report.plan_wanted();
  EXPECT_FALSE(report.plan_due(at_seconds(100.9)));
  EXPECT_TRUE(report.plan_due(at_seconds(101.0)));
  EXPECT_FALSE(report.plan_due(at_seconds(105.9))) << "not wanted again";
  EXPECT_TRUE(report.plan_due(at_seconds(106.0)));
}

TEST(SelfReport, SaysWhomItHearsNewestFirstAndForgetsThem) {
  SelfReport report = made();
  report.on_heard({3}, at_seconds(10.0));
  report.on_heard({0}, at_seconds(12.0));
  const auto health = report.health({}, at_seconds(13.0));
  ASSERT_EQ(health.heard.size(), 2U);
  EXPECT_EQ(health.heard[0].vehicle, kGroundStation);
  EXPECT_EQ(health.heard[1].age, std::chrono::seconds{3});
  EXPECT_EQ(report.health({}, at_seconds(71.0)).heard.size(), 1U);
}

TEST(SelfReport, ForgetsOnlyWhoIsSilent) {
  SelfReport report = made();
  report.on_heard({9}, at_seconds(50.0));
  report.on_heard({4}, at_seconds(10.0));
  report.on_heard({2}, at_seconds(50.0));
  report.on_heard({5}, at_seconds(60.0));
  const auto health = report.health({}, at_seconds(75.0));
  std::vector<VehicleId> heard;
  for (const auto& entry : health.heard) heard.push_back(entry.vehicle);
  EXPECT_EQ(heard, (std::vector<VehicleId>{{5}, {2}, {9}}));  // at one moment: by number
  report.on_heard({9}, at_seconds(76.0));
  EXPECT_EQ(report.health({}, at_seconds(77.0)).heard.front().vehicle, VehicleId{9});
}

TEST(SelfReport, NamesWhatIsWrongSinceItWasLastAsked) {
  SelfReport report = made();
  SelfReport::Facts facts;
  EXPECT_EQ(report.health(facts, at_seconds(1.0)).problems,
            std::vector<std::string>{"its flight controller has told no state yet"});
  facts.state_at = at_seconds(2.0);
  EXPECT_TRUE(report.health(facts, at_seconds(2.1)).problems.empty());
  facts.condition.overruns = 4;
  facts.condition.dropped = 9;
  facts.refused = 2;
  EXPECT_EQ(report.health(facts, at_seconds(4.0)).problems,
            (std::vector<std::string>{"no state from its flight controller for 2.0 s",
                                      "4 control periods missed", "9 messages or records dropped",
                                      "2 messages refused: not their sender's to say"}));
  facts.state_at = at_seconds(5.0);
  EXPECT_TRUE(report.health(facts, at_seconds(5.0)).problems.empty());
  facts.range_spent = true;  // as long as that is so
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(report.health(facts, at_seconds(5.5)).problems,
              std::vector<std::string>{"its range is used up, but for the way home"});
  }
  facts.range_spent = false;
  const auto told = [&](VehicleId gives_way) {
    facts.separation = SeparationConflict{VehicleId{8}, gives_way};
    return report.health(facts, at_seconds(5.5)).problems;
  };
  EXPECT_EQ(told(VehicleId{7}),
            std::vector<std::string>{"vehicle 8 comes too near: it gives way by its height"});
  EXPECT_EQ(told(VehicleId{8}),
            std::vector<std::string>{"vehicle 8 comes too near: vehicle 8 gives way"});
  EXPECT_EQ(told({}),
            std::vector<std::string>{"vehicle 8 comes too near: it has no room to give way"});
}

}  // namespace
}  // namespace skein::mission
