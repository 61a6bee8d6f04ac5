// SPDX-License-Identifier: Apache-2.0
// The operator's order to land: on board, and whose turn it is.
#include "landing.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "agent_parts_test.hpp"
#include "skein/mission/ground_landing.hpp"
#include "skein/mission/vehicle_agent.hpp"

namespace skein::mission {
namespace {

using testing::HasSubstr;

VehicleAgentConfig lander() {
  VehicleAgentConfig config = plane_config();
  config.vehicle.height_m = 120.0;
  config.search = {{900.0, 0.0}};
  return config;
}

/// Of lander().
struct Lander : FlownAgent {
  explicit Lander(const VehicleAgentConfig& config = lander()) : FlownAgent{config} {}
};

TEST(LandingOrder, IsObeyedOnceTheVehicleIsAtHome) {
  Lander vehicle;
  vehicle.fly(20.0);
  vehicle.order(CommandKind::return_home);
  vehicle.order(CommandKind::land);
  EXPECT_FALSE(vehicle.plan.lands) << "it is on its way";
  EXPECT_EQ(vehicle.agent.activity(), Activity::holding);
  EXPECT_EQ(vehicle.agent.telemetry().detail, ActivityDetail::returning);
  vehicle.fly(120.0);
  ASSERT_TRUE(vehicle.plan.lands);
  EXPECT_EQ(vehicle.agent.activity(), Activity::landing);
  // Where and as it began.
  EXPECT_NEAR(vehicle.plan.landing.x_m, 0.0, 1e-9);
  EXPECT_NEAR(vehicle.plan.landing.heading_rad, 0.3, 1e-9);
  EXPECT_EQ(vehicle.plan.landing.approach_m, 600.0);
  vehicle.state.phase = FlightPhase::landed;
  vehicle.fly(1.0);
  EXPECT_EQ(vehicle.agent.activity(), Activity::landed);
}

TEST(LandingOrder, GoesWhereTheConfigurationHasIt) {
  VehicleAgentConfig config = lander();
  config.vehicle.landing = {.x_m = 50.0, .y_m = -20.0, .heading_rad = 1.0};
  Lander vehicle{config};
  vehicle.order(CommandKind::land);
  vehicle.fly(120.0);
  ASSERT_TRUE(vehicle.plan.lands);
  EXPECT_EQ(vehicle.plan.landing.x_m, 50.0);
  EXPECT_EQ(vehicle.plan.landing.y_m, -20.0);
  EXPECT_EQ(vehicle.plan.landing.heading_rad, 1.0);
}

/// Flies on for so long, while another stays so far below it.
void fly_above(Lander& vehicle, double seconds, double below_m) {
  for (double s = 0.0; s < seconds; s += kFlownStep_s) {
    Telemetry other;
    other.vehicle = VehicleId{9};
    other.state = vehicle.state;
    other.state.z_m -= below_m;
    vehicle.tell(other);
    vehicle.fly(0.0);  // one step
  }
}

/// In its orbit at home, and told to land.
struct OrderedDown : Lander {
  OrderedDown() {
    order(CommandKind::return_home);
    fly(120.0);
    order(CommandKind::land);
  }
};

TEST(LandingOrder, WaitsUntilTheAirBelowIsFreeThoughNotForEver) {
  OrderedDown vehicle;
  fly_above(vehicle, 30.0, 12.0);
  EXPECT_FALSE(vehicle.plan.lands);
  vehicle.fly(10.0);  // the other is not heard any more
  EXPECT_TRUE(vehicle.plan.lands);

  OrderedDown patient;
  fly_above(patient, 50.0, 12.0);
  EXPECT_FALSE(patient.plan.lands);
  fly_above(patient, 20.0, 12.0);
  EXPECT_TRUE(patient.plan.lands);

  OrderedDown high;
  fly_above(high, 10.0, 60.0);
  EXPECT_TRUE(high.plan.lands) << "the other sees it come, and gives way";
}

TEST(LandingOrder, AnyOtherOrderCallsItOff) {
  for (const auto kind : {CommandKind::hold, CommandKind::return_home, CommandKind::resume}) {
    Lander vehicle;
    vehicle.order(CommandKind::land);
    vehicle.fly(120.0);
    ASSERT_TRUE(vehicle.plan.lands);
    vehicle.order(kind);
    vehicle.fly(60.0);
    EXPECT_FALSE(vehicle.plan.lands) << to_string(kind);
    EXPECT_NE(vehicle.agent.activity(), Activity::landing);
  }
}

TEST(LandingOrder, AHazardOnTheApproachKeepsItInItsOrbitAndIsTold) {
  VehicleAgentConfig config = lander();
  config.hazards.push_back({{1}, {-400.0, -120.0}, 60.0});  // on the final approach
  Lander vehicle{config};
  vehicle.order(CommandKind::land);
  vehicle.fly(120.0);
  EXPECT_FALSE(vehicle.plan.lands);
  EXPECT_EQ(count_trouble(vehicle.events, event::Trouble::landing_barred), 1);
}

TEST(LandingOrder, AHazardOnTheApproachThatIsToldOfLaterCallsItOff) {
  Lander vehicle;
  vehicle.order(CommandKind::land);
  vehicle.fly(120.0);
  ASSERT_TRUE(vehicle.plan.lands);
  vehicle.tell(HazardReport{{{1}, {-400.0, -120.0}, 60.0}});
  vehicle.fly(60.0);
  EXPECT_FALSE(vehicle.plan.lands);
}

TEST(LandingOrder, AnApproachFromBeyondTheFenceIsNotFlown) {
  VehicleAgentConfig config = lander();
  config.vehicle.landing.approach_m = 600.0;  // to the west of the start
  config.fence.corners = {{-500.0, -1500.0}, {1500.0, -1500.0}, {1500.0, 1500.0}, {-500.0, 1500.0}};
  config.fence.height_max_m = 200.0;
  Lander vehicle{config};
  vehicle.fly(5.0);
  vehicle.order(CommandKind::land);
  vehicle.fly(150.0);
  EXPECT_FALSE(vehicle.plan.lands);
  EXPECT_EQ(count_trouble(vehicle.events, event::Trouble::landing_barred), 1);
}

/// With range for a minute.
VehicleAgentConfig short_of_range(Recovery recovery) {
  VehicleAgentConfig config = lander();
  config.vehicle.range_m = 1500.0;
  config.vehicle.recovery = recovery;
  return config;
}

/// Until it comes down, within its range.
void fly_to_its_end(Lander& vehicle) {
  while (!vehicle.plan.lands && vehicle.state.distance_flown_m < 3000.0) vehicle.fly(0.0);
}

TEST(LandingByItself, WhomNobodyLandsAtHomeComesDownThereWithinItsRange) {
  Lander vehicle{short_of_range(Recovery::home)};
  fly_to_its_end(vehicle);
  ASSERT_TRUE(vehicle.plan.lands);
  EXPECT_LE(vehicle.state.distance_flown_m, 1500.0);
  EXPECT_GE(vehicle.state.distance_flown_m, 1500.0 - 1.2 * kTwoPi * 66.0) << "and no sooner";
  EXPECT_EQ(vehicle.plan.landing.x_m, 0.0);
  EXPECT_EQ(count_trouble(vehicle.events, event::Trouble::lands_by_itself), 1);
  EXPECT_EQ(vehicle.agent.activity(), Activity::landing);
  vehicle.state.phase = FlightPhase::landed;
  vehicle.fly(5.0);
  EXPECT_EQ(vehicle.agent.activity(), Activity::landed);
}

TEST(LandingByItself, WhoIsRecoveredAnywhereComesDownWhereItsRangeEnds) {
  VehicleAgentConfig config = short_of_range(Recovery::anywhere);
  config.vehicle.landing = {.x_m = 0.0, .y_m = 0.0};
  Lander vehicle{config};
  fly_to_its_end(vehicle);
  ASSERT_TRUE(vehicle.plan.lands);
  EXPECT_LE(vehicle.state.distance_flown_m, 1500.0);
  // Out of the orbit that it flies.
  const Landing& landing = vehicle.plan.landing;
  const Vec2 begin = approach_begin(landing);
  EXPECT_LE((begin - vehicle.state.position().horizontal()).norm(), 2.0 * landing.radius_m + 1.0);
  EXPECT_GT(begin.x(), 500.0);

  VehicleSpec copter = config.vehicle;
  copter.airframe = Airframe::copter;
  EXPECT_EQ(landing_after(copter, {30.0, 40.0, 1.0}).x_m, 30.0);
}

TEST(LandingByItself, TheOperatorsWordStands) {
  Lander ordered{short_of_range(Recovery::home)};
  ordered.fly(20.0);
  ordered.order(CommandKind::return_home);
  ordered.order(CommandKind::land);
  fly_to_its_end(ordered);
  EXPECT_TRUE(ordered.plan.lands);
  EXPECT_EQ(count_trouble(ordered.events, event::Trouble::lands_by_itself), 0);

  Lander stays{short_of_range(Recovery::anywhere)};
  stays.fly(50.0);
  stays.order(CommandKind::hold);
  fly_to_its_end(stays);
  EXPECT_FALSE(stays.plan.lands);
  stays.order(CommandKind::land);
  stays.fly(5.0);
  EXPECT_TRUE(stays.plan.lands) << "where it is: it has no range for its way home";
}

/// Through the layers of others, and without range.
TEST(LandingByItself, IsNotBrokenOffToComeHome) {
  Lander vehicle{short_of_range(Recovery::home)};
  fly_to_its_end(vehicle);
  for (const auto kind : {CommandKind::return_home, CommandKind::resume, CommandKind::land,
                          CommandKind::return_home}) {
    vehicle.order(kind);
    vehicle.fly(5.0);
    EXPECT_TRUE(vehicle.plan.lands) << to_string(kind);
  }
  EXPECT_EQ(count_trouble(vehicle.events, event::Trouble::lands_by_itself), 4) << "it is told why";
  vehicle.order(CommandKind::hold);
  vehicle.fly(5.0);
  EXPECT_FALSE(vehicle.plan.lands) << "somebody may stand there";
}

void lands_by_order_alone(Lander& vehicle) {
  fly_to_its_end(vehicle);
  EXPECT_FALSE(vehicle.plan.lands);
  vehicle.order(CommandKind::land);
  vehicle.fly(5.0);
  EXPECT_TRUE(vehicle.plan.lands);
}

TEST(LandingByItself, WhoIsLeftToItsPilotOrbits) {
  VehicleAgentConfig config = short_of_range(Recovery::home);
  config.lands_by_itself = false;
  Lander vehicle{config};
  lands_by_order_alone(vehicle);
}

/// Where it is then it takes for its home.
TEST(LandingByItself, WhoHasStartedAnewWaitsForAnOrder) {
  Lander vehicle{short_of_range(Recovery::home)};
  vehicle.agent.on_bar(Bar::orders_unknown, at_seconds(0.0));
  vehicle.agent.on_bar(Bar::none, at_seconds(0.5));
  lands_by_order_alone(vehicle);
}

TEST(LandingByItself, WaitsForTheAirBelowAsLongAsItsRangeLasts) {
  Lander vehicle{short_of_range(Recovery::home)};
  while (!vehicle.plan.lands && vehicle.state.distance_flown_m < 3000.0) {
    fly_above(vehicle, kFlownStep_s, 12.0);
  }
  ASSERT_TRUE(vehicle.plan.lands);
  EXPECT_LE(vehicle.state.distance_flown_m, 1500.0);
  EXPECT_GE(vehicle.state.distance_flown_m, 1500.0 - 0.1 * kTwoPi * 66.0 - 2.0 * 12.5);
}

TEST(LandingByItself, IsToldWhereItIsBarred) {
  VehicleAgentConfig config = short_of_range(Recovery::home);
  config.hazards.push_back({{1}, {-400.0, -120.0}, 60.0});  // on the final approach
  Lander vehicle{config};
  fly_to_its_end(vehicle);
  EXPECT_FALSE(vehicle.plan.lands);
  EXPECT_EQ(count_trouble(vehicle.events, event::Trouble::landing_barred), 1);
}

TEST(LandingOrder, WhoHasLandedIsSentNowhere) {
  Lander vehicle;
  vehicle.order(CommandKind::land);
  vehicle.fly(120.0);
  vehicle.state.phase = FlightPhase::disarmed;
  vehicle.fly(1.0);
  for (const auto kind : {CommandKind::hold, CommandKind::return_home, CommandKind::resume}) {
    vehicle.order(kind);
    vehicle.fly(10.0);
    EXPECT_EQ(vehicle.agent.activity(), Activity::landed) << to_string(kind);
  }
}

TEST(LandingOrder, ACopterComesOverItsPlaceAndThenStraightDown) {
  Descent descent{Landing{.x_m = 10.0, .y_m = 0.0}, 30.0, 0.0};
  VehicleState state;
  state.z_m = 30.0;
  double sink_max_mps = 0.0;
  for (int i = 0; i < 1200; ++i) {
    state.time = at_seconds(0.1 * i);
    descent.step(state, state.time);
    const auto track = descent.poll_track();
    if (!track) continue;
    const auto moment = track->at(state.time);
    state.x_m = moment.position_m.x();
    state.z_m = moment.position_m.z();
    sink_max_mps = std::max(sink_max_mps, -moment.velocity_mps.z());
    if (state.z_m < 29.0) {
      EXPECT_NEAR(state.x_m, 10.0, 1.0);
    }
  }
  EXPECT_NEAR(state.z_m, 0.0, 0.1);
  EXPECT_LE(sink_max_mps, 1.51);
}

class Turns : public testing::Test {
 protected:
  Turns() {
    for (std::uint16_t id = 1; id <= 3; ++id) hear(id, Activity::holding);
  }
  void hear(std::uint16_t id, Activity activity) {
    Telemetry telemetry;
    telemetry.vehicle = {id};
    telemetry.instance = {id};
    telemetry.activity = activity;
    telemetry.state.time = now_;
    telemetry.state.z_m = 200.0 - 20.0 * id;  // 3 is the lowest
    fleet_.on_message(telemetry, now_);
  }
  Instant now_ = at_seconds(10.0);
  Fleet fleet_{{.expected = {{1}, {2}, {3}}}};
  GroundLanding landings_;
};

TEST_F(Turns, TheLowestLandsFirstAndTheNextWhenItIsDown) {
  for (std::uint16_t id = 1; id <= 3; ++id) landings_.add({id}, now_);
  EXPECT_EQ(landings_.next(fleet_, now_), VehicleId{3});
  EXPECT_EQ(landings_.next(fleet_, now_), std::nullopt);
  hear(3, Activity::landing);
  EXPECT_EQ(landings_.next(fleet_, now_), std::nullopt);
  hear(3, Activity::landed);
  EXPECT_EQ(landings_.next(fleet_, now_), VehicleId{2});
  landings_.drop({2});  // it was told to hold
  EXPECT_EQ(landings_.next(fleet_, now_), VehicleId{1});
  EXPECT_TRUE(landings_.waiting().empty());
  EXPECT_FALSE(landings_.poll_event());
}

TEST_F(Turns, WhoDoesNotLandIsToldOfAndTheNextLands) {
  landings_.add({1}, now_);
  landings_.add({2}, now_);
  EXPECT_EQ(landings_.next(fleet_, now_), VehicleId{2});
  now_ += GroundLanding::kSlot;
  hear(1, Activity::holding);
  hear(2, Activity::holding);
  EXPECT_EQ(landings_.next(fleet_, now_), VehicleId{1});
  const auto told = landings_.poll_event();
  ASSERT_TRUE(told);
  const auto* warning = std::get_if<event::FleetWarning>(&told->body);
  ASSERT_NE(warning, nullptr);
  EXPECT_EQ(warning->vehicle, VehicleId{2});
  EXPECT_EQ(warning->news, event::FleetNews::not_landed);
}

TEST_F(Turns, WhoIsNotOnItsWayHomeIsRefusedWithWhatToDo) {
  EXPECT_EQ(GroundLanding::why_not({1}, CommandKind::return_home, fleet_), std::nullopt);
  EXPECT_EQ(GroundLanding::why_not({1}, CommandKind::resume, fleet_), std::nullopt)
      << "its range is spent";
  hear(2, Activity::searching);
  const auto searching = GroundLanding::why_not({2}, CommandKind::resume, fleet_);
  ASSERT_TRUE(searching);
  EXPECT_THAT(*searching, HasSubstr("order 'return 2' first"));
  EXPECT_TRUE(GroundLanding::why_not({1}, CommandKind::hold, fleet_));
  hear(3, Activity::landed);
  EXPECT_EQ(GroundLanding::why_not({3}, CommandKind::land, fleet_), "vehicle 3 has landed");
  EXPECT_TRUE(GroundLanding::why_not({9}, CommandKind::return_home, fleet_));
}

}  // namespace
}  // namespace skein::mission
