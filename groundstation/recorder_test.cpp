// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/recorder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

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
