// SPDX-License-Identifier: Apache-2.0
#include "skein/recording_export/recording_export.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "skein/configuration/vehicle_config.hpp"
#include "skein/recording/writer.hpp"

namespace skein::recording_export {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class RecordingExport : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("skein-export-" + std::to_string(::getpid()) + "-" +
               ::testing::UnitTest::GetInstance()->current_test_info()->name());
    configuration::VehicleConfig config;
    config.time.epoch_unix_ns = 1'700'000'000'000'000'000;
    config.vehicle.id = VehicleId{7};
    config.vehicle.cruise_speed_mps = 50.0;
    config.vehicle.speed_min_mps = 40.0;
    config.vehicle.speed_max_mps = 60.0;
    config.vehicle.turn_radius_m = 100.0;
    config.vehicle.range_m = 40000.0;
    config.vehicle.sensor_radius_m = 300.0;
    config.vehicle.height_m = 100.0;
    config.search = {{2000.0, 0.0}};
    config.origin = {47.0, 8.0, 500.0};
    recording::Writer::Options options;
    options.session.node = VehicleId{7};
    options.session.program = "skein-onboard";
    options.session.version = "0.1.0";
    options.session.configuration = to_yaml(config);
    auto writer = recording::Writer::open(folder_ / "vehicle-07", options);
    ASSERT_TRUE(writer.ok());
    for (int i = 0; i < 3; ++i) {
      recording::TrackPoint point;
      point.state.time = at_seconds(0.05 * i);
      point.state.y_m = 1000.0 * i;
      point.state.z_m = 0.1 + 0.2;
      writer->write(point);
    }
    mission::MissionEvent event;
    event.vehicle = VehicleId{7};
    event.time = at_seconds(0.06);
    event.body = mission::event::Authorised{"\"her\" <there>"};
    writer->write(event);
    recording::PlanRecord plan;
    plan.plan.speed_mps = 50.0 / 3.0;
    plan.plan.path.segments.push_back({0.0, 12.5});
    plan.plan.path.segments.push_back({0.01, 7.0});
    writer->write(plan);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::string text_of(const std::string& name) const {
    std::ifstream file{folder_ / "out" / name};
    return {std::istreambuf_iterator<char>{file}, {}};
  }

  std::filesystem::path folder_;
};

TEST_F(RecordingExport, CsvHasEverythingExactly) {
  const auto written = write(folder_, Format::csv, folder_ / "out");
  ASSERT_TRUE(written.ok()) << written.error().message;
  EXPECT_EQ(written->damaged, 0U);
  EXPECT_TRUE(written->complete);
  EXPECT_THAT(written->files,
              ElementsAre("vehicle-07/events.csv", "vehicle-07/track.csv", "vehicle-07/plans.csv"));
  const auto track = text_of("vehicle-07/track.csv");
  EXPECT_THAT(track, StartsWith("time_s,x_m,y_m,z_m,heading_rad,"));
  EXPECT_THAT(track, HasSubstr("\n0.050000000,0,1000,0.30000000000000004,0,"));
  EXPECT_THAT(text_of("vehicle-07/events.csv"),
              HasSubstr("\n60000000,7,authorised,0,0,0,0,0,survey,0,\"by \"\"her\"\" <there>\"\n"));
  EXPECT_THAT(text_of("vehicle-07/plans.csv"),
              HasSubstr("\n0,0,0,16.666666666666668,0,0,0,0,0:12.5|0.01:7\n"));
}

TEST_F(RecordingExport, GeojsonAndKmlSayWhereItWas) {
  ASSERT_TRUE(write(folder_, Format::geojson, folder_ / "out").ok());
  const auto geojson = text_of("flight.geojson");
  EXPECT_THAT(geojson, HasSubstr("\"LineString\",\"coordinates\":[[8.0,47.0,500.3],"));
  EXPECT_THAT(geojson, HasSubstr("\"event\":\"authorised\""));
  EXPECT_THAT(geojson, HasSubstr("\\\"her\\\" <there>"));
  EXPECT_THAT(geojson, HasSubstr("\"Point\",\"coordinates\":[8.0,47.0089"));
  ASSERT_TRUE(write(folder_, Format::kml, folder_ / "out").ok());
  const auto kml = text_of("flight.kml");
  EXPECT_THAT(kml, HasSubstr("8.0000000,47.0000000,0.3 8.0000000,47.0089"));
  EXPECT_THAT(kml, HasSubstr("&lt;there&gt;"));
}

TEST_F(RecordingExport, SummaryTellsWhatIsThere) {
  const auto text = summary(folder_ / "vehicle-07" / recording::kFileName);
  ASSERT_TRUE(text.ok()) << text.error().message;
  EXPECT_THAT(*text, StartsWith("node 7: skein-onboard 0.1.0, instance 0000000000000000, mission "
                                "time 0 is 2001-09-09 01:46:40 UTC\n"));
  EXPECT_THAT(*text, HasSubstr("5 records from 0.000 to 0.100 s; complete\n"));
  EXPECT_THAT(*text, HasSubstr("3    30.00 Hz  /vehicle_07/track\n"));
}

TEST_F(RecordingExport, ATornRecordingIsSaidToBeTorn) {
  const auto file = folder_ / "vehicle-07" / recording::kFileName;
  std::filesystem::resize_file(file, std::filesystem::file_size(file) * 3 / 4);
  const auto torn = write(folder_, Format::csv, folder_ / "out");
  ASSERT_TRUE(torn.ok()) << torn.error().message;
  EXPECT_FALSE(torn->complete);
  std::filesystem::resize_file(file, 100);
  const auto nothing = write(folder_, Format::csv, folder_ / "out");
  EXPECT_FALSE(nothing.ok());
}

TEST_F(RecordingExport, WhatCannotBeDoneIsTold) {
  EXPECT_THAT(write(folder_ / "none", Format::csv, folder_ / "out").error().message,
              HasSubstr("none"));
  std::ofstream{folder_ / "file"} << "in the way";
  EXPECT_THAT(write(folder_, Format::csv, folder_ / "file").error().message,
              HasSubstr("cannot write"));
  EXPECT_FALSE(summary(folder_ / "none").ok());
}

}  // namespace
}  // namespace skein::recording_export
