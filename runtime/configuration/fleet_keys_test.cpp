// SPDX-License-Identifier: Apache-2.0
// What a scenario says of a fleet in the field, and how two configurations are compared.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "skein/configuration/deployment.hpp"
#include "skein/configuration/differences.hpp"
#include "skein/configuration/scenario.hpp"
#include "skein/configuration/utc.hpp"

namespace skein::configuration {
namespace {

using testing::HasSubstr;

const std::string kMission = R"(version: 1
title: Two
duration_max_s: 60
origin: {latitude_deg: 31.5, longitude_deg: 105.0}
all: {cruise_speed_mps: 28, speed_min_mps: 23, speed_max_mps: 33, turn_radius_m: 70, range_m: 6000,
      capabilities: [survey], sensor_radius_m: 120, heading_deg: 0, north_m: 0}
vehicles:
  - {id: 1, east_m: 0, height_m: 100}
  - {id: 2, east_m: 50, height_m: 110}
sites: [{id: 1, east_m: 0, north_m: 500, survey: {dwell_s: 5}}]
)";

Scenario mission(const std::string& more) {
  auto scenario = parse_scenario(kMission + more, "fleet.yaml");
  EXPECT_TRUE(scenario.ok()) << (scenario ? "" : scenario.error().message);
  return scenario ? *scenario : Scenario{};
}

std::string mistakes(const std::string& more) {
  const auto scenario = parse_scenario(kMission + more, "fleet.yaml");
  return scenario ? "" : scenario.error().message;
}

TEST(FleetKeys, HostsEpochAndConsoleAreReadAndWritten) {
  const Scenario s = mission(
      "epoch: 2026-11-23T08:00:00Z\n"
      "console: {port: 7461}\n"
      "hosts:\n"
      "  - {vehicle: 0, address: 10.0.0.9}\n"
      "  - {vehicle: 2, address: 10.0.0.2, ssh: pi@two, run: sudo -n, can: vcan0,\n"
      "     programs: /opt/skein/bin, flight_controller: emulated}\n");
  EXPECT_EQ(s.epoch_unix_ns, 1'795'420'800'000'000'000);
  EXPECT_EQ(s.console.port, 7461);
  ASSERT_EQ(s.hosts.size(), 2U);
  EXPECT_EQ(s.hosts[0].configurations, "/etc/skein");
  EXPECT_EQ(s.hosts[1].node, VehicleId{2});
  EXPECT_EQ(s.hosts[1].ssh, "pi@two");
  EXPECT_EQ(s.hosts[1].flight_controller, HostFlightController::emulated);
  const auto again = parse_scenario(to_yaml(s), "written");
  ASSERT_TRUE(again.ok()) << again.error().message;
  EXPECT_EQ(again->hosts, s.hosts);
  EXPECT_EQ(again->epoch_unix_ns, s.epoch_unix_ns);
}

TEST(FleetKeys, AgenciesAreReadWrittenAndGivenToTheGroundStation) {
  const Scenario s = mission(
      "agencies:\n"
      "  team: alpha\n"
      "  cot:\n"
      "    - {address: 239.2.3.1, port: 6969, format: protobuf, interface: 10.0.0.9}\n"
      "    - {address: 10.0.0.7, port: 8087, transport: tcp}\n"
      "  markers: {port: 6969, address: 10.0.0.9, group: 239.2.3.1}\n"
      "  mavlink: [{address: 10.0.0.8}]\n");
  const auto again = parse_scenario(to_yaml(s), "written");
  ASSERT_TRUE(again.ok()) << again.error().message;
  const AgenciesConfig& agencies = again->agencies;
  EXPECT_EQ(agencies.team, "alpha");
  ASSERT_EQ(agencies.cot.size(), 2U);
  EXPECT_EQ(agencies.cot[0].format, CotTarget::Format::protobuf);
  EXPECT_EQ(agencies.cot[0].interface, "10.0.0.9");
  EXPECT_EQ(agencies.cot[1].transport, CotTarget::Transport::tcp);
  EXPECT_EQ(agencies.cot[1].format, CotTarget::Format::xml);
  EXPECT_EQ(agencies.markers.port, 6969);
  EXPECT_EQ(agencies.markers.group, "239.2.3.1");
  ASSERT_EQ(agencies.mavlink.size(), 1U);
  EXPECT_EQ(agencies.mavlink[0].port, 14550);
  const AgenciesConfig off = mission("").agencies;
  EXPECT_TRUE(off.cot.empty() && off.mavlink.empty() && off.markers.port == 0);
  EXPECT_EQ(off.markers.address, "127.0.0.1");
}

TEST(FleetKeys, MistakesOfAgenciesAreTold) {
  EXPECT_THAT(mistakes("agencies: {team: a b}\n"), HasSubstr("team"));
  EXPECT_THAT(mistakes("agencies: {cot: [{address: tak.example, port: 8087}]}\n"),
              HasSubstr("no IPv4 address"));
  EXPECT_THAT(mistakes("agencies: {cot: [{address: 239.2.3.1, port: 6969, transport: tcp}]}\n"),
              HasSubstr("has to be udp to a multicast"));
  EXPECT_THAT(
      mistakes(
          "agencies: {cot: [{address: 10.0.0.7, port: 1, transport: tcp, format: protobuf}]}\n"),
      HasSubstr("has to be xml by tcp"));
  EXPECT_THAT(mistakes("agencies: {markers: {port: 6969, group: 10.0.0.1}}\n"),
              HasSubstr("no multicast"));
  EXPECT_THAT(mistakes("agencies: {mavlink: [{address: 0.0.0.0}]}\n"),
              HasSubstr("no IPv4 address"));
}

TEST(FleetKeys, MistakesAreToldWithTheirLine) {
  EXPECT_THAT(mistakes("epoch: tomorrow\n"), HasSubstr("fleet.yaml:11: epoch: is no time in UTC"));
  EXPECT_THAT(mistakes("hosts: [{vehicle: 1, address: 10.0.0}]\n"),
              HasSubstr("is no IPv4 address"));
  for (const char* nobody : {"0.0.0.0", "239.1.2.3", "255.255.255.255"}) {
    EXPECT_THAT(mistakes(std::string{"hosts: [{vehicle: 1, address: "} + nobody + "}]\n"),
                HasSubstr("hosts[1].address: is of no one machine"));
  }
  EXPECT_THAT(mistakes("hosts: [{vehicle: 1, address: 10.0.0.1, programs: bin}]\n"),
              HasSubstr("hosts[1].programs: is no absolute path"));
  EXPECT_THAT(mistakes("hosts: [{vehicle: 1, address: 10.0.0.1, flight_controller: emulated}]\n"),
              HasSubstr("name its bus in `can`"));
  EXPECT_THAT(mistakes("air: {port: 80}\n"), HasSubstr("outside 1024 to 65535"));
}

TEST(Utc, IsReadAsItIsWritten) {
  for (const std::int64_t ns : {std::int64_t{0}, std::int64_t{951'782'399'000'000'000},
                                std::int64_t{1'795'420'800'250'000'001}}) {
    EXPECT_EQ(parse_utc(utc_text(ns)), ns) << utc_text(ns);
  }
  EXPECT_EQ(utc_text(1'795'420'800'250'000'000), "2026-11-23T08:00:00.25Z");
  EXPECT_EQ(parse_utc("2024-02-29T00:00:00Z"), 1'709'164'800'000'000'000);
}

TEST(Utc, AnythingElseIsNoTime) {
  for (const char* const text :
       {"", "Z", "2026-11-23", "2026-11-23T08:00:00", "2026-02-29T08:00:00Z",
        "2026-11-23T24:00:00Z", "2026-11-23T08:00:60Z", "2026-11-23 08:00:00Z",
        "2026-11-23T08:00:00.Z", "2026-11-23T08:00:00.0123456789Z", "-026-11-23T08:00:00Z",
        "1969-12-31T23:59:59Z"}) {
    EXPECT_EQ(parse_utc(text), std::nullopt) << text;
  }
}

TEST(Differences, NameTheKeysAndTheirValues) {
  Deployment deployment;
  deployment.dds = true;
  const auto configs = vehicle_configs(mission(""), deployment);
  VehicleConfig other = configs[0];
  EXPECT_TRUE(differences(configs[0], other).empty());
  other.origin.latitude_deg = 31.6;
  other.network.peers[1].port = 9000;
  other.hazards.push_back({HazardId{7}, {1.0, 2.0}, 30.0});
  const auto found = differences(configs[0], other);
  ASSERT_EQ(found.size(), 6U);
  EXPECT_EQ(found[0], (Difference{"origin.latitude_deg", "31.5", "31.6"}));
  EXPECT_EQ(found[1], (Difference{"network.peers[2].port", "17404", "9000"}));
  EXPECT_EQ(found[2], (Difference{"hazards[7].east_m", "", "1"}));
}

TEST(Deployment, NodesElsewhereAreWhereTheyAre) {
  Deployment deployment;
  deployment.address = "10.0.0.9";
  deployment.elsewhere = {{VehicleId{1}, "10.0.0.1"}};
  deployment.dds = true;
  const auto configs = vehicle_configs(mission(""), deployment);
  EXPECT_EQ(configs[0].network.address, "10.0.0.1");
  EXPECT_THAT(configs[0].network.peers,
              testing::ElementsAre(NetworkPeer{VehicleId{0}, "10.0.0.9", 17400},
                                   NetworkPeer{VehicleId{2}, "10.0.0.9", 17404}));
  EXPECT_EQ(configs[1].network.peers[1], (NetworkPeer{VehicleId{1}, "10.0.0.1", 17402}));
}

TEST(Deployment, OnTheAirNobodyIsListed) {
  Deployment deployment;
  deployment.address = "10.0.0.9";
  deployment.elsewhere = {{VehicleId{1}, "10.0.0.1"}};
  const auto configs =
      vehicle_configs(mission("air: {group: 239.255.83.7, limit_bytes_per_s: 5000}\n"), deployment);
  EXPECT_EQ(configs[0].network.address, "10.0.0.1");
  for (const VehicleConfig& config : configs) {
    EXPECT_EQ(config.network.air, (AirConfig{"239.255.83.7", 5000.0}));
    EXPECT_EQ(config.network.port, 17400);
    EXPECT_TRUE(config.network.peers.empty());
  }
}

std::string ground_station(const std::string& more) {
  return "version: 1\n"
         "origin: {latitude_deg: 47, longitude_deg: 8}\n"
         "vehicles: [1, 2]\n"
         "time: {epoch_unix_ns: 1790000000000000000}\n" +
         more;
}

TEST(CommandKeys, OneOfSeveralGroundStationsHasANumberAndNeedsTheAir) {
  const auto read = parse_ground_config(
      ground_station(
          "network: {port: 7400}\ncommand: {station: 2, name: ridge-2, role: watching}\n"),
      "g.yaml");
  ASSERT_TRUE(read) << read.error().message;
  const CommandConfig wanted{2, "ridge-2", true};
  EXPECT_EQ(read->command, wanted);
  const auto again = parse_ground_config(to_yaml(*read), "again.yaml");
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->command, wanted);
  const auto alone = parse_ground_config(ground_station("network: {port: 7400}\n"), "g.yaml");
  ASSERT_TRUE(alone);
  EXPECT_EQ(alone->command, CommandConfig{});

  const auto trouble = [](const std::string& more) {
    const auto config = parse_ground_config(ground_station(more), "g.yaml");
    return config ? std::string{} : config.error().message;
  };
  EXPECT_THAT(
      trouble("network: {port: 7400, peers: [{id: 1, port: 7402}]}\ncommand: {station: 1}\n"),
      HasSubstr("needs the air"));
  EXPECT_THAT(trouble("network: {port: 7400}\ncommand: {station: 100}\n"), HasSubstr("station"));
  EXPECT_THAT(trouble("network: {port: 7400}\ncommand: {role: boss}\n"), HasSubstr("role"));
}

}  // namespace
}  // namespace skein::configuration
