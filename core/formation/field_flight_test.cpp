// SPDX-License-Identifier: Apache-2.0
#include "skein/formation/field_flight.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace skein::formation {
namespace {

Change change_of(const std::vector<std::pair<Vec3, Vec3>>& ways) {
  Change change;
  change.number = 3;
  change.limits = {.speed_mps = 3.0};
  change.separation = {.horizontal_m = 2.0, .vertical_m = 2.0};
  for (std::size_t i = 0; i < ways.size(); ++i) {
    change.movers.push_back({{static_cast<std::uint16_t>(i + 1)}, {ways[i].first, ways[i].second}});
  }
  return change;
}

/// A team whose messages all arrive, one slot late.
struct Team {
  explicit Team(const Change& change) {
    for (std::size_t i = 0; i < change.movers.size(); ++i) {
      vehicles.emplace_back(change, i, FieldParams{}, Instant{});
    }
  }
  void step() {
    now += kSlot;
    for (auto& vehicle : vehicles) vehicle.step(now);
    for (std::size_t i = 0; i < vehicles.size(); ++i) {
      const Vec3 at = vehicles[i].reference(now).position_m;
      for (std::size_t j = 0; j < vehicles.size(); ++j) {
        if (i == j) continue;
        vehicles[j].on_progress(i, vehicles[i].progress(), at);
        const double apart = (at - vehicles[j].reference(now).position_m).norm();
        least_m = std::min(least_m, apart);
      }
    }
  }
  [[nodiscard]] bool finished() const {
    return std::all_of(vehicles.begin(), vehicles.end(), [](auto& v) { return v.finished(); });
  }
  std::vector<FieldFlight> vehicles;
  Instant now{};
  double least_m = std::numeric_limits<double>::infinity();
};

TEST(FieldFlight, TwoThatSwapSidesGiveWayAndArrive) {
  // Not quite head on: there the field has no side to push to.
  Team team{change_of({{{-20, 0, 10}, {20, 0.5, 10}}, {{20, -0.5, 10}, {-20, 0, 10}}})};
  for (int i = 0; i < 2000 && !team.finished(); ++i) team.step();
  EXPECT_TRUE(team.finished());
  EXPECT_GT(team.least_m, 1.9);  // and not 1 m, as on their ways
  EXPECT_EQ(team.vehicles[0].reference(team.now).position_m, (Vec3{20, 0.5, 10}));
  EXPECT_TRUE(team.vehicles[0].at_rest());
}

TEST(FieldFlight, KeepsToTheLimitsAndItsTrackEndsAtRest) {
  Team team{change_of({{{0, 0, 10}, {30, 0, 10}}, {{0, 8, 10}, {40, 8, 14}}})};
  Vec3 before = Vec3::Zero();
  for (int i = 0; i < 200; ++i) {
    team.step();
    const auto moment = team.vehicles[1].reference(team.now);
    EXPECT_LE(moment.velocity_mps.norm(), 3.0 + 1e-9);
    EXPECT_LE((moment.velocity_mps - before).norm(),
              MotionLimits{}.acceleration_mps2 * to_seconds(kSlot) + 1e-9);
    before = moment.velocity_mps;
    const MotionTrack track = team.vehicles[1].track();
    ASSERT_GT(track.count, 0);
    EXPECT_EQ(track.start, team.now);
    const auto& last = track.points.at(track.count - 1U);
    for (const double v : last.velocity_mps) EXPECT_EQ(v, 0.0);
    const auto begin = track.at(team.now);
    EXPECT_LT((begin.position_m - moment.position_m).norm(), 1e-9);
  }
}

TEST(FieldFlight, HoldsAndGoesOn) {
  Team team{change_of({{{0, 0, 10}, {30, 0, 10}}})};
  for (int i = 0; i < 60; ++i) team.step();
  team.vehicles[0].hold(true);
  for (int i = 0; i < 60; ++i) team.step();
  EXPECT_TRUE(team.vehicles[0].at_rest());
  EXPECT_FALSE(team.vehicles[0].finished());
  const Vec3 held = team.vehicles[0].reference(team.now).position_m;
  team.step();
  EXPECT_EQ(team.vehicles[0].reference(team.now).position_m, held);
  team.vehicles[0].hold(false);
  for (int i = 0; i < 1000 && !team.finished(); ++i) team.step();
  EXPECT_TRUE(team.finished());
}

TEST(FieldFlight, WhoseProgramStandsStillGoesOnFromWhereItsTrackHasLed) {
  Team team{change_of({{{0, 0, 10}, {30, 0, 10}}})};
  for (int i = 0; i < 60; ++i) team.step();
  FieldFlight& flight = team.vehicles[0];
  const MotionTrack told = flight.track();
  for (const double asleep_s : {0.1, 0.4, 3.0}) {
    const Instant woken = team.now + from_seconds(asleep_s);
    FieldFlight asleep = flight;
    EXPECT_EQ(asleep.reference(woken).position_m, told.at(woken).position_m);
    asleep.step(woken);
    EXPECT_LT((asleep.reference(woken).position_m - told.at(woken).position_m).norm(), 1e-9);
  }
}

TEST(FieldFlight, ComesToRestInItsPlaceWithinItsLimits) {
  for (const double acceleration_mps2 : {0.5, 2.0, 6.0}) {
    Change change = change_of({{{0, 0, 10}, {7.3, 1.1, 12}}});
    change.limits.speed_mps = 1.5;
    change.limits.acceleration_mps2 = acceleration_mps2;
    Team team{change};
    const FieldFlight& flight = team.vehicles[0];
    const double change_mps = acceleration_mps2 * to_seconds(kSlot) + 1e-9;
    auto before = flight.reference(team.now);
    for (int i = 0; i < 2000 && !team.finished(); ++i) {
      team.step();
      const auto moment = flight.reference(team.now);
      EXPECT_LE((moment.velocity_mps - before.velocity_mps).norm(), change_mps);
      // It is where its velocity has brought it: no jump into the place.
      const Vec3 way = 0.5 * to_seconds(kSlot) * (moment.velocity_mps + before.velocity_mps);
      EXPECT_LT((moment.position_m - before.position_m - way).norm(), 2e-9);
      before = moment;
    }
    EXPECT_TRUE(team.finished()) << acceleration_mps2;
    EXPECT_EQ(before.position_m, (Vec3{7.3, 1.1, 12}));
  }
}

TEST(FieldFlight, SlotsBeforeMissionTimeZeroAreAsLongAsOthers) {
  const Change change = change_of({{{0, 0, 10}, {30, 0, 10}}});
  for (const double seconds : {-0.12, -0.05, -0.01, 0.0, 0.01}) {
    const Instant now = at_seconds(seconds);
    FieldFlight flight{change, 0, {}, now};
    EXPECT_LE(flight.progress().at, now) << seconds;
    EXPECT_GT(flight.progress().at, now - kSlot) << seconds;
    flight.step(now + kSlot);
    EXPECT_LE(flight.progress().at, now + kSlot) << seconds;
    EXPECT_GT(flight.progress().at, now) << seconds;
  }
}

TEST(FieldFlight, WaitsForItsStartAndIgnoresOtherChanges) {
  Change change = change_of({{{0, 0, 10}, {30, 0, 10}}, {{0, 3, 10}, {0, 3, 10}}});
  change.start = at_seconds(5.0);
  FieldFlight flight{change, 0, {}, Instant{}};
  flight.step(at_seconds(4.9));
  EXPECT_EQ(flight.reference(at_seconds(4.9)).position_m, (Vec3{0, 0, 10}));
  FieldFlight told = flight;
  told.on_progress(1, {.change = 2, .at = at_seconds(4.9)}, {0, 1, 10});  // of another change
  told.on_progress(9, {.change = 3, .at = at_seconds(4.9)}, {0, 1, 10});  // of nobody
  told.on_progress(0, {.change = 3, .at = at_seconds(4.9)}, {0, 1, 10});  // of itself
  for (double s = 4.9; s < 8.01; s += to_seconds(kSlot)) {
    flight.step(at_seconds(s));
    told.step(at_seconds(s));
  }
  EXPECT_EQ(told.reference(at_seconds(8.0)).position_m,
            flight.reference(at_seconds(8.0)).position_m);
  EXPECT_GT(flight.reference(at_seconds(8.0)).position_m.x(), 1.0);
}

}  // namespace
}  // namespace skein::formation
