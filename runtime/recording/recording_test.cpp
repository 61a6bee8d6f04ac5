// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "skein/recording/log.hpp"
#include "skein/recording/reader.hpp"
#include "skein/recording/writer.hpp"

namespace skein::recording {
namespace {

using mission::EventKind;
using mission::MissionEvent;
using ::testing::HasSubstr;

class RecordingTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("skein-recording-" + std::to_string(::getpid()) + "-" +
               ::testing::UnitTest::GetInstance()->current_test_info()->name());
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_;
};

MissionEvent awkward_event() {
  MissionEvent event;
  event.vehicle = VehicleId{7};
  event.time = Instant{Duration{123456789012345}};
  event.round = {{VehicleId{27}, InstanceId{0xFFFFFFFFFFFFFFFFULL}, 3}, 4};
  event.task = {SiteId{3}, TaskKind::deliver, 5};
  event.body = mission::event::AllocationDone{
      from_seconds(1.5), 9, planning::AllocationMethod::colony, 0.1 + 0.2, false, 1e-9};
  return event;
}

TEST_F(RecordingTest, WhatIsWrittenReadsBack) {
  PlanRecord plan;
  plan.number = 2;
  plan.since = Instant{Duration{5'000'000'001}};
  plan.plan.start_time = Instant{Duration{-4}};
  plan.plan.speed_mps = 50.0 / 3.0;
  plan.plan.tail_curvature_per_m = -1.0 / 150.0;
  plan.plan.path.start = {1.0 / 3.0, -2e-9, 3.1};
  plan.plan.path.segments.push_back({1.0 / 170.0, 1234.5678901234});
  plan.plan.path.segments.push_back({0.0, 1e-12});
  TrackPoint point;
  point.state = {at_seconds(17.05), 2200.12345, -3.5, 300.0, -3.1415926, 1.5, 49.9, 50.1, 852.5};
  point.plan_number = 2;
  point.along_error_m = -1.25;
  {
    auto writer = Writer::open(folder_);
    ASSERT_TRUE(writer.ok());
    writer->write(point);
    writer->write(awkward_event());
    writer->write(plan);
    writer->write(PlanRecord{});
    EXPECT_TRUE(writer->flush().ok());
  }
  const auto read_back = read(folder_, VehicleId{7});
  ASSERT_TRUE(read_back.ok()) << read_back.error().message;
  EXPECT_EQ(read_back->vehicle, VehicleId{7});
  EXPECT_EQ(read_back->damaged_parts, 0U);

  ASSERT_EQ(read_back->track.size(), 1U);
  EXPECT_EQ(read_back->track[0].state.time, point.state.time);
  EXPECT_EQ(read_back->track[0].state.x_m, point.state.x_m);
  EXPECT_EQ(read_back->track[0].state.heading_rad, point.state.heading_rad);
  EXPECT_EQ(read_back->track[0].plan_number, 2U);
  EXPECT_EQ(read_back->track[0].along_error_m, -1.25);

  const MissionEvent expected = awkward_event();
  ASSERT_EQ(read_back->events.size(), 1U);
  const MissionEvent& event = read_back->events[0];
  EXPECT_EQ(event.time, expected.time);
  EXPECT_EQ(event.round, expected.round);
  EXPECT_EQ(event.task, expected.task);
  EXPECT_EQ(event.body, expected.body);

  ASSERT_EQ(read_back->plans.size(), 2U);
  const PlanRecord& first = read_back->plans[0];
  EXPECT_EQ(first.since, plan.since);
  EXPECT_EQ(first.plan.start_time, plan.plan.start_time);
  EXPECT_EQ(first.plan.speed_mps, plan.plan.speed_mps);
  EXPECT_EQ(first.plan.path.start.y_m, plan.plan.path.start.y_m);
  ASSERT_EQ(first.plan.path.segments.size(), 2U);
  EXPECT_EQ(first.plan.path.segments[0].curvature_per_m, 1.0 / 170.0);
  EXPECT_EQ(first.plan.path.segments[1].length_m, 1e-12);
  EXPECT_TRUE(read_back->plans[1].plan.path.segments.empty());
}

TEST_F(RecordingTest, EveryEventKindReadsBack) {
  {
    auto writer = Writer::open(folder_);
    ASSERT_TRUE(writer.ok());
    MissionEvent event;
    for (std::size_t i = 0; i < static_cast<std::size_t>(EventKind::count); ++i) {
      event.body = mission::body_of(static_cast<EventKind>(i));
      writer->write(event);
    }
  }
  const auto read_back = read(folder_, VehicleId{1});
  ASSERT_TRUE(read_back.ok()) << read_back.error().message;
  ASSERT_EQ(read_back->events.size(), static_cast<std::size_t>(EventKind::count));
  for (std::size_t i = 0; i < read_back->events.size(); ++i) {
    EXPECT_EQ(read_back->events[i].kind(), static_cast<EventKind>(i));
  }
}

TEST_F(RecordingTest, WhatIsCutOffAtTheEndIsLeftOutAndCounted) {
  {
    auto writer = Writer::open(folder_);
    ASSERT_TRUE(writer.ok());
    writer->write(awkward_event());
    ASSERT_TRUE(writer->flush().ok());
    writer->write(awkward_event());
  }
  const auto file = folder_ / kFileName;
  std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
  const auto read_back = read(folder_, VehicleId{7});
  ASSERT_TRUE(read_back.ok()) << read_back.error().message;
  EXPECT_LE(read_back->events.size(), 1U);
  EXPECT_EQ(read_back->damaged_parts, 1U);
}

TEST_F(RecordingTest, AFileOfAnotherKindIsRefused) {
  std::filesystem::create_directories(folder_);
  std::ofstream{folder_ / kFileName} << "time,x,y\n1,2,3\n";
  const auto read_back = read(folder_, VehicleId{1});
  ASSERT_FALSE(read_back.ok());
  EXPECT_THAT(read_back.error().message, HasSubstr("recording.mcap is no MCAP file"));
}

TEST_F(RecordingTest, AnEarlierProcessDoesNotCount) {
  for (const std::uint64_t instance : {11U, 12U}) {
    Writer::Options options;
    options.session.instance = InstanceId{instance};
    auto writer = Writer::open(folder_, options);
    ASSERT_TRUE(writer.ok());
    writer->write(awkward_event());
  }
  EXPECT_TRUE(std::filesystem::exists(folder_ / older_file_name(1)));
  const auto read_back = read(folder_, VehicleId{7});
  ASSERT_TRUE(read_back.ok());
  EXPECT_EQ(read_back->events.size(), 1U);
}

TEST_F(RecordingTest, EachProcessThatHadTheFolderIsReadByItself) {
  for (const std::uint64_t instance : {11U, 12U}) {
    Writer::Options options;
    options.session.node = VehicleId{7};
    options.session.instance = InstanceId{instance};
    options.session.epoch_unix_ns += static_cast<std::int64_t>(instance);
    auto writer = Writer::open(folder_, options);
    ASSERT_TRUE(writer.ok());
    for (std::uint64_t i = 10; i < instance; ++i) writer->write(awkward_event());
  }
  const auto sessions = read_sessions(folder_, VehicleId{7});
  ASSERT_EQ(sessions.size(), 2U);
  EXPECT_EQ(sessions[0].session.instance, InstanceId{11});
  EXPECT_EQ(sessions[0].recording.events.size(), 1U);
  EXPECT_EQ(sessions[1].session.instance, InstanceId{12});
  EXPECT_EQ(sessions[1].recording.events.size(), 2U);
  EXPECT_EQ(sessions[1].session.epoch_unix_ns, Session::kEpochOfTests + 12);
  EXPECT_TRUE(read_sessions(folder_ / "nowhere", VehicleId{7}).empty());
}

TEST_F(RecordingTest, ManyNewStartsTakeNothingOfTheMissionWhileThereIsRoom) {
  const auto start = [this](std::uint64_t instance, std::int64_t epoch_unix_ns) {
    Writer::Options options;
    options.session.node = VehicleId{7};
    options.session.instance = InstanceId{instance};
    options.session.epoch_unix_ns = epoch_unix_ns;
    auto writer = Writer::open(folder_, options);
    ASSERT_TRUE(writer.ok());
    writer->write(awkward_event());
  };
  start(1, 4'000'000'000);
  for (std::uint64_t instance = 2; instance < 12; ++instance) start(instance, 5'000'000'000);
  auto log = Log::of_mission(folder_, VehicleId{7}, 5'000'000'000);
  ASSERT_TRUE(log.ok()) << log.error().message;
  std::vector<std::uint64_t> instances;
  for (const Session& session : log->sessions()) instances.push_back(session.instance.value);
  EXPECT_THAT(instances, testing::ElementsAre(2, 3, 4, 5, 6, 7, 8, 9, 10, 11));
  int records = 0;
  while (log->next()) ++records;
  EXPECT_EQ(records, 10);
  EXPECT_FALSE(Log::of_mission(folder_, VehicleId{7}, 6'000'000'000).ok());
  EXPECT_FALSE(Log::of_mission(folder_, VehicleId{8}, 5'000'000'000).ok());
}

TEST_F(RecordingTest, TheNewestHalfOfTheLimitIsAlwaysThere) {
  Writer::Options options;
  options.bytes_max = 200'000;
  options.compress = false;
  std::uint64_t largest = 0;
  {
    auto writer = Writer::open(folder_, options);
    ASSERT_TRUE(writer.ok());
    for (int i = 0; i < 10'000; ++i) {
      TrackPoint point;
      point.state.time = at_seconds(0.05 * i);
      point.plan_number = static_cast<std::uint32_t>(i);
      writer->write(point);
      if (i % 20 != 0) continue;
      ASSERT_TRUE(writer->flush().ok());
      std::uint64_t sum = 0;
      for (const auto& file : std::filesystem::directory_iterator{folder_}) sum += file.file_size();
      largest = std::max(largest, sum);
    }
  }
  EXPECT_LE(largest, options.bytes_max + 20'000);
  const auto read_back = read(folder_, VehicleId{7});
  ASSERT_TRUE(read_back.ok());
  ASSERT_GT(read_back->track.size(), 500U);
  for (std::size_t i = 0; i < read_back->track.size(); ++i) {
    ASSERT_EQ(read_back->track[i].plan_number, 10'000U - read_back->track.size() + i);
  }
  std::uint64_t left = 0;
  for (const auto& file : std::filesystem::directory_iterator{folder_}) left += file.file_size();
  EXPECT_GE(left, options.bytes_max / 2);
}

TEST_F(RecordingTest, AMissingFolderIsToldByName) {
  const auto read_back = read(folder_ / "nowhere", VehicleId{1});
  ASSERT_FALSE(read_back.ok());
  EXPECT_THAT(read_back.error().message, HasSubstr("nowhere"));
  EXPECT_FALSE(read_run(folder_ / "nowhere").ok());
}

TEST_F(RecordingTest, ARunIsReadInOrderOfIds) {
  for (const unsigned id : {12U, 0U, 3U, 101U}) {
    ASSERT_TRUE(
        Writer::open(folder_ / folder_name(VehicleId{static_cast<std::uint16_t>(id)})).ok());
  }
  std::filesystem::create_directories(folder_ / "vehicle-x");
  std::filesystem::create_directories(folder_ / "vehicle-3");
  const auto run = read_run(folder_);
  ASSERT_TRUE(run.ok()) << run.error().message;
  ASSERT_EQ(run->size(), 4U);
  EXPECT_EQ((*run)[0].vehicle, kGroundStation);
  EXPECT_EQ((*run)[1].vehicle, VehicleId{3});
  EXPECT_EQ((*run)[2].vehicle, VehicleId{12});
  EXPECT_EQ((*run)[3].vehicle, VehicleId{101});
}

TEST_F(RecordingTest, AFullDiskIsToldByFlush) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  std::filesystem::create_directories(folder_);
  std::filesystem::create_symlink("/dev/full", folder_ / kFileName);
  const auto writer = Writer::open(folder_);
  ASSERT_FALSE(writer.ok());
  EXPECT_THAT(writer.error().message, HasSubstr("recording.mcap: No space left"));
}

TEST_F(RecordingTest, AFolderThatCannotBeMadeIsToldByName) {
  std::filesystem::create_directories(folder_);
  std::ofstream{folder_ / "file"} << "in the way";
  const auto writer = Writer::open(folder_ / "file" / "vehicle-01");
  ASSERT_FALSE(writer.ok());
  EXPECT_THAT(writer.error().message, HasSubstr("vehicle-01"));
}

}  // namespace
}  // namespace skein::recording
