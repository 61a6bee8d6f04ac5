// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/recorder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "skein/groundstation/recall.hpp"
#include "skein/recording/reader.hpp"

namespace skein::groundstation {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class RecorderTest : public testing::Test {
 protected:
  RecorderTest() {
    fs::remove_all(folder_);
    options_.session.node = kGroundStation;
  }
  ~RecorderTest() override { fs::remove_all(folder_); }

  static mission::MissionEvent event_at(double s) {
    mission::MissionEvent event;
    event.vehicle = kGroundStation;
    event.time = at_seconds(s);
    return event;
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::size_t events_in(const std::string& name) const {
    const auto recording = recording::read(folder_ / name, kGroundStation);
    EXPECT_TRUE(recording) << recording.error().message;
    return recording ? recording->events.size() : 0;
  }

  const fs::path folder_ =
      fs::temp_directory_path() / ("recorder_test-" + std::to_string(getpid()));
  recording::Writer::Options options_;
};

TEST_F(RecorderTest, AnOperatorsRecordingIsBesideThatOfTheConfiguration) {
  {
    auto recorder = Recorder::open(path("always"), options_);
    ASSERT_TRUE(recorder) << recorder.error().message;
    recorder->write(event_at(1.0));
    ASSERT_TRUE(recorder->begin(path("evening")));
    recorder->write(event_at(2.0));
    ASSERT_TRUE(recorder->begin(path("night")));
    recorder->write(event_at(3.0));
    ASSERT_TRUE(recorder->end());
    recorder->write(event_at(4.0));
    recorder->flush();
  }
  EXPECT_EQ(events_in("always"), 4U);
  EXPECT_EQ(events_in("evening"), 1U);
  EXPECT_EQ(events_in("night"), 1U);
}

/// A ground station that starts anew knows what it granted, of the same mission only.
TEST_F(RecorderTest, WhatWasRecordedIsRecalled) {
  const coalition::Round round{{VehicleId{2}, InstanceId{7}, 1}, 1};
  mission::AuthorisationRequest request;
  request.round = round;
  request.site = SiteId{3};
  request.deliveries.push_back(
      {{{SiteId{3}, TaskKind::deliver, 0}, VehicleId{2}, at_seconds(40)}, 0.5});
  request.decide_by = at_seconds(30);
  {
    auto recorder = Recorder::open(path("ground"), options_);
    ASSERT_TRUE(recorder);
    recorder->write(mission::Message{request}, VehicleId{2}, at_seconds(10));
    recorder->write(
        mission::Message{mission::Authorisation{round, SiteId{3}, true, "ada", at_seconds(12)}},
        kGroundStation, at_seconds(12));
    recorder->flush();
  }
  const auto recalled = [&](std::int64_t epoch) {
    mission::GroundNode node{{}, at_seconds(20)};
    recall(path("ground"), epoch, node);
    const auto& known = node.agent().authorisations();
    return known.size() == 1 && known[0].decision && known[0].decision->decided_by == "ada";
  };
  EXPECT_TRUE(recalled(options_.session.epoch_unix_ns));
  EXPECT_FALSE(recalled(options_.session.epoch_unix_ns + 1));
  mission::GroundNode node{{}, at_seconds(20)};
  EXPECT_EQ(recall(path("none"), options_.session.epoch_unix_ns, node), 0U);
}

TEST_F(RecorderTest, AFolderThatIsRecordedIntoIsNotTakenTwice) {
  auto recorder = Recorder::open(path("always"), options_);
  ASSERT_TRUE(recorder);
  const auto twice = recorder->begin(path("always/../always"));
  ASSERT_FALSE(twice);
  EXPECT_THAT(twice.error().message, HasSubstr("already"));
  const auto nothing = recorder->end();
  ASSERT_FALSE(nothing);
  EXPECT_THAT(nothing.error().message, HasSubstr("only what the configuration wants"));
}

TEST_F(RecorderTest, WhatCannotBeOpenedLeavesTheOthers) {
  auto recorder = Recorder::open("", options_);
  ASSERT_TRUE(recorder);
  EXPECT_FALSE(recorder->end());
  ASSERT_TRUE(recorder->begin(path("evening")));
  EXPECT_FALSE(recorder->begin("/proc/none"));
  recorder->write(event_at(1.0));
  ASSERT_TRUE(recorder->end());
  EXPECT_EQ(events_in("evening"), 1U);
}

}  // namespace
}  // namespace skein::groundstation
