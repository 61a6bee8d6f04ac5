// SPDX-License-Identifier: Apache-2.0
#include "skein/fleet/fleet.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

namespace skein::fleet {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::int64_t kEpoch = 1'795'420'800'000'000'000;

const std::string kMission = R"(version: 1
title: Two
duration_max_s: 60
origin: {latitude_deg: 31.5, longitude_deg: 105.0}
all: {cruise_speed_mps: 28, speed_min_mps: 23, speed_max_mps: 33, turn_radius_m: 70, range_m: 6000,
      capabilities: [survey], sensor_radius_m: 120, heading_deg: 0, north_m: 0}
sites: [{id: 1, east_m: 0, north_m: 500, survey: {dwell_s: 5}}]
operator_decisions: [{site: 1, decision: grant}]
)";
const std::string kSimulated = R"(vehicles:
  - {id: 1, east_m: 0, height_m: 100}
  - {id: 2, east_m: 50, height_m: 110}
)";
const std::string kOnCan = R"(vehicles:
  - {id: 1, east_m: 0, height_m: 100, flight_controller: {kind: ardupilot}}
  - {id: 2, east_m: 50, height_m: 110, flight_controller: {kind: ardupilot}}
)";
const std::string kGround = "  - {vehicle: 0, address: 10.0.0.9, ssh: op@base}\n";
const std::string kFirst = "  - {vehicle: 1, address: 10.0.0.1, ssh: pi@one";
const std::string kSecond = "  - {vehicle: 2, address: 10.0.0.2, ssh: pi@two";
const std::string kHosts = "hosts:\n" + kGround + kFirst + "}\n" + kSecond + "}\n";

configuration::Scenario fleet_of(const std::string& more,
                                 const std::string& vehicles = kSimulated) {
  auto scenario = configuration::parse_scenario(kMission + vehicles + more, "fleet.yaml");
  EXPECT_TRUE(scenario.ok()) << (scenario ? "" : scenario.error().message);
  return scenario ? *scenario : configuration::Scenario{};
}
std::vector<std::string> problems_of(const std::string& more,
                                     const std::string& vehicles = kSimulated) {
  return problems(fleet_of(more, vehicles));
}

TEST(Fleet, EveryHostIsGivenItsConfiguration) {
  const auto programs = render(fleet_of(kHosts), kEpoch);
  ASSERT_TRUE(programs.ok()) << programs.error().message;
  ASSERT_EQ(programs->size(), 3U);
  const Program& ground = (*programs)[0];
  EXPECT_EQ(ground.unit, "skein-ground.service");
  EXPECT_EQ(ground.file, "/etc/skein/ground.yaml");
  const auto ground_config = configuration::parse_ground_config(ground.configuration, "ground");
  ASSERT_TRUE(ground_config.ok());
  EXPECT_EQ(ground_config->recording_folder, "/var/lib/skein/ground");
  EXPECT_EQ(ground_config->time.epoch_unix_ns, kEpoch);
  EXPECT_THAT(ground_config->operator_decisions, IsEmpty()) << "an operator decides in the field";
  const Program& second = (*programs)[2];
  EXPECT_EQ(second.unit, "skein-onboard@2.service");
  EXPECT_EQ(second.file, "/etc/skein/onboard-2.yaml");
  const auto config = configuration::parse_vehicle_config(second.configuration, "vehicle");
  ASSERT_TRUE(config.ok());
  EXPECT_EQ(config->recording_folder, "/var/lib/skein/onboard-2");
  EXPECT_EQ(config->network.keys, "/var/lib/skein/onboard-2/keys");
  EXPECT_EQ(config->detections_socket, "/run/skein/detections-2.sock");
  EXPECT_EQ(config->network.address, "10.0.0.2");
  EXPECT_THAT(config->network.peers, IsEmpty()) << "who is heard is there";
  EXPECT_EQ(config->network.port, ground_config->network.port);
}

TEST(Fleet, AMissingAnUnknownAndNoHostAreTold) {
  EXPECT_THAT(problems_of(""), ElementsAre(HasSubstr("names no hosts")));
  EXPECT_THAT(problems_of("hosts:\n" + kGround + kFirst + "}\n"),
              ElementsAre("vehicle 2 has no host; add one"));
  EXPECT_THAT(problems_of("hosts:\n" + kFirst + "}\n" + kSecond + "}\n"),
              ElementsAre(HasSubstr("the ground station (vehicle: 0) has no host")));
  EXPECT_THAT(problems_of(kHosts + "  - {vehicle: 7, address: 10.0.0.7, ssh: pi@seven}\n"),
              ElementsAre(HasSubstr("vehicle 7, which is not in the fleet")));
}

TEST(Fleet, AddressesThatCannotBeAreTold) {
  const auto with_second = [](const std::string& address, const std::string& more) {
    return problems_of("hosts:\n" + kGround + kFirst + "}\n  - {vehicle: 2, address: " + address +
                       more + "}\n");
  };
  EXPECT_THAT(with_second("127.0.0.1", ", ssh: pi@two"),
              ElementsAre(HasSubstr("where other machines do not reach it")));
  EXPECT_THAT(with_second("10.0.0.1", ", ssh: pi@two"),
              ElementsAre(HasSubstr("two machines with one address")));
  EXPECT_THAT(with_second("10.0.0.1", ", ssh: pi@one"), IsEmpty());
  EXPECT_THAT(with_second("10.0.0.2", ", ssh: -oProxyCommand=x"),
              ElementsAre(HasSubstr("which is no user@name")));
}

TEST(Fleet, AllOnThisMachineMayBeOnLoopback) {
  EXPECT_THAT(problems_of("hosts:\n"
                          "  - {vehicle: 0, address: 127.0.0.1}\n"
                          "  - {vehicle: 1, address: 127.0.0.1}\n"
                          "  - {vehicle: 2, address: 127.0.0.1}\n"),
              IsEmpty());
}

TEST(Fleet, BusesAndTheirNodesAreCheckedByMachine) {
  EXPECT_THAT(problems_of(kHosts, kOnCan),
              ElementsAre(HasSubstr("vehicle 1 has an ardupilot on no bus"),
                          HasSubstr("vehicle 2 has an ardupilot on no bus")));
  const std::string apart =
      "hosts:\n" + kGround + kFirst + ", can: can0}\n" + kSecond + ", can: can0}\n";
  EXPECT_THAT(problems_of(apart, kOnCan), IsEmpty());
  const auto programs = render(fleet_of(apart, kOnCan), kEpoch);
  ASSERT_TRUE(programs.ok()) << programs.error().message;
  EXPECT_THAT((*programs)[1].configuration, HasSubstr("can: \"can0\""));
  const std::string together = "hosts:\n" + kGround + kFirst +
                               ", can: can0}\n"
                               "  - {vehicle: 2, address: 10.0.0.1, ssh: pi@one, can: "
                               "can0}\n";
  EXPECT_THAT(problems_of(together, kOnCan),
              ElementsAre(HasSubstr("have node 10 on one bus, can0"), HasSubstr("have node 42")));
  EXPECT_THAT(problems_of(apart),
              ElementsAre(HasSubstr("its flight controller is simulated"), testing::_));
}

TEST(Fleet, AConsoleIsNotOpenToEverybody) {
  EXPECT_THAT(problems_of("console: {address: 10.0.0.9}\n" + kHosts),
              ElementsAre(HasSubstr("everybody reaches it")));
  EXPECT_THAT(problems_of("console: {address: 10.0.0.9, passwords: /etc/skein/passwords,\n"
                          "  certificate: /etc/skein/cert.pem, key: key.pem}\n" +
                          kHosts),
              ElementsAre(HasSubstr("console.key is key.pem")));
}

TEST(Fleet, ShapesGoToTheGroundStation) {
  const std::filesystem::path file = SKEIN_SOURCE_DIR "/scenarios/formation-5.yaml";
  auto scenario = configuration::load_flyable_scenario(file);
  ASSERT_TRUE(scenario.ok()) << scenario.error().message;
  scenario->formation.shapes = {{"heart", SKEIN_SOURCE_DIR "/scenarios/shapes/heart.yaml"}};
  for (std::uint16_t id = 0; id <= 5; ++id) {
    configuration::Host host;
    host.node = VehicleId{id};
    host.address = "127.0.0.1";
    scenario->hosts.push_back(host);
  }
  const auto programs = render(*scenario, kEpoch);
  ASSERT_TRUE(programs.ok()) << programs.error().message;
  ASSERT_EQ(programs->front().more.size(), 1U);
  EXPECT_EQ(programs->front().more[0].path, "/etc/skein/formation/heart.yaml");
  EXPECT_THAT(programs->front().configuration, HasSubstr("/etc/skein/formation/heart.yaml"));
  scenario->formation.shapes[0].file = "nowhere.yaml";
  EXPECT_THAT(problems(*scenario), ElementsAre(HasSubstr("nowhere.yaml")));
}

TEST(Ids, AreReadAsPeopleWriteThem) {
  const auto ids = parse_ids("7,1-3,2");
  ASSERT_TRUE(ids.ok());
  EXPECT_THAT(*ids, ElementsAre(VehicleId{1}, VehicleId{2}, VehicleId{3}, VehicleId{7}));
  for (const char* const text : {"", "a", "1-", "-1", "3-1", "1,,2", "1,", "70000", "1 2"}) {
    EXPECT_FALSE(parse_ids(text).ok()) << text;
  }
}

}  // namespace
}  // namespace skein::fleet
