// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/playback.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "skein/console/alarms.hpp"
#include "skein/console/sections.hpp"
#include "skein/groundstation/replay_process.hpp"
#include "skein/recording/writer.hpp"

namespace skein::groundstation {
namespace {

/// A recording of two minutes of three vehicles, made by the ground station; and the pictures that
/// there were.
class PlaybackTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("skein-playback-" + std::to_string(::getpid()) + "-" +
               ::testing::UnitTest::GetInstance()->current_test_info()->name());
    configuration::GroundConfig config;
    config.time.epoch_unix_ns = 1'700'000'000'000'000'000;
    config.origin = {47.0, 8.0, 500.0};
    config.vehicles = {{1}, {2}, {3}};
    recording::Writer::Options options;
    options.session.program = "skein-ground";
    options.session.version = "1.0";
    options.session.configuration = configuration::to_yaml(config);
    auto writer = recording::Writer::open(folder_, options);
    ASSERT_TRUE(writer.ok());
    console::Picture picture{{.expected = config.vehicles}};
    mission::Fleet fleet{{.expected = config.vehicles}};
    for (int i = 0; i <= 1200; ++i) {
      const Instant now = at_seconds(0.1 * i);
      for (const VehicleId vehicle : config.vehicles) {
        if (vehicle == VehicleId{3} && i > 400 && i <= 700) continue;  // silent
        mission::Telemetry t;
        t.vehicle = vehicle;
        t.instance = {vehicle.value};
        t.state.time = now;
        t.state.x_m = i;
        t.activity = i < 500 ? mission::Activity::searching : mission::Activity::leading;
        writer->write(mission::Message{t}, vehicle, now);
        fleet.on_message(t, now);
        picture.on_message(t, vehicle, now);
      }
      if (i % 100 == 50) {
        mission::MissionEvent event;
        event.vehicle = {2};
        event.time = now;
        event.body = mission::event::SurveyDone{};
        event.task = {{static_cast<std::uint16_t>(i / 100 + 1)}, TaskKind::survey, 0};
        writer->write(event);
        picture.on_event(event);
      }
      if (i % 300 == 0) was_.push_back({now, shown(picture, fleet, now)});
    }
    ASSERT_TRUE(writer->flush().ok());
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  static std::string shown(const console::Picture& picture, mission::Fleet fleet, Instant now) {
    fleet.on_timeout(now);
    std::string all = console::series_of(picture);
    const auto origin = MissionOrigin::make({47.0, 8.0, 500.0});
    for (const std::string& section : console::sections_of(picture, fleet, *origin, "1.0", now)) {
      all += section;
    }
    return all;
  }

  std::filesystem::path folder_;
  struct Moment {
    Instant time{};
    std::string shown;
  };
  std::vector<Moment> was_;
};

TEST_F(PlaybackTest, ShowsEveryMomentAsItWasWhateverTheOrder) {
  auto playback = Playback::open(folder_);
  ASSERT_TRUE(playback.ok()) << playback.error().message;
  EXPECT_EQ(playback->begin(), at_seconds(0.0));
  EXPECT_NEAR(to_seconds(playback->end()), 120.0, 1e-6);
  EXPECT_EQ(playback->version(), "1.0");
  ASSERT_EQ(was_.size(), 5U);
  for (const std::size_t index : {0U, 4U, 2U, 3U, 1U, 0U, 4U}) {
    const auto& [time, was] = was_[index];
    playback->go_to(time);
    EXPECT_EQ(playback->now(), time);
    EXPECT_EQ(shown(playback->picture(), playback->fleet(), time), was) << index;
  }
  // Step by step, as it is played.
  playback->go_to(playback->begin());
  for (double t = 0.0; t < 60.0; t += 0.37) playback->go_to(at_seconds(t));
  playback->go_to(was_[2].time);
  EXPECT_EQ(shown(playback->picture(), playback->fleet(), was_[2].time), was_[2].shown);
}

TEST_F(PlaybackTest, ItsAlarmsAreThoseOfThatMomentHoweverOneGetsThere) {
  auto playback = Playback::open(folder_);
  ASSERT_TRUE(playback.ok()) << playback.error().message;
  std::vector<std::string> played;
  for (double seconds = 0.37; seconds < 118.0; seconds += 0.37) {
    playback->go_to(at_seconds(seconds));
    played.push_back(console::alarms_json(playback->alarms()));
  }
  for (const std::size_t at : {200U, 20U, 122U, 123U, 121U, 310U, 130U}) {
    playback->go_to(at_seconds(0.37 * (static_cast<double>(at) + 1.0)));
    EXPECT_EQ(console::alarms_json(playback->alarms()), played.at(at)) << at;
  }
  playback->go_to(at_seconds(50.0));
  const auto silent = playback->alarms().list();
  ASSERT_EQ(silent.size(), 1U);
  EXPECT_EQ(text_of(silent[0]->key), "vehicle_silent-3");
  EXPECT_EQ(silent[0]->since, at_seconds(45.0));
  playback->go_to(at_seconds(100.0));
  ASSERT_EQ(playback->alarms().list().size(), 1U);
  EXPECT_TRUE(playback->alarms().list()[0]->over);
}

TEST_F(PlaybackTest, HasEveryEventOnceByTime) {
  auto playback = Playback::open(folder_);
  ASSERT_TRUE(playback.ok());
  ASSERT_EQ(playback->events().size(), 12U);
  EXPECT_EQ(playback->events_so_far(), 0U);
  playback->go_to(at_seconds(5.0));
  EXPECT_EQ(playback->events_so_far(), 1U);
  playback->go_to(at_seconds(500.0));
  EXPECT_EQ(playback->now(), playback->end());
  EXPECT_EQ(playback->events_so_far(), 12U);
  playback->go_to(at_seconds(-500.0));
  EXPECT_EQ(playback->now(), playback->begin());
  for (std::size_t i = 0; i < 12; ++i) {
    EXPECT_EQ(nlohmann::json::parse(playback->events()[i].json)["seq"], i);
  }
}

TEST_F(PlaybackTest, SaysWhyItCannot) {
  EXPECT_FALSE(Playback::open(folder_ / "nowhere").ok());
  const auto other = folder_ / "other";
  ASSERT_TRUE(recording::Writer::open(other).ok());
  const auto no_origin = Playback::open(other);
  ASSERT_FALSE(no_origin.ok());
  EXPECT_NE(no_origin.error().message.find("origin"), std::string::npos);
}

TEST(ReplayOrder, IsOneOfFour) {
  using Kind = ReplayOrder::Kind;
  EXPECT_EQ(parse_replay_order(" play\n")->kind, Kind::play);
  EXPECT_EQ(parse_replay_order("pause")->kind, Kind::pause);
  EXPECT_EQ(parse_replay_order("speed 0.5")->value, 0.5);
  EXPECT_EQ(parse_replay_order("seek -3.5")->value, -3.5);
  for (const char* wrong :
       {"", "speed", "speed 0", "speed 101", "seek", "seek x", "seek nan", "play 3", "hold all"}) {
    EXPECT_FALSE(parse_replay_order(wrong).ok()) << wrong;
  }
}

}  // namespace
}  // namespace skein::groundstation
