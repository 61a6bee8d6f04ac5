// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "skein/checks/checks.hpp"
#include "skein/checks/formation_changes.hpp"

namespace skein::checks {
namespace {

using mission::event::ChangeBegun;
using mission::event::FormationHeld;
using mission::event::PlaceReached;
using ::testing::HasSubstr;

mission::MissionEvent event(std::uint16_t vehicle, double seconds, mission::EventBody body) {
  return {{vehicle}, at_seconds(seconds), {}, {}, std::move(body)};
}

/// Two vehicles, one order that holds from 10 s to 20 s; each hovers `off_m` east of its place.
RunRecord flown(double off_m, double second_reaches_s) {
  RunRecord record;
  record.ground_events = {event(0, 1.0, ChangeBegun{7}), event(0, 10.0, FormationHeld{}),
                          event(0, 20.0, ChangeBegun{8}), event(0, 30.0, FormationHeld{})};
  for (const std::uint16_t id : {std::uint16_t{1}, std::uint16_t{2}}) {
    VehicleSpec spec;
    spec.id = {id};
    record.vehicles.push_back(spec);
    record.places.push_back({7, at_seconds(2.0), {id}, {10.0 * id, 0.0, 20.0}});
    recording::Recording recording;
    recording.vehicle = {id};
    for (int i = 0; i <= 220; ++i) {
      recording::TrackPoint point;
      point.state.time = at_seconds(0.1 * i);
      point.state.x_m = 10.0 * id + off_m;
      point.state.z_m = 20.0;
      recording.track.push_back(point);
    }
    recording.events = {event(id, id == 1 ? 9.0 : second_reaches_s, PlaceReached{7})};
    record.recordings.push_back(recording);
  }
  return record;
}

TEST(FormationChanges, AreToldByTheGroundStationsEvents) {
  RunRecord record = flown(0.0, 9.0);
  std::get<ChangeBegun>(record.ground_events[0].body).order = mission::OrderKind::land;
  std::get<ChangeBegun>(record.ground_events[2].body).correction = true;
  record.ground_events.pop_back();  // a correction does not hold anew
  record.ground_events.push_back(event(1, 21.0, mission::event::ChangeTakenUp{8}));
  record.places.push_back({8, at_seconds(21.0), {1}, {10.5, 0.0, 20.0}});
  const auto changes = formation_changes(record);
  ASSERT_EQ(changes.size(), 2U);
  EXPECT_EQ(changes[0].number, 7U);
  EXPECT_EQ(changes[0].order, "land, straight");
  EXPECT_FALSE(changes[0].correction);
  EXPECT_EQ(changes[0].begun, at_seconds(1.0));
  EXPECT_EQ(changes[0].held, at_seconds(10.0));
  EXPECT_EQ(changes[0].until, at_seconds(20.0));
  EXPECT_EQ(changes[0].places.at({2}), Vec3(20.0, 0.0, 20.0));
  EXPECT_TRUE(changes[1].correction);
  EXPECT_FALSE(changes[1].held);
  EXPECT_EQ(changes[1].until, Instant::max());
  EXPECT_EQ(changes[1].places, changes[0].places);
}

TEST(FormationChecks, HoldWhereAllIsWell) {
  Limits limits;
  limits.separation_horizontal_m = limits.separation_vertical_m = 2.0;
  const auto results = judge_formation(flown(0.1, 9.2), limits);
  for (const auto& result : results) {
    EXPECT_TRUE(result.held()) << result.name << ": " << result.violations[0].sentence;
    EXPECT_GT(result.judged, 0U) << result.name;
  }
}

TEST(FormationChecks, FindWhoIsNotInItsPlace) {
  const auto result = check_places(flown(0.4, 9.2), {});
  ASSERT_EQ(result.violations.size(), 2U);
  EXPECT_THAT(result.violations[0].sentence, HasSubstr("vehicle 1 was 0.40 m rms"));
  EXPECT_THAT(result.measured, HasSubstr("0.40"));
}

TEST(FormationChecks, FindWhoArrivesLate) {
  const auto result = check_arrivals(flown(0.0, 9.5), {});
  ASSERT_EQ(result.violations.size(), 1U);
  EXPECT_THAT(result.violations[0].sentence, HasSubstr("0.50 s after the first"));
}

TEST(FormationChecks, FindTheOrderThatNeverHeld) {
  RunRecord record = flown(0.0, 9.0);
  record.ground_events.pop_back();
  const auto result = check_orders(record, {});
  ASSERT_EQ(result.violations.size(), 1U);
  EXPECT_THAT(result.violations[0].sentence, HasSubstr("change 8"));
}

TEST(FormationChecks, FindThoseThatComeTooNear) {
  RunRecord record = flown(0.0, 9.0);
  for (auto& point : record.recordings[1].track) point.state.x_m = 11.0;
  Limits limits;
  limits.separation_horizontal_m = 2.0;
  limits.separation_vertical_m = 2.0;
  EXPECT_FALSE(check_separation(record, limits).held());
}

TEST(FormationChecks, ACorrectionOfDriftKeepsThePlaces) {
  RunRecord record = flown(0.0, 9.0);
  std::get<ChangeBegun>(record.ground_events[2].body).correction = true;
  record.places.push_back({8, at_seconds(20.0), {1}, {10.5, 0.0, 20.0}});  // with its trim
  EXPECT_TRUE(check_places(record, {}).held());
}

/// Two planes side by side on a way with a turn, each `off_m` to the left of its place.
RunRecord flown_on_track(double off_m) {
  RunRecord record;
  record.ground_events = {event(0, 1.0, ChangeBegun{7}), event(0, 5.0, FormationHeld{})};
  for (const std::uint16_t id : {std::uint16_t{1}, std::uint16_t{2}}) {
    const double left_m = id == 1 ? 0.0 : 50.0;
    recording::Recording recording;
    recording.vehicle = {id};
    TimedPath plan;
    plan.start_time = at_seconds(1.0);
    plan.speed_mps = 20.0;
    plan.path.start = {0.0, left_m, 0.0};
    plan.path.segments.push_back({0.0, 100.0});
    plan.path.segments.push_back({1.0 / (300.0 - left_m), 300.0 - left_m});
    plan.paces.push_back(1.0);
    plan.paces.push_back(1.0 - left_m / 300.0);
    plan.paces.push_back(1.0);
    recording.plans.push_back({7, at_seconds(1.0), plan});
    for (int i = 10; i <= 150; ++i) {
      const double t = 0.1 * i;
      // By hand: 5 s straight on, then a turn of 1/15 rad a second around (100, 300).
      const double turned = std::max(0.0, t - 6.0) / 15.0;
      const double radius = 300.0 - left_m - off_m;
      recording::TrackPoint point;
      point.state.time = at_seconds(t);
      point.state.x_m = t < 6.0 ? 20.0 * (t - 1.0) : 100.0 + radius * std::sin(turned);
      point.state.y_m = 300.0 - radius * std::cos(turned);
      recording.track.push_back(point);
    }
    record.recordings.push_back(recording);
  }
  return record;
}

TEST(FormationChecks, KnowWherePlacesMove) {
  const auto kept = check_moving_places(flown_on_track(0.0), {});
  EXPECT_TRUE(kept.held()) << kept.violations[0].sentence;
  EXPECT_EQ(kept.judged, 2U);
  EXPECT_THAT(kept.measured, HasSubstr("worst 0.00 m"));
  const auto off = check_moving_places(flown_on_track(0.5), {});
  ASSERT_EQ(off.violations.size(), 2U);
  EXPECT_THAT(off.violations[0].sentence, HasSubstr("vehicle 1 was 0.50 m rms"));
}

}  // namespace
}  // namespace skein::checks
