// SPDX-License-Identifier: Apache-2.0
#include "external_hosts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace skein::hil {
namespace {

using configuration::FlightControllerKind;
using configuration::HostFlightController;
using testing::HasSubstr;
namespace fs = std::filesystem;

configuration::Scenario scenario() {
  configuration::Scenario s;
  for (const int number : {2, 1, 3}) {  // hosts are not in the order of vehicles
    configuration::ScenarioVehicle vehicle;
    const VehicleId id{static_cast<std::uint16_t>(number)};
    vehicle.spec.id = id;
    s.vehicles.push_back(vehicle);
    configuration::Host host;
    host.node = id;
    host.address = "10.0.0." + std::to_string(number);
    s.hosts.push_back(host);
  }
  s.hosts.pop_back();
  return s;
}

std::string refusal(const configuration::Scenario& s, std::uint16_t id) {
  const auto hosts = ExternalHosts::make(s, {VehicleId{id}});
  return hosts ? "" : hosts.error().message;
}

TEST(ExternalHosts, WhatCannotBeExternalIsTold) {
  EXPECT_THAT(refusal(scenario(), 0), HasSubstr("has a host without ssh"));
  EXPECT_THAT(refusal(scenario(), 7), HasSubstr("not in the scenario"));
  EXPECT_THAT(refusal(scenario(), 3), HasSubstr("has no host"));
  auto s = scenario();
  s.vehicles[0].flight_controller.kind = FlightControllerKind::ardupilot;
  EXPECT_THAT(refusal(s, 2), HasSubstr("name its bus"));
  s = scenario();
  s.faults.push_back({});
  s.faults[0].kind = configuration::FaultKind::kill_vehicle;
  s.faults[0].vehicle = VehicleId{1};
  EXPECT_THAT(refusal(s, 1), HasSubstr("a fault kills vehicle 1"));
  s.faults[0].kind = configuration::FaultKind::battery;
  EXPECT_THAT(refusal(s, 1), HasSubstr("of the battery of vehicle 1"));
  EXPECT_EQ(refusal(s, 2), "");
}

TEST(ExternalHosts, TheGroundStationIsStartedHereOnItsOwnNetwork) {
  auto s = scenario();
  configuration::Host ground;
  ground.node = kGroundStation;
  ground.address = "10.0.0.100";
  ground.run = "ip netns exec ground";
  s.hosts.push_back(ground);
  const auto hosts = ExternalHosts::make(s, {kGroundStation, VehicleId{1}});
  ASSERT_TRUE(hosts);
  ASSERT_NE(hosts->ground(), nullptr);
  EXPECT_EQ(hosts->ground()->run, "ip netns exec ground");
  EXPECT_FALSE(hosts->has(kGroundStation)) << "it is not pushed, nor told of the radio";
  EXPECT_EQ(hosts->vehicles(), 1U);
  EXPECT_THAT(hosts->addresses(), testing::ElementsAre(testing::Pair(kGroundStation, "10.0.0.100"),
                                                       testing::Pair(VehicleId{1}, "10.0.0.1")));
  s.hosts.back().ssh = "pi@ground";
  EXPECT_THAT(refusal(s, 0), HasSubstr("has a host without ssh"));
}

TEST(ExternalHosts, HaveTheAddressesAndBusesOfTheirHosts) {
  auto s = scenario();
  for (auto& vehicle : s.vehicles) {
    vehicle.flight_controller.kind = FlightControllerKind::ardupilot;
    vehicle.flight_controller.ardupilot.can = "can7";
  }
  s.hosts[0].can = "can0";
  s.hosts[1].can = "mcast:9";
  s.hosts[1].flight_controller = HostFlightController::emulated;
  const auto hosts = ExternalHosts::make(s, {VehicleId{1}, VehicleId{2}});
  ASSERT_TRUE(hosts.ok()) << hosts.error().message;
  EXPECT_TRUE(hosts->has(VehicleId{1}));
  EXPECT_FALSE(hosts->has(VehicleId{3}));
  EXPECT_THAT(hosts->addresses(), testing::ElementsAre(testing::Pair(VehicleId{1}, "10.0.0.1"),
                                                       testing::Pair(VehicleId{2}, "10.0.0.2")));
  give_buses(s, *hosts);
  EXPECT_EQ(s.vehicles[0].flight_controller.ardupilot.can, "can0") << "its own flight controller";
  EXPECT_EQ(s.vehicles[1].flight_controller.ardupilot.can, "") << "as the bench's own";
  EXPECT_EQ(s.vehicles[2].flight_controller.ardupilot.can, "can7") << "not external";
}

/// Somebody flies the vehicle: a run neither takes it over nor ends it.
TEST(ExternalHosts, AProgramThatRunsIsLeftAlone) {
  const fs::path folder =
      fs::temp_directory_path() / ("skein-external-" + std::to_string(::getpid()));
  fs::create_directories(folder / "bin");
  const fs::path program = folder / "bin" / "skein-onboard";
  std::ofstream{program} << "#!/bin/sh\n[ $# -gt 2 ] || [ \"$1\" = --version ] && exit 0\n"
                            "trap 'exit 0' TERM\nwhile :; do sleep 0.05; done\n";
  fs::permissions(program, fs::perms::owner_all);
  auto s = scenario();
  auto& host = s.hosts[1];
  host.address = "127.0.0.1";
  host.programs = (folder / "bin").string();
  host.configurations = (folder / "etc").string();
  host.recordings = (folder / "var").string();
  configuration::VehicleConfig config;
  config.vehicle.id = VehicleId{1};
  {
    auto first = ExternalHosts::make(s, {VehicleId{1}});
    ASSERT_TRUE(first.ok()) << first.error().message;
    const auto up = first->start({config});
    ASSERT_TRUE(up.ok()) << up.error().message;
    {
      auto second = ExternalHosts::make(s, {VehicleId{1}});
      ASSERT_TRUE(second.ok());
      const auto refused = second->start({config});
      ASSERT_FALSE(refused.ok());
      EXPECT_THAT(refused.error().message, HasSubstr("perhaps in flight"));
    }
    const auto problems = first->stop();
    EXPECT_TRUE(problems.empty()) << problems.front();
    const auto missing = first->collect(folder / "run");
    ASSERT_EQ(missing.size(), 1U) << "it recorded nothing";
    EXPECT_EQ(missing[0].vehicle, VehicleId{1});
  }
  fs::remove_all(folder);
}

}  // namespace
}  // namespace skein::hil
