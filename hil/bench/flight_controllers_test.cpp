// SPDX-License-Identifier: Apache-2.0
#include "flight_controllers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "skein/base/angles.hpp"
#include "skein/can/bus.hpp"

namespace skein::hil {
namespace {

TEST(FlightControllers, AreStartedWhereTheVehicleIs) {
  configuration::VehicleConfig vehicle;
  vehicle.start = {2200.0, 2000.5, heading_from_compass_deg(50.0)};
  vehicle.origin = {31.5, 105.0, 480.0};
  vehicle.vehicle.height_m = 309.0;
  vehicle.flight_controller.ardupilot.can = "mcast:7";
  vehicle.flight_controller.ardupilot.node_id = 12;
  vehicle.flight_controller.ardupilot.system_id = 9;
  vehicle.flight_controller.wind = {5.0, heading_from_compass_deg(240.0), 0.5};
  vehicle.time.epoch_unix_ns = 1'795'000'000'123'456'789;
  vehicle.vehicle.id = VehicleId{2};
  std::vector<configuration::Fault> faults(3);
  faults[0].at = at_seconds(20.5);
  faults[0].kind = configuration::FaultKind::battery;
  faults[0].vehicle = VehicleId{2};
  faults[0].battery_percent = 31.0;
  faults[1] = faults[0];
  faults[1].vehicle = VehicleId{3};
  faults[2].vehicle = VehicleId{2};
  const auto command = flight_controller_command("/opt/bin", vehicle, 5001, faults);
  EXPECT_EQ(command.front(), "/opt/bin/skein-fc");
  EXPECT_EQ(std::ranges::count(command, "--at"), 1);
  EXPECT_EQ(command.back(), "20.5 battery 31");
  const auto after = [&command](const std::string& option) {
    const auto at = std::find(command.begin(), command.end(), option);
    return std::vector<std::string>(at + 1, std::min(at + 4, command.end()));
  };
  EXPECT_EQ(after("--start"), (std::vector<std::string>{"2200", "2000.5", "309"}));
  EXPECT_EQ(after("--origin"), (std::vector<std::string>{"31.5", "105", "480"}));
  EXPECT_EQ(after("--bus").front(), "mcast:7");
  EXPECT_EQ(after("--node").front(), "12");
  EXPECT_EQ(after("--system").front(), "9");
  EXPECT_EQ(after("--heading").front(), "50");
  EXPECT_EQ(after("--hold-until").front(), "1795000000123456789");
  EXPECT_EQ(after("--wind-from").front(), "240");
  EXPECT_EQ(after("--turbulence").front(), "0.5");
  EXPECT_EQ(after("--truth").front(), "5001");
}

TEST(FlightControllers, OnlyAnEmulatedBatteryCanFall) {
  configuration::Scenario scenario;
  scenario.vehicles.emplace_back();
  scenario.vehicles[0].spec.id = VehicleId{4};
  EXPECT_TRUE(batteries_can_fall(scenario, {}).ok());
  scenario.faults.emplace_back();
  scenario.faults[0].kind = configuration::FaultKind::battery;
  scenario.faults[0].vehicle = VehicleId{4};
  const auto simulated = batteries_can_fall(scenario, {});
  ASSERT_FALSE(simulated.ok());
  EXPECT_THAT(simulated.error().message, testing::HasSubstr("battery_vehicle 4: only a battery"));
  scenario.vehicles[0].flight_controller.kind = configuration::FlightControllerKind::ardupilot;
  EXPECT_TRUE(batteries_can_fall(scenario, {}).ok());
  UserAutopilots others;
  others.copter = "arducopter";
  EXPECT_TRUE(batteries_can_fall(scenario, others).ok());
  others.plane = "arduplane";
  EXPECT_FALSE(batteries_can_fall(scenario, others).ok());
}

TEST(QuietBuses, AreDifferentOnes) {
  const auto buses = quiet_buses(3, 200);
  if (!buses) GTEST_SKIP() << buses.error().message;
  EXPECT_EQ(std::set<std::string>(buses->begin(), buses->end()).size(), 3U);
}

}  // namespace
}  // namespace skein::hil
