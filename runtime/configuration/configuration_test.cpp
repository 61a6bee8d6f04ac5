// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "skein/base/angles.hpp"
#include "skein/base/random.hpp"
#include "skein/configuration/deployment.hpp"
#include "skein/configuration/reference.hpp"
#include "skein/configuration/setup_params.hpp"

namespace skein::configuration {
namespace {

const std::filesystem::path kSource{SKEIN_SOURCE_DIR};

std::string read(const std::filesystem::path& file) {
  std::ifstream in{file, std::ios::binary};
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

constexpr const char* kVehicle = R"(version: 1
vehicle:
  id: 7
  cruise_speed_mps: 50
  speed_min_mps: 42
  speed_max_mps: 58
  turn_radius_m: 150
  range_m: 18000
  capabilities: [survey, deliver]
  height_m: 300
origin: {latitude_deg: 31.5, longitude_deg: 105}
start: {east_m: 10, north_m: 20, heading_deg: 15}
network:
  port: 17402
  peers:
    - {id: 0, port: 17400}
    - {id: 8, port: 17404}
time: {epoch_unix_ns: 1700000000000000000}
)";

std::string vehicle_error(const std::string& from, const std::string& to) {
  const auto result = parse_vehicle_config(replaced(kVehicle, from, to), "v.yaml");
  return result.ok() ? "no error" : result.error().message;
}

TEST(VehicleConfigFile, HoldsCompassDegreesAndSecondsAndTheStructHeadingsAndDurations) {
  const auto config =
      parse_vehicle_config(std::string{kVehicle} + "protocol: {message_delay_s: 0.25}\n", "v.yaml");
  ASSERT_TRUE(config.ok()) << config.error().message;
  EXPECT_EQ(config->vehicle.id, VehicleId{7});
  EXPECT_EQ(config->start.heading_rad, heading_from_compass_deg(15));
  EXPECT_EQ(config->protocol.message_delay, std::chrono::milliseconds{250});
  EXPECT_TRUE(config->vehicle.capabilities.has(TaskKind::deliver));
  EXPECT_FALSE(config->vehicle.capabilities.has(TaskKind::assess));
  ASSERT_EQ(config->network.peers.size(), 2U);
  EXPECT_EQ(config->network.peers[1], (NetworkPeer{VehicleId{8}, "127.0.0.1", 17404}));
}

TEST(VehicleConfigFile, NamesTheMethodOfAllocation) {
  const std::string keys = "planning: {allocation: colony, timing_weight: 0.5}\n";
  const auto config = parse_vehicle_config(kVehicle + keys, "v.yaml");
  ASSERT_TRUE(config.ok()) << config.error().message;
  EXPECT_EQ(config->planning.method, planning::AllocationMethod::colony);
  EXPECT_EQ(config->planning.weights.timing, 0.5);
  EXPECT_EQ(config->planning.weights.reward, 1.0);
  const auto again = parse_vehicle_config(to_yaml(*config), "again.yaml");
  ASSERT_TRUE(again.ok()) << again.error().message;
  EXPECT_EQ(again->planning.method, planning::AllocationMethod::colony);
  EXPECT_EQ(parse_vehicle_config(kVehicle, "v.yaml").value().planning.method,
            planning::AllocationMethod::best);
  EXPECT_FALSE(
      parse_vehicle_config(kVehicle + std::string{"planning: {allocation: count}\n"}, "v.yaml")
          .ok());
}

TEST(VehicleConfigFile, NamesTheFlightControllerOnItsBus) {
  const std::string keys =
      "flight_controller: {kind: ardupilot, can: 'mcast:3', node_id: 11, companion_node_id: 43, "
      "system_id: 7, airframe: copter, take_over: from_ground, takeoff_height_m: 25, "
      "geoid_height_m: -38.5, "
      "turn_lead_s: 0.75, airspeed_lead_s: 3}\n";
  const std::string in_formation =
      replaced(kVehicle, "capabilities: [survey, deliver]", "capabilities: []");
  const auto config = parse_vehicle_config(in_formation + keys, "v.yaml");
  ASSERT_TRUE(config.ok()) << config.error().message;
  EXPECT_TRUE(flies_formation(config->vehicle));
  for (const auto& c : {*config, parse_vehicle_config(to_yaml(*config), "again.yaml").value()}) {
    const ArdupilotConfig& fc = c.flight_controller.ardupilot;
    EXPECT_EQ(c.flight_controller.kind, FlightControllerKind::ardupilot);
    EXPECT_EQ(fc.can, "mcast:3");
    EXPECT_EQ(fc.node_id, 11);
    EXPECT_EQ(fc.companion_node_id, 43);
    EXPECT_EQ(fc.system_id, 7);
    EXPECT_EQ(c.vehicle.airframe, Airframe::copter);
    EXPECT_EQ(fc.take_over, TakeOverKind::from_ground);
    EXPECT_EQ(fc.takeoff_height_m, 25.0);
    EXPECT_EQ(fc.geoid_height_m, -38.5);
    EXPECT_EQ(c.flight_controller.follower().turn_lead_s, 0.75);
    EXPECT_EQ(c.flight_controller.follower().airspeed_lead_s, 3.0);
  }
}

struct Mistake {
  const char* from;
  const char* to;
  const char* message;
};

constexpr auto kMistakes = std::to_array<Mistake>({
    {"cruise_speed_mps: 50", "cruise_sped_mps: 50",
     "v.yaml:3: vehicle.cruise_speed_mps: is missing; add it: a number from 1 to 200 m/s\n"
     "v.yaml:3: vehicle.cruise_speed_mps: must lie between speed_min_mps and speed_max_mps; mend "
     "one of them\n"
     "v.yaml:4: vehicle.cruise_sped_mps: is no key of this group; did you mean "
     "cruise_speed_mps?"},
    {"  port: 17402", "  port: 17402\n  colour: red",
     "v.yaml:15: network.colour: is no key of this group, which knows domain_id, address, port, "
     "peers, group, limit_bytes_per_s, hops_max, keys, transport_plugin, process"},
    {"  range_m: 18000\n", "",
     "v.yaml:3: vehicle.range_m: is missing; add it: a number from 100 to 10000000 m"},
    {"range_m: 18000", "range_m: far",
     "v.yaml:8: vehicle.range_m: is \"far\", not a number; write one from 100 to 10000000 m"},
    {"range_m: 18000", "range_m: .nan",
     "v.yaml:8: vehicle.range_m: is \".nan\", not a number; write one from 100 to 10000000 m"},
    {"range_m: 18000", "range_m:",
     "v.yaml:8: vehicle.range_m: is empty, not a number; write one from 100 to 10000000 m"},
    {"range_m: 18000", "range_m: 12",
     "v.yaml:8: vehicle.range_m: is 12, outside 100 to 10000000 m; choose a number inside"},
    {"heading_deg: 15", "heading_deg: 375",
     "v.yaml:12: start.heading_deg: is 375, outside -360 to 360 deg; choose a number inside"},
    {"id: 7", "id: 7.5",
     "v.yaml:3: vehicle.id: is \"7.5\", not a whole number; write one from 1 to 65535"},
    {"id: 7", "id: 70000",
     "v.yaml:3: vehicle.id: is 70000, outside 1 to 65535; choose a number inside"},
    {"[survey, deliver]", "[survey, delivr]",
     "v.yaml:9: vehicle.capabilities[2]: is \"delivr\", not one of survey, deliver, assess; did "
     "you mean deliver?"},
    {"[survey, deliver]", "survey",
     "v.yaml:9: vehicle.capabilities: is not a list; write [a, b], or a line with \"- \" for "
     "each "
     "element"},
    {"[survey, deliver]", "[survey, deliver, assess, survey]",
     "v.yaml:9: vehicle.capabilities: has 4 elements, the most is 3; remove some"},
    {"turn_radius_m: 150", "turn_radius_m: 20",
     "v.yaml:7: vehicle.turn_radius_m: is less than cruise_speed_mps^2 / 59 m/s2, a turn of 6 g; "
     "raise it or lower cruise_speed_mps"},
    {"id: 7", "id: 255", "v.yaml:3: vehicle.id: is of the sensors; give the vehicle another"},
    {"start: {east_m: 10, north_m: 20, heading_deg: 15}", "start: 4",
     "v.yaml:12: start: is not a group of keys; write \"key: value\" lines below it"},
    {"id: 8, port", "id: 0, port",
     "v.yaml:17: network.peers[2]: is peer 0 again; the first is on line 16, give each its own "
     "id"},
    {"  id: 7", "\tid: 7", "v.yaml:3: is indented with a tab; YAML takes spaces only"},
    {"version: 1", "version: 2",
     "v.yaml:1: version: this program reads version 1 only; write 1 and compare the keys with "
     "the "
     "reference"},
    {"  id: 7", "  id: 7\n  id: 9",
     "v.yaml:4: vehicle.id: stands here a second time; the first is on line 3, remove one of "
     "them"},
    {"speed_min_mps: 42", "speed_min_mps: 52",
     "v.yaml:4: vehicle.cruise_speed_mps: must lie between speed_min_mps and speed_max_mps; mend "
     "one of them"},
    {"start:", "search: [[1, 2], [3]]\nstart:",
     "v.yaml:12: search[2]: is not [east, north]; write two numbers from -1000000 to 1000000 m"},
    {"id: 8, port", "id: 8, address: ten.one, port",
     "v.yaml:17: network.peers[2].address: is no IPv4 address; write one such as 192.168.1.7"},
    {"id: 8, port", "id: 8, address: 0.0.0.0, port",
     "v.yaml:17: network.peers[2].address: is of no one machine; write the machine's own"},
    {"1700000000000000000", "17000000000",
     "v.yaml:18: time.epoch_unix_ns: is before the year 2020; write Unix time in nanoseconds, as "
     "`date +%s%N` prints it"},
    {"start:", "recording_folder: \"a\\x01\"\nstart:",
     "v.yaml:12: recording_folder: has control characters or is no UTF-8; save the file as UTF-8"},
    {"start:", "recording_folder: a\xFF\nstart:",
     "v.yaml:12: recording_folder: has control characters or is no UTF-8; save the file as UTF-8"},
    {"start:", "recording_folder: [a]\nstart:",
     "v.yaml:12: recording_folder: is a list, not text; write it in \"quotes\""},
    {"start:", "flight_controller: {kind: ardupilot}\nstart:",
     "v.yaml:12: flight_controller.can: an ardupilot needs a CAN bus; name one, such as can0 or "
     "mcast:0"},
    {"start:", "flight_controller: {kind: ardupilott, can: can0}\nstart:",
     "v.yaml:12: flight_controller.kind: is \"ardupilott\", not one of simulated, ardupilot; did "
     "you mean ardupilot?"},
    {"start:", "flight_controller: {kind: ardupilot, can: can0, node_id: 42}\nstart:",
     "v.yaml:12: flight_controller.companion_node_id: is the autopilot's node_id too; every node "
     "on a bus has its own"},
    {"start:", "flight_controller: {kind: ardupilot, can: can0, node_id: 128}\nstart:",
     "v.yaml:12: flight_controller.node_id: is 128, outside 1 to 127; choose a number inside"},
    {"start:", "flight_controller: {airframe: copter}\nstart:",
     "v.yaml:7: vehicle.turn_radius_m: is less than cruise_speed_mps^2 / acceleration_max_mps2, "
     "which a copter's turn takes; raise it or lower cruise_speed_mps"},
    {"capabilities: [survey, deliver]", "capabilities: [survey, deliver",
     "v.yaml:10: is not YAML: end of sequence flow not found; mend the text"},
});

TEST(VehicleConfigFile, NamesEveryMistake) {
  for (const Mistake& m : kMistakes) EXPECT_EQ(vehicle_error(m.from, m.to), m.message);
}

TEST(VehicleConfigFile, NamesAFileThatCannotBeRead) {
  EXPECT_EQ(load_vehicle_config("no/such/file.yaml").error().message,
            "no/such/file.yaml: cannot be opened: No such file or directory; check the path");
  EXPECT_EQ(load_vehicle_config(kSource).error().message,
            kSource.string() + ": is a folder; name a YAML file");
  // The last: yaml-cpp finds documents in it without end.
  for (const char* text : {"", "version: 1\n---\nversion: 1\n", ",version: 1\n"}) {
    EXPECT_EQ(parse_vehicle_config(text, "v.yaml").error().message,
              "v.yaml: holds no single group of keys; write \"key: value\" lines, the first "
              "\"version: 1\"");
  }
}

constexpr const char* kScenario = R"(version: 1
title: Test
duration_max_s: 100
origin: {latitude_deg: 31.5, longitude_deg: 105}
all: {cruise_speed_mps: 50, speed_min_mps: 42, speed_max_mps: 58, turn_radius_m: 150,
  range_m: 18000}
types:
  scout: {capabilities: [survey, assess], sensor_radius_m: 300, assess_radius_m: 300}
  carrier: {capabilities: [deliver], loads: 1, final_approach_m: 300, cruise_speed_mps: 55}
vehicles:
  - {id: 1, type: scout, east_m: 0, north_m: 0, heading_deg: 0, height_m: 100}
  - {id: 2, type: carrier, east_m: 0, north_m: 500, heading_deg: 90, height_m: 110}
  - {id: 3, type: carrier, east_m: 500, north_m: 500, heading_deg: 90, height_m: 120, loads: 2}
sites:
  - id: 1
    east_m: 2000
    north_m: 2000
    survey: {start_angle_deg: 0, dwell_s: 20}
    deliveries: {mode: sequential, bearings_deg: [30, 30], interval_s: 5}
    assessments: {count: 1, wait_s: 10, dwell_s: 20, start_angles_deg: [90]}
hazards:
  - {id: 1, east_m: 1000, north_m: 1500, radius_m: 100}
operator_decisions:
  - {site: 1, decision: grant, reaction_s: 2}
faults:
  - {at_s: 50, kill_vehicle: 3}
  - {at_s: 60, for_s: 5, partition: [[0, 1], [2, 3]]}
  - {at_s: 70, for_s: 5, loss_ratio: 0.5}
  - {at_s: 80, kill_vehicle: 0}
reference:
  - {site: 1, found_by: 1, survey_done_s: 43.92, delivery_times_s: [101.44, 106.44]}
expect: {coalitions: 1, vehicles_lost: [3]}
)";

Scenario scenario() {
  const auto result = parse_scenario(kScenario, "s.yaml");
  EXPECT_TRUE(result.ok()) << result.error().message;
  return result.value();
}

std::string scenario_error(const std::string& from, const std::string& to) {
  const auto result = parse_scenario(replaced(kScenario, from, to), "s.yaml");
  return result.ok() ? "no error" : result.error().message;
}

TEST(ScenarioFile, LowerLevelsOfTheFleetOverrideHigherOnes) {
  const Scenario s = scenario();
  ASSERT_EQ(s.vehicles.size(), 3U);
  EXPECT_EQ(s.vehicles[0].spec.cruise_speed_mps, 50);
  EXPECT_EQ(s.vehicles[1].spec.cruise_speed_mps, 55);
  EXPECT_EQ(s.vehicles[1].spec.loads, 1);
  EXPECT_EQ(s.vehicles[2].spec.loads, 2);
  EXPECT_EQ(s.vehicles[2].type, "carrier");
}

TEST(ScenarioFile, AFenceIsAPolygonWithoutCrossings) {
  const auto with = [](const std::string& corners) {
    return scenario_error("hazards:", "fence: {corners: " + corners + "}\nhazards:");
  };
  EXPECT_NE(with("[[0, 0], [1, 0]]").find("has fewer than three corners"), std::string::npos);
  EXPECT_NE(with("[[0, 0], [9, 9], [9, 0], [0, 9]]").find("crosses or touches itself"),
            std::string::npos);
  EXPECT_NE(with("[[0, 0], [9, 9]").find("s.yaml"), std::string::npos);
  EXPECT_EQ(with("[[-100, -100], [3000, -100], [3000, 3000], [-100, 3000]]"), "no error");
}

TEST(ScenarioFile, ASearchIntoACornerOfTheFenceIsRefused) {
  const std::string fence =
      "fence: {corners: [[-500, -500], [3000, -500], [3000, 3000], [-500, 3000]], height_max_m: "
      "500}\n";
  const auto with = [&fence](const std::string& search) {
    const std::string text = replaced(replaced(kScenario, "hazards:", fence + "hazards:"),
                                      "height_m: 100}", "height_m: 100, search: [" + search + "]}");
    const auto s = parse_scenario(text, "s.yaml");
    EXPECT_TRUE(s.ok()) << s.error().message;
    const auto good = check(*s);
    return good ? std::string{"good"} : good.error().message;
  };
  EXPECT_EQ(with("[2995, 1000]"), "good") << "along an edge";
  EXPECT_EQ(with("[2900, 2900]"), "good");
  EXPECT_EQ(with("[2990, 2980]"),
            "the search route of vehicle 1 has the point [2990, 2980] in a corner of the fence, "
            "where it cannot turn on 165 m (turn_radius_m * turn_radius_margin) within it; move "
            "it, or widen fence.corners");
}

TEST(VehicleConfigFile, ASearchIntoACornerOfTheFenceIsRefused) {
  const auto with = [](const std::string& search) {
    const auto config = parse_vehicle_config(
        std::string{kVehicle} + "search: [" + search +
            "]\nfence: {corners: [[-500, -500], [3000, -500], [3000, 3000], [-500, 3000]], "
            "height_max_m: 500}\n",
        "v.yaml");
    return config ? std::string{"good"} : config.error().message;
  };
  EXPECT_EQ(with("[2900, 2900]"), "good");
  EXPECT_NE(with("[100, 100], [2990, 2980]").find("v.yaml:19: search: has a point in a corner"),
            std::string::npos)
      << with("[100, 100], [2990, 2980]");
}

TEST(ScenarioFile, HoldsSitesAndFaults) {
  const Scenario s = scenario();
  const Site& site = s.sites.at(0);
  EXPECT_EQ(site.survey.start_angle_rad, heading_from_compass_deg(0));
  ASSERT_EQ(site.deliveries.size(), 2U);
  EXPECT_EQ(site.deliveries[1].offset, std::chrono::seconds{5});
  EXPECT_EQ(site.deliveries[1].bearing_rad, heading_from_compass_deg(30));
  EXPECT_EQ(site.assessments.at(0).start_angle_rad, heading_from_compass_deg(90));
  ASSERT_EQ(s.faults.size(), 4U);
  EXPECT_EQ(s.faults[0].kind, FaultKind::kill_vehicle);
  EXPECT_EQ(s.faults[1].groups.at(1).at(1), VehicleId{3});
  EXPECT_EQ(s.faults[2].kind, FaultKind::loss);
  EXPECT_EQ(s.faults[3].kind, FaultKind::kill_vehicle);
  EXPECT_EQ(s.faults[3].vehicle, kGroundStation);
  EXPECT_EQ(s.reference.at(0).found_by, VehicleId{1});
  EXPECT_TRUE(check(s).ok()) << check(s).error().message;
}

TEST(ScenarioFile, NamesEveryMistake) {
  const std::vector<Mistake> mistakes{
      {"{id: 3, type: carrier", "{id: 2, type: carrier",
       "s.yaml:13: vehicles[3]: is vehicle 2 again; the first is on line 12, give each its own id"},
      {"{id: 3, type: carrier", "{id: 3, type: carier",
       "s.yaml:13: vehicles[3].type: is \"carier\", which is not among types; did you mean "
       "carrier?\n"
       "s.yaml:13: vehicles[3].capabilities: is missing; add it: a list"},
      {"turn_radius_m: 150,\n", "\n",
       "s.yaml:11: vehicles[1].turn_radius_m: is missing; add it: a number from 1 to 5000 m\n"
       "s.yaml:12: vehicles[2].turn_radius_m: is missing; add it: a number from 1 to 5000 m\n"
       "s.yaml:13: vehicles[3].turn_radius_m: is missing; add it: a number from 1 to 5000 m"},
      // Said once of the level that has it, not of every vehicle below.
      {"turn_radius_m: 150,", "turn_radius_m: 20,",
       "s.yaml:5: all.turn_radius_m: is less than cruise_speed_mps^2 / 59 m/s2, a turn of 6 g; "
       "raise it or lower cruise_speed_mps"},
      {"{id: 3, type: carrier", "{id: 3, type: carrier, turn_radius_m: 20",
       "s.yaml:13: vehicles[3].turn_radius_m: is less than cruise_speed_mps^2 / 59 m/s2, a turn of "
       "6 g; raise it or lower cruise_speed_mps"},
      {"final_approach_m: 300", "final_aproach_m: 300",
       "s.yaml:9: types.carrier.final_aproach_m: is no key of this group; did you mean "
       "final_approach_m?"},
      {", interval_s: 5", "",
       "s.yaml:19: sites[1].deliveries.interval_s: must be above 0 s when the mode is sequential, "
       "and is left out when simultaneous"},
      {"start_angles_deg: [90]", "start_angles_deg: [90, 0]",
       "s.yaml:20: sites[1].assessments.start_angles_deg: must have one angle for each assessment, "
       "or none; compare with count"},
      {"kill_vehicle: 3", "kill_vehicle: 3, for_s: 2, loss_ratio: 0.5",
       "s.yaml:26: faults[1].at_s: a fault has exactly one of kill_vehicle, partition, loss_ratio, "
       "flood_vehicle and battery_vehicle; split it or add one"},
      {"kill_vehicle: 3", "battery_vehicle: 3",
       "s.yaml:26: faults[1].battery_percent: goes with battery_vehicle; add the one that is "
       "missing"},
      {"for_s: 5, loss_ratio", "loss_ratio",
       "s.yaml:28: faults[3].for_s: a partition, loss or flood lasts for some time; add for_s "
       "above 0 s"},
      {"[2, 3]]", "[2, 2]]",
       "s.yaml:27: faults[2].partition[2][2]: is vehicle 2 again; the first is on line 27, give "
       "each its own id"},
      {"decision: grant", "decision: yes",
       "s.yaml:24: operator_decisions[1].decision: is \"yes\", not one of refuse, grant; choose "
       "one "
       "of these"},
      {"[101.44, 106.44]", "[101.44, -1]",
       "s.yaml:31: reference[1].delivery_times_s[2]: is -1, outside 0 to 1000000 s; choose a "
       "number "
       "inside"},
  };
  for (const Mistake& m : mistakes) EXPECT_EQ(scenario_error(m.from, m.to), m.message);
}

TEST(ScenarioCheck, SaysWhyAMissionIsImpossible) {
  const std::vector<Mistake> mistakes{
      {"[30, 30]", "[30, 30, 30]",
       "site 1 needs 3 deliveries, but the whole fleet has only 2 vehicles with the capability "
       "deliver, a load and the range; add vehicles or take deliveries away"},
      {"capabilities: [survey, assess]", "capabilities: [assess]",
       "site 1 cannot be surveyed: no vehicle has the capability survey; give it to one"},
      {"height_m: 100}", "height_m: 100, range_m: 3000}",
       "site 1 cannot be surveyed: none of the 1 vehicle that can survey has the range to fly "
       "there "
       "and around it; raise range_m or move one"},
      {"count: 1, wait_s: 10, dwell_s: 20, start_angles_deg: [90]", "count: 2, dwell_s: 20",
       "site 1 needs 2 assessments, but the whole fleet has only 1 vehicle with the capability "
       "assess and the range; add vehicles or take assessments away"},
      {"height_m: 120", "height_m: 113",
       "vehicle 2 and vehicle 3 fly only 3 m apart in height, expect.separation_vertical_m is 5 m; "
       "give each its own height_m"},
      {"{id: 1, east_m: 1000, north_m: 1500", "{id: 1, east_m: 0, north_m: 50",
       "vehicle 1 starts inside hazard 1; move one of them"},
      {"{id: 1, east_m: 1000, north_m: 1500", "{id: 1, east_m: 2000, north_m: 2050",
       "site 1 lies inside hazard 1; move one of them"},
      {"{id: 1, east_m: 1000, north_m: 1500", "{id: 1, east_m: 1900, north_m: 1800",
       "the final approach to site 1 on bearing 30 deg crosses hazard 1; move one of them or "
       "change "
       "the bearing\n"
       "the final approach to site 1 on bearing 30 deg crosses hazard 1; move one of them or "
       "change "
       "the bearing"},
      {"hazards:",
       "fence: {corners: [[-100, -100], [3000, -100], [3000, 1900], [-100, 1900]], height_max_m: "
       "500}\nhazards:",
       "site 1 is outside the fence; move it, or widen fence.corners"},
      {"hazards:",
       "fence: {corners: [[100, -100], [3000, -100], [3000, 3000], [100, 3000]], height_max_m: "
       "115}\nhazards:",
       "vehicle 1 starts outside the fence; move it, or widen fence.corners\n"
       "vehicle 2 starts outside the fence; move it, or widen fence.corners\n"
       "vehicle 3 flies at 120 m, fence.height_max_m is 115 m; lower its height_m or raise that"},
      {"sensor_radius_m: 300", "sensor_radius_m: 160",
       "vehicle 1 cannot fly circles of its sensor_radius_m 160 m: it turns on 165 m "
       "(turn_radius_m "
       "* turn_radius_margin); raise sensor_radius_m"},
      {"title: Test", "title: Test\nwind: {speed_mps: 45}",
       "vehicle 1 cannot hold its course: the wind of 45 m/s with gusts reaches its speed_min_mps "
       "42 "
       "m/s; lower the wind\n"
       "vehicle 2 cannot hold its course: the wind of 45 m/s with gusts reaches its speed_min_mps "
       "42 "
       "m/s; lower the wind\n"
       "vehicle 3 cannot hold its course: the wind of 45 m/s with gusts reaches its speed_min_mps "
       "42 "
       "m/s; lower the wind"},
      {"title: Test", "title: Test\nradio: {delay_ms_mean: 150, delay_ms_jitter: 60}",
       "the radio delays messages by up to 210 ms, the protocol allows 200 ms; lower "
       "radio.delay_ms_mean or raise protocol.message_delay_s"},
      {"kill_vehicle: 3", "kill_vehicle: 4",
       "the fault at 50 s names vehicle 4, which is not in the fleet"},
      {"{site: 1, decision", "{site: 2, decision",
       "operator_decisions names site 2, which is not among the sites"},
      {"coalitions: 1", "coalitions: 2",
       "expect.coalitions is 2, but there are only 1 site; lower it"},
      {"at_s: 70", "at_s: 170", "the fault at 170 s comes after duration_max_s; move one of them"},
  };
  for (const Mistake& m : mistakes) {
    const auto parsed = parse_scenario(replaced(kScenario, m.from, m.to), "s.yaml");
    ASSERT_TRUE(parsed.ok()) << parsed.error().message;
    const auto checked = check(*parsed);
    EXPECT_EQ(checked.ok() ? "no error" : checked.error().message, m.message);
  }
}

TEST(ScenarioFile, ACopterThatTakesTasksMustBeAbleToFlyItsPlans) {
  const std::string scout = "scout: {capabilities: [survey, assess],";
  const std::string copter = scout +
                             " flight_controller: {airframe: copter}, cruise_speed_mps: 9, "
                             "speed_min_mps: 0.5, speed_max_mps: 12,";
  EXPECT_EQ(scenario_error(scout, copter + " turn_radius_m: 27,"), "no error") << "81 / 27 = 3";
  EXPECT_EQ(scenario_error(scout, copter + " turn_radius_m: 26,"),
            "s.yaml:8: types.scout.turn_radius_m: is less than cruise_speed_mps^2 / "
            "acceleration_max_mps2, which a copter's turn takes; raise it or lower "
            "cruise_speed_mps");
  EXPECT_EQ(scenario_error(scout, copter + " turn_radius_m: 26, acceleration_max_mps2: 3.2,"),
            "no error");
  const auto low = replaced(replaced(kScenario, scout, copter + " turn_radius_m: 30,"),
                            "heading_deg: 0, height_m: 100", "heading_deg: 0, height_m: 4");
  EXPECT_EQ(parse_scenario(low, "s.yaml").error().message,
            "s.yaml:11: vehicles[1].height_m: is below 5 m, and a copter takes off to it; raise "
            "it");
}

/// Its vehicle 1 is a copter.
Scenario mixed() {
  Scenario s = scenario();
  VehicleSpec& copter = s.vehicles[0].spec;
  copter.airframe = Airframe::copter;
  copter.cruise_speed_mps = 8.0;
  copter.speed_min_mps = 0.5;
  copter.speed_max_mps = 12.0;
  copter.turn_radius_m = 30.0;
  copter.height_m = 40.0;
  return s;
}

std::string check_error(const Scenario& s) {
  const auto checked = check(s);
  return checked.ok() ? "no error" : checked.error().message;
}

TEST(ScenarioCheck, CoptersAndPlanesFlyOneMissionWhereEachCan) {
  EXPECT_EQ(check_error(mixed()), "no error");
  Scenario s = mixed();
  s.vehicles[0].spec.height_m = 115.0;
  EXPECT_EQ(check_error(s),
            "vehicle 1 would take off through the height of vehicle 2, a plane at 110 m; give "
            "copters a lower height_m than planes");
  s = mixed();
  s.wind.speed_mps = 5.0;
  EXPECT_EQ(
      check_error(s),
      "vehicle 1 cannot keep its cruise_speed_mps 8 m/s against the wind of 5 m/s with gusts: "
      "its speed_max_mps is 12 m/s; lower cruise_speed_mps or the wind");
  s = mixed();
  s.vehicles.push_back(s.vehicles[0]);
  s.vehicles.back().spec.id = VehicleId{4};
  s.vehicles.back().spec.height_m = 50.0;
  s.vehicles.back().start.x_m += 6.0;
  EXPECT_EQ(check_error(s),
            "vehicle 1 and vehicle 4 take off only 6 m from each other, "
            "expect.separation_horizontal_m is 20 m; move one's start");
  s.vehicles.back().start.x_m += 60.0;
  EXPECT_EQ(check_error(s), "no error");
  s.vehicles.back().spec.height_m = 42.0;
  EXPECT_EQ(check_error(s),
            "vehicle 1 and vehicle 4 fly only 2 m apart in height, expect.separation_vertical_m is "
            "5 m; give each its own height_m");
  s = mixed();
  s.routes.approaches.push_back({.vehicle = VehicleId{1}});
  EXPECT_EQ(check_error(s),
            "routes.approaches names vehicle 1, a copter; routes are flown by planes: take its "
            "approach away");
}

TEST(ScenarioCheck, ACopterWithoutCapabilitiesIsForFormations) {
  Scenario s = mixed();
  s.vehicles.push_back(s.vehicles[0]);
  s.vehicles.back().spec.id = VehicleId{4};
  s.vehicles.back().spec.capabilities = {};
  EXPECT_TRUE(s.flies_formation());
  EXPECT_EQ(check_error(s),
            "vehicle 4 is a copter without capabilities, which flies in formation, and others do "
            "not; give it capabilities such as [survey, assess], or fly them in two missions\n"
            "vehicle 4 is a copter without capabilities, which flies in formation and does no "
            "tasks at sites; give it capabilities such as [survey, assess], or take the sites "
            "away");
  s = mixed();
  EXPECT_FALSE(s.flies_formation());
  s.formation.script = {"take-off"};
  EXPECT_EQ(check_error(s),
            "formation.script has orders, but no vehicle flies in formation; give vehicles "
            "flight_controller: {airframe: copter} and capabilities: []");
}

std::vector<std::filesystem::path> shipped() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator{kSource / "scenarios"}) {
    if (entry.path().extension() == ".yaml") files.push_back(entry.path());
  }
  EXPECT_GE(files.size(), 2U);
  return files;
}

TEST(ShippedScenarios, LoadAndCheckAndRoundTrip) {
  for (const auto& file : shipped()) {
    const auto loaded = load_scenario(file);
    ASSERT_TRUE(loaded.ok()) << loaded.error().message;
    const auto checked = check(*loaded);
    EXPECT_TRUE(checked.ok()) << file << "\n" << checked.error().message;
    const std::string written = to_yaml(*loaded);
    const auto again = parse_scenario(written, "written");
    ASSERT_TRUE(again.ok()) << again.error().message;
    EXPECT_EQ(to_yaml(*again), written);
    ASSERT_EQ(again->vehicles.size(), loaded->vehicles.size());
    for (std::size_t i = 0; i < loaded->vehicles.size(); ++i) {
      EXPECT_EQ(again->vehicles[i].start.heading_rad, loaded->vehicles[i].start.heading_rad);
      EXPECT_EQ(again->vehicles[i].type, loaded->vehicles[i].type);
    }
  }
}

TEST(Deployment, GivesEveryNodeItsPortItsPeersAndItsSeed) {
  Scenario s = scenario();
  s.hazards.push_back({{HazardId{2}, {0.0, 900.0}, 50.0}, at_seconds(40)});
  Deployment deployment;
  deployment.time = {1'700'000'000'123'456'789, 2.5};
  deployment.recording_folder = "/tmp/run \"1\"";
  deployment.dds = true;
  const auto vehicles = vehicle_configs(s, deployment);
  s.fence.corners = {{-100.0, -100.0}, {3000.0, -100.0}, {0.0, 3000.0}};
  const GroundConfig ground = ground_config(s, deployment);
  EXPECT_EQ(ground.fence, s.fence);
  const auto read = parse_ground_config(to_yaml(ground), "g.yaml");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->fence, s.fence);
  ASSERT_EQ(vehicles.size(), 3U);
  EXPECT_EQ(ground.network.port, 17400);
  EXPECT_EQ(ground.network.peers.size(), 3U);
  EXPECT_EQ(vehicles[2].network.port, 17406);
  ASSERT_EQ(vehicles[2].network.peers.size(), 3U);
  EXPECT_EQ(vehicles[2].network.peers[0], (NetworkPeer{VehicleId{0}, "127.0.0.1", 17400}));
  EXPECT_EQ(vehicles[2].hazards.size(), 1U);
  EXPECT_NE(vehicles[0].seed, vehicles[1].seed);
  EXPECT_THAT(ground.vehicles, testing::ElementsAre(VehicleId{1}, VehicleId{2}, VehicleId{3}));
}

TEST(SetupParams, OfFormationsOnlyWhatVehiclesFlyByIsInCommon) {
  GroundConfig config;
  const auto common = [&config] { return setup_params(config, {"1.0", "wire"}).common; };
  const auto before = common();
  config.formation.rally.spacing_m = 9.0;
  config.formation.separation.horizontal_m = 7.0;
  config.formation.reserve_m = 2.0;
  config.formation.ceiling_m = 90.0;
  config.formation.wind_mps = 3.0;
  EXPECT_EQ(common(), before) << "the ground station plans by these, and vehicles do not read them";
  config.formation.tracking_m = 0.7;
  EXPECT_NE(common(), before);
  config.formation.tracking_m = FormationConfig{}.tracking_m;
  EXPECT_EQ(common(), before);
  config.formation.limits.speed_mps = 2.0;
  EXPECT_NE(common(), before);
}

TEST(Deployment, GivesFlightControllersOnCanBusesAndNodesOfTheirOwn) {
  Scenario s = scenario();
  s.vehicles[0].flight_controller.kind = FlightControllerKind::ardupilot;
  s.vehicles[2].flight_controller.kind = FlightControllerKind::ardupilot;
  Deployment deployment;
  deployment.can_buses = {"mcast:5", "mcast:9"};
  auto vehicles = vehicle_configs(s, deployment);
  const auto& first = vehicles[0].flight_controller.ardupilot;
  const auto& second = vehicles[2].flight_controller.ardupilot;
  EXPECT_EQ(first.can, "mcast:5");
  EXPECT_EQ(second.can, "mcast:9");
  EXPECT_EQ(first.take_over, TakeOverKind::in_flight);
  EXPECT_EQ((std::set<int>{first.node_id, first.companion_node_id, second.node_id,
                           second.companion_node_id}
                 .size()),
            4U);
  EXPECT_EQ(vehicles[1].flight_controller.kind, FlightControllerKind::simulated);
  deployment.can_buses = {"vcan0"};
  vehicles = vehicle_configs(s, deployment);
  EXPECT_EQ(vehicles[2].flight_controller.ardupilot.can, "vcan0");
  // What the scenario names itself stays.
  s.vehicles[0].flight_controller.ardupilot.can = "can7";
  s.vehicles[0].flight_controller.ardupilot.node_id = 99;
  EXPECT_EQ(vehicle_configs(s, deployment)[0].flight_controller.ardupilot.can, "can7");
  EXPECT_EQ(vehicle_configs(s, deployment)[0].flight_controller.ardupilot.node_id, 99);
}

TEST(ScenarioCheck, WantsNodesOfTheirOwnOnASharedBus) {
  Scenario s = scenario();
  for (auto& v : s.vehicles) v.flight_controller.kind = FlightControllerKind::ardupilot;
  EXPECT_TRUE(check(s).ok()) << check(s).error().message;
  s.vehicles[0].flight_controller.ardupilot.can = "vcan0";
  s.vehicles[1].flight_controller.ardupilot.can = "vcan0";
  s.vehicles[1].flight_controller.ardupilot.node_id = 11;
  ASSERT_FALSE(check(s).ok());
  EXPECT_EQ(check(s).error().message,
            "vehicle 2 and vehicle 1 have node 42 on bus vcan0; give each node its own id");
}

TEST(ScenarioCheck, PlanesInFormationDoNothingElse) {
  auto s = load_scenario(kSource / "scenarios" / "formation-planes-5.yaml");
  ASSERT_TRUE(s.ok()) << s.error().message;
  EXPECT_TRUE(check(*s).ok()) << check(*s).error().message;
  EXPECT_TRUE(s->flies_formation());
  const GroundConfig ground = ground_config(*s, {});
  ASSERT_EQ(ground.planes.size(), 5U);
  EXPECT_EQ(ground.planes[2].height_m, 120.0);
  Scenario with_sites = *s;
  with_sites.sites.emplace_back();
  EXPECT_NE(check(with_sites).error().message.find("planes in formation do no tasks"),
            std::string::npos);
  Scenario landing = *s;
  landing.ends = Ending::landed;
  EXPECT_NE(check(landing).error().message.find("leave ends out"), std::string::npos);
  Scenario with_copter = *s;
  with_copter.vehicles[0].spec.airframe = Airframe::copter;
  EXPECT_NE(check(with_copter).error().message.find("vehicle 1 is a copter"), std::string::npos);
  Scenario one_height = *s;
  one_height.vehicles[1].spec.height_m = one_height.vehicles[0].spec.height_m;
  EXPECT_NE(check(one_height).error().message.find("give each its own height_m"),
            std::string::npos);
}

TEST(Deployment, WhatIsWrittenIsReadBackExactly) {
  for (const auto& file : shipped()) {
    const auto s = load_scenario(file);
    ASSERT_TRUE(s.ok());
    Deployment deployment;
    deployment.time = {1'700'000'000'123'456'789, 2.5};
    deployment.recording_folder = "/tmp/run \"1\"";
    deployment.can_buses = {"mcast:1"};
    for (const VehicleConfig& config : vehicle_configs(*s, deployment)) {
      const auto read_back = parse_vehicle_config(to_yaml(config), "written");
      ASSERT_TRUE(read_back.ok()) << read_back.error().message;
      EXPECT_EQ(to_yaml(*read_back), to_yaml(config));
      EXPECT_EQ(read_back->start.heading_rad, config.start.heading_rad);
      EXPECT_EQ(read_back->flight_controller.wind.from_rad, config.flight_controller.wind.from_rad);
      EXPECT_EQ(read_back->network, config.network);
      EXPECT_EQ(read_back->time, config.time);
      EXPECT_EQ(read_back->seed, config.seed);
      EXPECT_EQ(read_back->search, config.search);
      EXPECT_EQ(read_back->recording_folder, config.recording_folder);
      EXPECT_EQ(read_back->protocol.message_delay, config.protocol.message_delay);
      EXPECT_EQ(read_back->vehicle.capabilities, config.vehicle.capabilities);
    }
    const GroundConfig ground = ground_config(*s, deployment);
    const auto read_back = parse_ground_config(to_yaml(ground), "written");
    ASSERT_TRUE(read_back.ok()) << read_back.error().message;
    EXPECT_EQ(read_back->operator_decisions, ground.operator_decisions);
    EXPECT_EQ(read_back->vehicles, ground.vehicles);
    EXPECT_EQ(read_back->network, ground.network);
  }
}

TEST(Writer, KeepsAnyHeading) {
  Random random{3};
  VehicleConfig config = *parse_vehicle_config(kVehicle, "v.yaml");
  for (int i = 0; i < 200; ++i) {
    config.start.heading_rad = random.uniform(-kPi, kPi);
    const auto again = parse_vehicle_config(to_yaml(config), "written");
    ASSERT_TRUE(again.ok()) << again.error().message;
    EXPECT_NEAR(again->start.heading_rad, config.start.heading_rad, 1e-14);
  }
}

TEST(MutatedFiles, EndInAValueOrASentence) {
  const std::string alphabet = "[]{}:,-#&*!|>'\"%@`\n\t 019.eE~?<=\\\xc3\xff";
  Random random{17};
  for (int i = 0; i < 1500; ++i) {
    std::string text = i % 2 == 0 ? kScenario : kVehicle;
    const std::uint64_t changes = 1 + random.index(6);
    for (std::uint64_t c = 0; c < changes; ++c) {
      const std::size_t at = random.index(text.size());
      switch (random.index(4)) {
        case 0:
          text[at] = alphabet[random.index(alphabet.size())];
          break;
        case 1:
          text.erase(at, 1 + random.index(20));
          break;
        case 2:
          text.insert(at, 1, alphabet[random.index(alphabet.size())]);
          break;
        default:
          text.insert(at, text.substr(random.index(text.size()), random.index(60)));
          break;
      }
      if (text.empty()) text.assign(1, ' ');
    }
    if (i % 2 == 0) {
      const auto result = parse_scenario(text, "s.yaml");
      if (result.ok()) {
        static_cast<void>(check(*result));
      } else {
        EXPECT_TRUE(result.error().message.starts_with("s.yaml")) << text;
      }
    } else if (const auto result = parse_vehicle_config(text, "v.yaml"); !result.ok()) {
      EXPECT_TRUE(result.error().message.starts_with("v.yaml")) << text;
    }
  }
}

TEST(MutatedFiles, AreNotFollowedIntoTheDeep) {
  EXPECT_FALSE(parse_scenario(std::string(100'000, '['), "s.yaml").ok());
  EXPECT_FALSE(parse_scenario("a: &a [*a]\nversion: &b {x: *b}\n", "s.yaml").ok());
}

void expect_page(const std::filesystem::path& file, const std::string& page) {
  // One thread. NOLINTNEXTLINE(concurrency-mt-unsafe)
  if (std::getenv("SKEIN_UPDATE_DOCS") != nullptr) std::ofstream{file, std::ios::binary} << page;
  EXPECT_EQ(read(file), page) << "run configuration_test with SKEIN_UPDATE_DOCS=1 to print "
                              << file;
}

TEST(ReferencePages, AreWhatTheTablesPrint) {
  expect_page(kSource / "docs" / "scenarios.md", scenario_reference());
  expect_page(kSource / "docs" / "configuration.md", configuration_reference());
}

}  // namespace
}  // namespace skein::configuration
