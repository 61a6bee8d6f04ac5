// SPDX-License-Identifier: Apache-2.0
#include "skein/recording/log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include "records.hpp"
#include "skein/base/random.hpp"
#include "skein/mcap/reader.hpp"
#include "skein/mcap/writer.hpp"
#include "skein/random_messages/random_messages.hpp"
#include "skein/recording/merge.hpp"
#include "skein/recording/writer.hpp"

namespace skein::recording {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class LogTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("skein-log-" + std::to_string(::getpid()) + "-" +
               ::testing::UnitTest::GetInstance()->current_test_info()->name());
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] Writer open(VehicleId node, const std::string& folder = "") const {
    Writer::Options options;
    options.session.node = node;
    options.session.instance = InstanceId{100U + node.value};
    options.session.program = "a program";
    options.session.version = "0.0";
    options.session.configuration = "version: 1\n";
    auto writer =
        Writer::open(folder.empty() ? folder_ / folder_name(node) : folder_ / folder, options);
    EXPECT_TRUE(writer.ok());
    return std::move(writer).value();
  }
  [[nodiscard]] Log read(const std::filesystem::path& path) const {
    auto log = Log::open(path);
    EXPECT_TRUE(log.ok()) << log.error().message;
    return std::move(log).value();
  }

  std::filesystem::path folder_;
};

mission::Command command(std::uint32_t number) {
  return {VehicleId{1}, number, mission::CommandKind::hold};
}

std::vector<std::uint8_t> bytes_of(const std::filesystem::path& path) {
  std::ifstream file{path, std::ios::binary};
  const std::string text{std::istreambuf_iterator<char>{file}, {}};
  return {text.begin(), text.end()};
}

Bytes bytes_of(const Entry& entry) {
  const auto* message = std::get_if<mission::Message>(&entry.content);
  return message == nullptr ? Bytes{} : encode(*message)->bytes;
}

/// One of everything that is no message; `random` differs from record to record.
std::vector<AgentRecord> agent_records(Instant now) {
  mission::FlightPlan plan;
  plan.number = 3;
  plan.timed.start_time = Instant{Duration{-5}};
  plan.timed.speed_mps = 50.0 / 3.0;
  plan.timed.path.start = {1.0 / 3.0, -2e-9, 3.1};
  plan.timed.path.segments.push_back({1.0 / 170.0, 1234.5678901234});
  MotionTrack track;
  track.number = 4;
  track.count = 2;
  track.points[1].position_m = {1.0, 2.0, 1.0 / 3.0};
  VehicleState state{now, 1.0, -2.0, 3.0, 0.1, 0.2, 50.0, 49.0, 1e5, -0.25};
  return {AgentStart{InstanceId{0xFFFFFFFFFFFFFFFFU}, "skein 1", now},
          StateGiven{state, now},
          PlanningGiven{{{VehicleId{1}, InstanceId{2}, 3}, 4}, 17, Duration{123456}, now},
          TimeoutGiven{now},
          NoticeGiven{
              {now, true, {.news = AutopilotNews::text, .detail = "says \"so\",\nand this"}}, now},
          PlanMade{std::make_shared<const mission::FlightPlan>(plan), now},
          std::get<TrackMade>(made(track, now)),
          ConditionGiven{{"LOITER, piloted", 3, 0xFFFFFFFFFFFFFFFFU}, now},
          NamesakeHeard{now}};
}

TEST_F(LogTest, EveryMessageComesBackWithItsSenderAndTime) {
  Random random{1};
  std::vector<Bytes> written;
  {
    Writer writer = open(VehicleId{7});
    for (std::size_t i = 0; i < 3 * codec::kMessageKinds; ++i) {
      const auto message = codec::random_message(i % codec::kMessageKinds, random);
      const auto sender = VehicleId{static_cast<std::uint16_t>(i % 5)};
      writer.write(message, sender, at_seconds(-1.0 + 0.1 * static_cast<double>(i)));
      written.push_back(encode(message)->bytes);
    }
  }
  Log log = read(folder_ / "vehicle-07");
  EXPECT_EQ(log.begin(), at_seconds(-1.0));
  EXPECT_EQ(log.end(), at_seconds(-1.0 + 0.1 * static_cast<double>(written.size() - 1)));
  ASSERT_EQ(log.sessions().size(), 1U);
  EXPECT_EQ(log.sessions()[0].node, VehicleId{7});
  EXPECT_EQ(log.sessions()[0].configuration, "version: 1\n");
  for (std::size_t i = 0; i < written.size(); ++i) {
    const auto entry = log.next();
    ASSERT_TRUE(entry) << i;
    EXPECT_EQ(bytes_of(*entry), written[i]) << entry->topic;
    EXPECT_EQ(entry->sender.value, i % 5);
    EXPECT_EQ(entry->node, VehicleId{7});
    EXPECT_EQ(entry->time, at_seconds(-1.0 + 0.1 * static_cast<double>(i)));
    const std::string prefix = i % 5 == 0 ? "/ground/" : "/vehicle_0" + std::to_string(i % 5) + "/";
    EXPECT_TRUE(entry->topic.starts_with(prefix)) << entry->topic;
  }
  EXPECT_FALSE(log.next());
  EXPECT_EQ(log.damaged(), 0U);
  EXPECT_TRUE(log.is_complete());
}

TEST_F(LogTest, WhatAnAgentWasGivenComesBackExactly) {
  const Instant now{Duration{1'234'567'891}};
  {
    Writer writer = open(VehicleId{7});
    for (const AgentRecord& record : agent_records(now)) writer.write(record);
    writer.write(Gap{12});
  }
  Log log = read(folder_ / "vehicle-07" / kFileName);
  std::vector<Content> contents;
  log.for_each_written([&](const Entry& entry) {
    EXPECT_EQ(entry.time, now);
    contents.push_back(entry.content);
    return true;
  });
  const auto records = agent_records(now);
  ASSERT_EQ(contents.size(), records.size() + 1);
  EXPECT_EQ(std::get<AgentStart>(contents[0]).instance.value, 0xFFFFFFFFFFFFFFFFU);
  EXPECT_EQ(std::get<AgentStart>(contents[0]).program, "skein 1");
  const auto& state = std::get<StateGiven>(contents[1]).state;
  EXPECT_EQ(state.time, now);
  EXPECT_EQ(state.climb_mps, -0.25);
  EXPECT_EQ(state.distance_flown_m, 1e5);
  const auto& planning = std::get<PlanningGiven>(contents[2]);
  EXPECT_EQ(planning.expired_after, 17U);
  EXPECT_EQ(planning.took, Duration{123456});
  EXPECT_EQ(planning.round.number, 4U);
  EXPECT_EQ(std::get<TimeoutGiven>(contents[3]).now, now);
  const auto& notice = std::get<NoticeGiven>(contents[4]).notice;
  EXPECT_EQ(notice.what.news, AutopilotNews::text);
  EXPECT_EQ(notice.what.detail, "says \"so\", and this");  // no control characters in texts
  EXPECT_TRUE(notice.warning);
  EXPECT_EQ(notice.time, now);
  const auto& plan = *std::get<PlanMade>(contents[5]).plan;
  EXPECT_EQ(plan.timed.speed_mps, 50.0 / 3.0);
  ASSERT_EQ(plan.timed.path.segments.size(), 1U);
  EXPECT_EQ(plan.timed.path.segments[0].length_m, 1234.5678901234);
  EXPECT_EQ(std::get<TrackMade>(contents[6]).digest, std::get<TrackMade>(records[6]).digest);
  EXPECT_EQ(std::get<ConditionGiven>(contents[7]).condition,
            (mission::Condition{"LOITER, piloted", 3, 0xFFFFFFFFFFFFFFFFU}));
  EXPECT_EQ(std::get<NamesakeHeard>(contents[8]).now, now);
  EXPECT_EQ(std::get<Gap>(contents[9]).lost, 12U);
}

TEST_F(LogTest, SeekGoesToATimeAndBack) {
  {
    Writer writer = open(kGroundStation);
    for (std::uint32_t i = 0; i < 100; ++i) {
      writer.write(command(i), kGroundStation, at_seconds(0.25 * i));
    }
  }
  Log log = read(folder_ / "ground");
  for (const std::uint32_t i : {50U, 3U, 99U, 0U, 50U}) {
    log.seek(at_seconds(0.25 * i - 0.1));
    const auto entry = log.next();
    ASSERT_TRUE(entry);
    EXPECT_EQ(std::get<mission::Command>(std::get<mission::Message>(entry->content)).number, i);
  }
  log.seek(at_seconds(100.0));
  EXPECT_FALSE(log.next());
}

TEST_F(LogTest, ARunHasEachRecordOnce) {
  {
    Writer ground = open(kGroundStation);
    Writer first = open(VehicleId{1});
    Writer bench = open(VehicleId{255}, "bench");
    for (std::uint32_t i = 0; i < 50; ++i) {
      const Instant sent = at_seconds(0.1 * i);
      ground.write(command(i), kGroundStation, sent);
      first.write(command(i), kGroundStation, sent + std::chrono::milliseconds{30});
      mission::MissionEvent event;
      event.vehicle = VehicleId{1};
      event.time = sent;
      first.write(event);
      ground.write(event);  // the ground station notes what it heard
      bench.write(mission::HazardReport{}, VehicleId{255}, sent);
    }
  }
  for (const bool merged : {false, true}) {
    if (merged) {
      const auto records = merge_run(folder_);
      ASSERT_TRUE(records.ok()) << records.error().message;
      EXPECT_EQ(*records, 150U);
    }
    Log log = read(folder_);
    EXPECT_EQ(log.sessions().size(), 3U);
    Instant last = Instant::min();
    std::size_t count = 0;
    while (const auto entry = log.next()) {
      EXPECT_GE(entry->time, last);
      EXPECT_EQ(entry->node, entry->sender);
      last = entry->time;
      ++count;
    }
    EXPECT_EQ(count, 150U);
    const auto topics = log.topics();
    std::vector<std::string> names;
    for (const auto& topic : topics) {
      names.push_back(topic.topic);
      EXPECT_EQ(topic.records, 50U);
    }
    EXPECT_THAT(names, ElementsAre("/ground/command", "/vehicle_01/event/site_detected",
                                   "/vehicle_255/hazard_report"));
  }
}

/// A process that is killed: the file ends at any byte that it had written by then.
TEST_F(LogTest, AFileThatIsCutOffLosesALastSecondAtMost) {
  struct Moment {
    Instant time;
    std::uint64_t size = 0;
  };
  std::vector<Moment> moments;
  const auto file = folder_ / "vehicle-07" / kFileName;
  Random random{3};
  {
    Writer writer = open(VehicleId{7});
    for (int i = 0; i < 1200; ++i) {  // 60 s
      TrackPoint point;
      point.state.time = at_seconds(0.05 * i);
      point.state.x_m = random.uniform(-1e4, 1e4);
      writer.write(point);
      if (i % 20 == 0)
        writer.write(codec::random_message(7, random), VehicleId{3}, point.state.time);
      const std::uint64_t size = std::filesystem::file_size(file);
      if (moments.empty() || size != moments.back().size)
        moments.push_back({point.state.time, size});
    }
  }
  ASSERT_GT(moments.size(), 50U);
  const auto whole = bytes_of(file);
  // A file without its first record says nothing of whose it is.
  const std::uint64_t least = moments.front().size;
  for (int i = 0; i < 1000; ++i) {
    const std::uint64_t cut = least + random.index(static_cast<std::size_t>(whole.size() - least));
    auto log = Log::of_bytes(std::span{whole}.first(static_cast<std::size_t>(cut)), "cut");
    ASSERT_TRUE(log.ok()) << log.error().message;
    Instant newest = at_seconds(-0.05);  // before the first
    std::size_t points = 0;
    log->for_each_written([&](const Entry& entry) {
      newest = entry.time;
      points += entry.topic.ends_with("/track") ? 1 : 0;
      return true;
    });
    EXPECT_LE(log->damaged(), 1U);
    // When it was killed: before the write with which the file grew beyond the cut.
    Instant killed = at_seconds(59.95);
    for (const Moment& moment : moments) {
      if (moment.size > cut) {
        killed = moment.time;
        break;
      }
    }
    EXPECT_LE(killed - newest, std::chrono::milliseconds{1050}) << "cut at " << cut;
    EXPECT_EQ(points,
              static_cast<std::size_t>(newest < Instant{} ? 0 : to_seconds(newest) / 0.05 + 1.5));
  }
}

TEST_F(LogTest, AnyBytesAreSafe) {
  {
    Writer writer = open(VehicleId{7});
    Random random{1};
    for (std::size_t i = 0; i < codec::kMessageKinds; ++i) {
      writer.write(codec::random_message(i, random), VehicleId{1},
                   at_seconds(0.2 * static_cast<double>(i)));
    }
    for (const AgentRecord& record : agent_records(at_seconds(3.0))) writer.write(record);
  }
  const auto good = bytes_of(folder_ / "vehicle-07" / kFileName);
  Random random{5};
  for (int i = 0; i < 300; ++i) {
    auto bad = good;
    for (int k = 0; k < 5; ++k)
      bad[random.index(bad.size())] = static_cast<std::uint8_t>(random.next());
    auto log = Log::of_bytes(bad, "bad");
    if (!log) continue;
    while (log->next()) {
    }
  }
}

TEST_F(LogTest, WhatIsNoRecordingIsRefusedWithTheReason) {
  std::filesystem::create_directories(folder_);
  EXPECT_THAT(Log::open(folder_).error().message, HasSubstr("has no recordings"));
  EXPECT_THAT(Log::open(folder_ / "none.mcap").error().message, HasSubstr("none.mcap"));
  EXPECT_THAT(merge_run(folder_).error().message, HasSubstr("has no recordings"));
  {
    auto other = mcap::Writer::open(folder_ / "other.mcap", {});
    ASSERT_TRUE(other.ok());
  }
  EXPECT_THAT(Log::open(folder_ / "other.mcap").error().message,
              HasSubstr("is no recording of Skein"));
  {
    auto older =
        mcap::Writer::open(folder_ / "older.mcap", {.profile = "ros2", .library = "skein 0.0"});
    ASSERT_TRUE(older.ok());
    older->add(mcap::Metadata{"skein", {{"node", "1"}, {"instance", "2"}, {"epoch_unix_ns", "3"}}});
    const auto schema = older->add(mcap::Schema{"skein/msg/TrackPoint", "ros2msg", "float64 x\n"});
    (void)older->add(mcap::Channel{schema, "/vehicle_01/track", "cdr", {{"sender", "1"}}});
  }
  EXPECT_THAT(Log::open(folder_ / "older.mcap").error().message,
              HasSubstr("/vehicle_01/track is of version none, ours of version "));
  EXPECT_THAT(Log::open(folder_ / "older.mcap").error().message,
              HasSubstr("read it with the Skein that wrote it (skein 0.0)"));
}

TEST_F(LogTest, ALaterReleasesRecordsAreReadAndKeepTheirSchema) {
  const RecordKind* kind = kind_named("agent/timeout");
  ASSERT_NE(kind, nullptr);
  const std::string later = std::string{kind->schema->text} + "uint32 later\n";
  Bytes bytes = encode(TimeoutGiven{})->bytes;
  const std::size_t end = bytes.size();
  bytes.resize(end + 4, 5);
  bytes[3] = 0;  // nothing only fills up
  const auto folder = folder_ / folder_name(VehicleId{1});
  std::filesystem::create_directories(folder);
  {
    auto file = mcap::Writer::open(folder / kFileName, {.profile = "ros2", .library = "skein 9.0"});
    ASSERT_TRUE(file.ok());
    file->add(mcap::Metadata{"skein", {{"node", "1"}, {"instance", "2"}, {"epoch_unix_ns", "3"}}});
    const auto schema = file->add(mcap::Schema{"skein/msg/TimeoutGiven", "ros2msg", later});
    mcap::Message message;
    message.channel =
        file->add(mcap::Channel{schema, "/vehicle_01/agent/timeout", "cdr", {{"sender", "1"}}});
    message.log_time_ns = 10;
    message.data = bytes;
    file->write(message);
  }
  const auto records = merge_run(folder_);
  ASSERT_TRUE(records.ok()) << records.error().message;
  EXPECT_EQ(*records, 1U);
  Log log = read(folder_);
  const auto entry = log.next();
  ASSERT_TRUE(entry);
  EXPECT_EQ(std::get<TimeoutGiven>(entry->content).now, Instant{Duration{7}});
  const auto merged = mcap::Reader::open(folder_ / kRunFileName);
  ASSERT_TRUE(merged.ok());
  ASSERT_EQ(merged->schemas().size(), 1U);
  EXPECT_EQ(merged->schemas().begin()->second.text, later);
}

}  // namespace
}  // namespace skein::recording
