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
  const auto command = flight_controller_command("/opt/bin", vehicle, 5001);
  EXPECT_EQ(command.front(), "/opt/bin/skein-fc");
  EXPECT_EQ(command.back(), "5001");
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
  EXPECT_EQ(after("--gusts").front(), "5");
}

TEST(QuietBuses, AreDifferentOnes) {
  const auto buses = quiet_buses(3, 200);
  if (!buses) GTEST_SKIP() << buses.error().message;
  EXPECT_EQ(std::set<std::string>(buses->begin(), buses->end()).size(), 3U);
}

}  // namespace
}  // namespace skein::hil
