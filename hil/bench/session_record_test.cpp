// SPDX-License-Identifier: Apache-2.0
#include "session_record.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <utility>
#include <vector>

#include "skein/recording/writer.hpp"

namespace skein::hil {
namespace {

constexpr VehicleId kVehicle{7};
constexpr std::int64_t kEpoch_ns = recording::Session::kEpochOfTests;
using Kind = ProgramSpan::Kind;

Instant at(double seconds) { return Instant{} + from_seconds(seconds); }

recording::TrackPoint point(double seconds, double x_m, std::uint32_t plan = 1) {
  recording::TrackPoint p;
  p.state.time = at(seconds);
  p.state.x_m = x_m;
  p.plan_number = plan;
  return p;
}

mission::MissionEvent command(double seconds, mission::CommandKind kind) {
  return {kVehicle, at(seconds), {}, {}, mission::event::Commanded{kind}};
}

/// The folder of a run in which two programs of a vehicle have recorded, one after the other: the
/// second after a step of the clock, which is 3 s ahead since.
class SessionRecord : public testing::Test {
 protected:
  static constexpr double kAhead_s = 3.0;

  SessionRecord() {
    record(kEpoch_ns, 1.0, 0.0);
    record(kEpoch_ns - std::int64_t{3'000'000'000}, 11.0 + kAhead_s, kAhead_s);
    outcome_.epoch_unix_ns = kEpoch_ns;
    outcome_.spans = {{kVehicle, Kind::down, at(3.0), at(10.0)}};
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// Two plans and two points, by a clock that shows `from` then.
  void record(std::int64_t epoch_ns, double from, double ahead_s) {
    recording::Writer::Options options;
    options.session.node = kVehicle;
    options.session.instance = InstanceId{1 + static_cast<std::uint64_t>(from)};
    options.session.epoch_unix_ns = epoch_ns;
    auto writer = recording::Writer::open(folder_ / recording::folder_name(kVehicle), options);
    ASSERT_TRUE(writer.ok());
    for (const std::uint32_t plan : {1U, 2U}) {
      recording::PlanRecord made;
      made.number = plan;
      made.since = made.plan.start_time = at(from + plan - 1.0);
      writer->write(made);
      writer->write(point(from + plan - 1.0, 10.0 * (from - ahead_s), plan));
    }
    writer->write(command(from + 0.5, mission::CommandKind::hold));
  }

  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("skein-sessions-" + std::to_string(::getpid()));
  BenchOutcome outcome_;
};

TEST_F(SessionRecord, TwoProgramsAreOneRecordingInTrueTime) {
  const auto whole = whole_recording(folder_, kVehicle, outcome_);
  std::vector<std::pair<double, std::uint32_t>> plans;
  for (const auto& plan : whole.plans) {
    EXPECT_EQ(plan.since, plan.plan.start_time);
    plans.emplace_back(to_seconds(plan.since - Instant{}), plan.number);
  }
  const std::vector<std::pair<double, std::uint32_t>> wanted{
      {1.0, 1U}, {2.0, 2U}, {11.0, 3U}, {12.0, 4U}};
  EXPECT_EQ(plans, wanted) << "numbers go on, and the clock's step is gone";
  ASSERT_EQ(whole.track.size(), 4U);
  EXPECT_EQ(whole.track[2].state.time, at(11.0));
  EXPECT_EQ(whole.track[2].plan_number, 3U);
  ASSERT_EQ(whole.events.size(), 2U);
  EXPECT_EQ(whole.events[1].time, at(11.5));
}

TEST_F(SessionRecord, WhatOthersHeardOfItIsAddedOnce) {
  outcome_.heard = {{at(1.6), command(1.5, mission::CommandKind::hold)},     // recorded, too
                    {at(2.9), command(2.8, mission::CommandKind::resume)},   // lost as it died
                    {at(12.9), command(15.8, mission::CommandKind::land)}};  // by its new clock
  const auto whole = whole_recording(folder_, kVehicle, outcome_);
  std::vector<Instant> times;
  for (const auto& event : whole.events) times.push_back(event.time);
  EXPECT_EQ(times, (std::vector<Instant>{at(1.5), at(2.8), at(11.5), at(12.8)}));
}

TEST_F(SessionRecord, WhereNoProgramRanTheTrackIsTheAircrafts) {
  checks::RunRecord record;
  record.vehicles.resize(1);
  record.vehicles.front().id = kVehicle;
  record.recordings.push_back(whole_recording(folder_, kVehicle, outcome_));
  recording::Recording& truth = record.truths.emplace_back();
  truth.vehicle = kVehicle;
  for (double t = 0.5; t < 15.0; t += 0.5) truth.track.push_back(point(t, -1.0));
  add_faults_done(record, outcome_);

  ASSERT_EQ(record.agent_ends.size(), 1U);
  EXPECT_EQ(record.agent_ends.front().at, at(3.0));
  EXPECT_EQ(record.agent_ends.front().restarted_at, at(10.0));
  EXPECT_TRUE(checks::was_left_alone(record, kVehicle, at(5.0), at(6.0)));
  EXPECT_FALSE(checks::was_left_alone(record, kVehicle, at(11.0), at(12.0)));
  const auto& track = record.recordings.front().track;
  Instant last = at(0.0);
  for (const auto& p : track) {
    EXPECT_GT(p.state.time, last);
    EXPECT_LE(p.state.time - last, from_seconds(1.0)) << "no gap";
    last = p.state.time;
    const bool own = p.state.time == at(1.0) || p.state.time == at(2.0) ||
                     p.state.time == at(11.0) || p.state.time == at(12.0);
    EXPECT_EQ(p.state.x_m == -1.0, !own) << to_seconds(p.state.time - Instant{});
  }
  EXPECT_EQ(last, at(14.5));
}

TEST_F(SessionRecord, WhatAProgramMustBearIsNoExcuse) {
  checks::RunRecord record;
  outcome_.spans = {{kVehicle, Kind::still, at(3.0), at(3.9)},
                    {kVehicle, Kind::slow, at(4.0), at(14.0)},
                    {kVehicle, Kind::disk_full, at(4.0), {}}};
  add_faults_done(record, outcome_);
  EXPECT_TRUE(record.agent_ends.empty());
  EXPECT_TRUE(record.left_alone.empty());
  outcome_.spans = {{kVehicle, Kind::still, at(3.0), at(4.1)}};
  add_faults_done(record, outcome_);
  EXPECT_EQ(record.left_alone.size(), 1U);
  EXPECT_EQ(record.stood_still.size(), 1U);
  outcome_.spans = {{kVehicle, Kind::down, at(3.0), at(9.0)}};
  add_faults_done(record, outcome_);
  EXPECT_EQ(record.stood_still.size(), 1U) << "it was down, not stopped";
}

}  // namespace
}  // namespace skein::hil
