// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/return_desk.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "skein/base/angles.hpp"

namespace skein::groundstation {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A ground station that hears planes circling, each at its own height.
class ReturnDeskTest : public ::testing::Test {
 protected:
  ReturnDeskTest() : node_{config(), at_seconds(0.0)}, desk_{node_} {
    hear(1, {1000.0, 0.0}, 100.0);
    hear(2, {0.0, 1500.0}, 100.0);
    hear(3, {-800.0, -800.0}, 100.0, 200.0);  // metres of range: too few
  }

  static mission::GroundNodeConfig config() {
    mission::GroundNodeConfig config;
    config.agent.expected = {{1}, {2}, {3}, {4}};
    return config;
  }

  void hear(std::uint16_t id, const Vec2& centre, double height_m, double range_m = 20e3) {
    mission::Telemetry told;
    told.vehicle = {id};
    told.instance = {id};
    told.state.time = at_seconds(1.0);
    told.state.x_m = 20.0 * id;  // home, where it is first heard
    told.state.z_m = height_m;
    told.state.phase = FlightPhase::flying;
    told.range_left_m = range_m;
    told.plan_number = 4;
    node_.on_message(mission::Message{told}, {id}, at_seconds(1.0));
    mission::PlanReport report;
    report.vehicle = {id};
    report.plan.number = 4;
    report.plan.timed.start_time = at_seconds(0.0);
    report.plan.timed.path.start = {centre.x(), centre.y(), 0.0};
    report.plan.timed.speed_mps = 25.0;
    report.plan.timed.tail_curvature_per_m = 1.0 / 100.0;
    node_.on_message(mission::Message{report}, {id}, at_seconds(1.0));
    node_.on_timeout(at_seconds(1.0));
  }

  mission::GroundNode node_;
  ReturnDesk desk_;
};

TEST_F(ReturnDeskTest, WaysTimesAndSeparationAreShownBeforeAnythingIsOrdered) {
  const Answer answer = desk_.answer(ReturnPreview{}, at_seconds(2.0));
  ASSERT_TRUE(answer.done) << answer.text;
  EXPECT_THAT(answer.text, HasSubstr("2 vehicles come home, the last in "));
  EXPECT_THAT(answer.text, HasSubstr("vehicle 3     has no planned way: it lacks "));
  EXPECT_THAT(answer.text, HasSubstr("vehicle 4     has no planned way: it is not heard"));
  EXPECT_THAT(answer.text, HasSubstr("* home as where it was first heard"));
  const auto data = nlohmann::json::parse(answer.data);
  EXPECT_EQ(data["kind"], "return_preview");
  ASSERT_EQ(data["ways"].size(), 2U);
  // They have one height: they are kept apart by where and when they fly.
  EXPECT_GE(data["least_separation_m"].get<double>(), 29.0);
  const auto& way = data["ways"][0];
  EXPECT_EQ(way["id"], 1);
  EXPECT_TRUE(way["home_assumed"].get<bool>());
  EXPECT_GT(way["end_s"].get<double>(), 30.0);
  EXPECT_FALSE(way["hold"].empty());
  // Home is where it was first heard, to the orbit's radius or so; the other finds room beside.
  const auto off_home_m = [&](std::size_t i) {
    const auto& last = data["ways"][i]["points"].back();
    return std::hypot(last[0].get<double>() - 20.0 * static_cast<double>(i + 1),
                      last[1].get<double>());
  };
  EXPECT_LT(std::min(off_home_m(0), off_home_m(1)), 250.0);
  EXPECT_LT(std::max(off_home_m(0), off_home_m(1)), 1800.0);
  ASSERT_EQ(data["cannot"].size(), 2U);
  // 15 s are between two arrivals.
  EXPECT_GE(std::abs(data["ways"][1]["end_s"].get<double>() - way["end_s"].get<double>()), 14.9);
  while (const auto message = node_.poll_message()) {
    EXPECT_FALSE(std::holds_alternative<mission::ReturnFlight>(*message));
    EXPECT_FALSE(std::holds_alternative<mission::Command>(*message));
  }
}

TEST_F(ReturnDeskTest, SomeAreAskedFor) {
  const Answer answer = desk_.answer(ReturnPreview{{VehicleId{2}, VehicleId{7}}}, at_seconds(2.0));
  EXPECT_THAT(answer.text, HasSubstr("1 vehicle comes home"));
  EXPECT_THAT(answer.text, Not(HasSubstr("vehicle 1 ")));
  EXPECT_THAT(answer.text, HasSubstr("vehicle 7     has no planned way: it is not in the fleet"));
  EXPECT_TRUE(nlohmann::json::parse(answer.data)["least_separation_m"].is_null());
}

TEST_F(ReturnDeskTest, WhoeverAsksAllTheTimeIsShownWhatThereIs) {
  const Answer first = desk_.answer(ReturnPreview{}, at_seconds(2.0));
  EXPECT_EQ(desk_.answer(ReturnPreview{}, at_seconds(2.5)).text, first.text);
  EXPECT_FALSE(desk_.answer(ReturnPreview{{VehicleId{2}}}, at_seconds(2.9)).done);
  EXPECT_TRUE(desk_.answer(ReturnPreview{{VehicleId{2}}}, at_seconds(3.1)).done);
}

}  // namespace
}  // namespace skein::groundstation
