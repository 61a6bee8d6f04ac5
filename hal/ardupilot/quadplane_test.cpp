// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "companion_line.hpp"

namespace skein::ardupilot {
namespace {

using State = Companion::State;
using ::testing::Contains;
using ::testing::HasSubstr;

void be_quadplane(AutopilotDouble& autopilot) {
  autopilot.type = 22;  // a VTOL
  autopilot.parameters["Q_ENABLE"] = 1.0F;
  autopilot.parameters["Q_GUIDED_MODE"] = 0.0F;
}

TEST(CompanionQuadplane, IsLiftedOffInGuided) {
  Line line{params(TakeOver::from_ground, Airframe::quadplane)};
  be_quadplane(line.autopilot);
  line.autopilot.armed = false;
  line.autopilot.landed = 1;
  line.autopilot.relative_height_m = 0.0;
  line.autopilot.truth.airspeed_mps = line.autopilot.truth.groundspeed_mps = 0.0;
  line.until(State::climbing, 15.0);
  ASSERT_EQ(line.companion.state(), State::climbing);
  line.run(1.0);
  EXPECT_EQ(line.autopilot.mode, 15U);
  const auto lifted = line.autopilot.last(mavlink::Command::nav_takeoff);
  ASSERT_TRUE(lifted);
  EXPECT_EQ(lifted->param7, 40.0F);
  line.autopilot.landed = 2;
  line.autopilot.relative_height_m = 39.0;
  line.until(State::flying, 5.0);
  EXPECT_EQ(line.companion.state(), State::flying);
}

TEST(CompanionQuadplane, IsToldToLeaveItsHoverUntilItFliesOnItsWings) {
  Line line{params(TakeOver::in_flight, Airframe::quadplane)};
  be_quadplane(line.autopilot);
  line.autopilot.truth.airspeed_mps = line.autopilot.truth.groundspeed_mps = 4.0;
  line.until(State::flying, 10.0);
  ASSERT_EQ(line.companion.state(), State::flying);
  const VehicleState truth = line.autopilot.truth;
  line.commands = false;  // as before the mission
  line.run(25.0);
  ASSERT_EQ(line.autopilot.places.size(), 3U) << "at once, and each ten seconds";
  const mavlink::CommandInt& place = line.autopilot.places.front();
  const auto origin = MissionOrigin::make(kTestOrigin).value();
  const auto there = origin.to_enu({place.x * 1e-7, place.y * 1e-7, kTestOrigin.height_m});
  EXPECT_LT((there.horizontal() - truth.position().horizontal()).norm(), 1.0) << "where it is";
  EXPECT_NEAR(place.z, 300.0F, 0.5F);
  EXPECT_EQ(place.param2, 0.0F) << "its mode is its pilot's to change";
  line.run(3.0);
  EXPECT_THAT(line.warnings, Contains(HasSubstr("it hovers on, 25 s after it was told")));
  line.autopilot.truth.airspeed_mps = 50.0;
  line.run(15.0);
  EXPECT_EQ(line.autopilot.places.size(), 3U);
  EXPECT_TRUE(line.companion.troubles().empty());
}

TEST(CompanionQuadplane, ThatTellsWhatCarriesItIsBelievedWhateverTheWindIs) {
  Line line{params(TakeOver::in_flight, Airframe::quadplane)};
  be_quadplane(line.autopilot);
  line.autopilot.vtol = static_cast<std::uint8_t>(mavlink::VtolState::on_rotors);
  line.until(State::flying, 10.0);
  ASSERT_EQ(line.companion.state(), State::flying);
  line.run(1.0);
  EXPECT_EQ(line.autopilot.places.size(), 1U) << "in a wind of 50 m/s";
  line.autopilot.vtol = static_cast<std::uint8_t>(mavlink::VtolState::on_wings);
  line.autopilot.truth.airspeed_mps = 4.0;
  line.run(15.0);
  EXPECT_EQ(line.autopilot.places.size(), 1U);
}

TEST(CompanionQuadplane, ThatHoversLowIsNotTakenAndNotGivenBack) {
  Line line{params(TakeOver::in_flight, Airframe::quadplane)};
  be_quadplane(line.autopilot);
  line.autopilot.vtol = static_cast<std::uint8_t>(mavlink::VtolState::on_rotors);
  line.autopilot.mode = 19;  // QLOITER
  line.autopilot.relative_height_m = 20.0;
  line.run(10.0);
  EXPECT_EQ(line.companion.state(), State::standing_by);
  EXPECT_THAT(line.warnings, Contains(HasSubstr("it hovers below 37 m")));
  EXPECT_FALSE(line.companion.give_back(line.now, line.now));
  line.run(0.1);
  EXPECT_THAT(line.warnings, Contains(HasSubstr("cannot be given to the companion: it hovers")));
  line.autopilot.relative_height_m = 45.0;
  line.until(State::flying, 10.0);
  EXPECT_EQ(line.companion.state(), State::flying);
}

TEST(CompanionQuadplane, InGuidedByItsPilotAndLowStaysInItsHover) {
  Line line{params(TakeOver::when_guided, Airframe::quadplane)};
  be_quadplane(line.autopilot);
  line.autopilot.vtol = static_cast<std::uint8_t>(mavlink::VtolState::on_rotors);
  line.autopilot.mode = 15;
  line.autopilot.relative_height_m = 20.0;
  line.until(State::flying, 10.0);
  line.run(15.0);
  ASSERT_EQ(line.companion.state(), State::flying);
  EXPECT_TRUE(line.autopilot.places.empty());
  EXPECT_THAT(line.warnings, Contains(HasSubstr("it hovers below 37 m")));
  line.autopilot.relative_height_m = 45.0;
  line.run(2.0);
  EXPECT_EQ(line.autopilot.places.size(), 1U);
}

TEST(CompanionQuadplane, IsRefusedWhereItsGuidedHovers) {
  Line line{params(TakeOver::in_flight, Airframe::quadplane)};
  be_quadplane(line.autopilot);
  line.autopilot.parameters["Q_GUIDED_MODE"] = 1.0F;
  line.run(8.0);
  EXPECT_EQ(line.companion.state(), State::preparing);
  EXPECT_THAT(line.warnings, Contains(HasSubstr("Q_GUIDED_MODE is 1, so it hovers in GUIDED")));
}

TEST(CompanionQuadplane, WithoutItsRotorsNothingIsFlown) {
  Line line{params(TakeOver::in_flight, Airframe::quadplane)};
  be_quadplane(line.autopilot);
  line.autopilot.parameters["Q_ENABLE"] = 0.0F;
  line.run(8.0);
  EXPECT_EQ(line.companion.state(), State::preparing);
  EXPECT_THAT(line.warnings, Contains(HasSubstr("Q_ENABLE is 0, so it has no rotors")));
}

TEST(CompanionQuadplane, IsSetDownByAMissionThatEndsOnItsRotors) {
  Line line{params(TakeOver::in_flight, Airframe::quadplane)};
  be_quadplane(line.autopilot);
  line.until(State::flying, 10.0);
  line.setpoint.landing = Landing{.x_m = 200.0,
                                  .y_m = 100.0,
                                  .heading_rad = 0.0,
                                  .approach_m = 600.0,
                                  .approach_height_m = 40.0,
                                  .radius_m = 165.0};
  line.until(State::landing, 10.0);
  ASSERT_EQ(line.companion.state(), State::landing);
  ASSERT_EQ(line.autopilot.mission.size(), 4U);
  EXPECT_EQ(line.autopilot.mission.back().command,
            static_cast<std::uint16_t>(mavlink::Command::nav_vtol_land));
}

}  // namespace
}  // namespace skein::ardupilot
