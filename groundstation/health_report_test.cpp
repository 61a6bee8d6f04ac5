// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/health_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace skein::groundstation {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

HealthFacts good() {
  HealthFacts facts;
  facts.version = "0.2.0";
  facts.now = at_seconds(12.5);
  facts.received = 40;
  facts.shall_record = true;
  facts.recordings = 1;
  facts.disk_free_bytes = 60'000'000'000;
  facts.clock = process::ClockState{true, std::chrono::milliseconds{2}};
  return facts;
}

mission::Fleet fleet() {
  mission::Fleet fleet{{.expected = {{1}, {2}}}};
  mission::Telemetry telemetry;
  telemetry.vehicle = {1};
  telemetry.control_overruns = 3;
  fleet.on_message(telemetry, at_seconds(12.0));
  return fleet;
}

TEST(MachineReport, OfAGroundStationThatDoesItsPart) {
  const auto report = machine_report(good(), fleet());
  EXPECT_TRUE(report.healthy);
  EXPECT_EQ(report.health,
            R"({"healthy":true,"problems":[],"version":"0.2.0","mission_time_s":12.5,)"
            R"("vehicles":{"expected":2,"heard":1},"authorisations_waiting":0})"
            "\n");
}

TEST(MachineReport, NamesWhatKeepsItFromItsPart) {
  const auto ill = [](const auto& change) {
    HealthFacts facts = good();
    change(facts);
    const auto report = machine_report(facts, fleet());
    EXPECT_EQ(report.healthy, report.health.find("\"problems\":[]") != std::string::npos);
    return report.health;
  };
  EXPECT_THAT(ill([](HealthFacts& facts) { facts.recordings = 0; }), HasSubstr("recorded"));
  EXPECT_THAT(ill([](HealthFacts& facts) { facts.disk_free_bytes = 1000; }), HasSubstr("disk"));
  EXPECT_THAT(ill([](HealthFacts& facts) { facts.clock->synchronised = false; }),
              HasSubstr("clock"));
  EXPECT_THAT(ill([](HealthFacts& facts) { facts.clock->error_max = std::chrono::seconds{1}; }),
              HasSubstr("clock"));
  EXPECT_THAT(ill([](HealthFacts& facts) {
                facts.clock->synchronised = false;
                facts.among_machines = false;
              }),
              HasSubstr("\"healthy\":true"));
}

TEST(MachineReport, IsReadByPrometheus) {
  const auto metrics = machine_report(good(), fleet()).metrics;
  EXPECT_THAT(metrics, HasSubstr("# HELP skein_vehicles_heard Vehicles whose telemetry is heard\n"
                                 "# TYPE skein_vehicles_heard gauge\n"
                                 "skein_vehicles_heard 1\n"));
  EXPECT_THAT(metrics, HasSubstr("skein_messages_received_total 40\n"));
  EXPECT_THAT(metrics, HasSubstr("skein_build_info{version=\"0.2.0\"} 1\n"));
  EXPECT_THAT(metrics, HasSubstr("skein_vehicle_up{vehicle=\"1\"} 1\n"
                                 "skein_vehicle_up{vehicle=\"2\"} 0\n"));
  EXPECT_THAT(metrics, HasSubstr("skein_vehicle_telemetry_age_seconds{vehicle=\"1\"} 0.5\n"));
  EXPECT_THAT(metrics, HasSubstr("skein_vehicle_control_overruns_total{vehicle=\"1\"} 3\n"));
  EXPECT_THAT(metrics, Not(HasSubstr("age_seconds{vehicle=\"2\"}")));  // never heard
}

}  // namespace
}  // namespace skein::groundstation
