// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/separation_watch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "skein/base/angles.hpp"
#include "skein/base/random.hpp"
#include "skein/mission/guidance.hpp"

namespace skein::mission {
namespace {

constexpr Duration kTick = std::chrono::milliseconds{40};
constexpr Duration kTelemetry = std::chrono::milliseconds{400};
constexpr Duration kDelay = std::chrono::milliseconds{80};
constexpr double kLayer_m = 120.0;

/// Flies straight on; its height follows what it asks for at the rate of plans, and with the lag of
/// a plane.
class Flyer {
 public:
  Flyer(std::uint16_t id, const Vec2& from, double heading_rad, double speed_mps,
        double layer_m = kLayer_m, const coalition::ProtocolParams& params = {},
        InstanceId program = {})
      : watch{params, VehicleId{id}, program, layer_m},
        id_{id},
        program_{program},
        layer_m_{layer_m} {
    state.x_m = from.x();
    state.y_m = from.y();
    state.z_m = layer_m;
    state.heading_rad = state.course_rad = heading_rad;
    state.groundspeed_mps = state.airspeed_mps = speed_mps;
  }

  void fly(Instant now) {
    constexpr double kSeconds = to_seconds(kTick);
    if (plan_.height_to_m != watch.offset_m()) {
      plan_.height_from_m = height_offset_m(plan_, now);
      plan_.height_to_m = watch.offset_m();
      plan_.height_since = now;
    }
    state.time = now;
    state.x_m += kSeconds * state.velocity_mps().x();
    state.y_m += kSeconds * state.velocity_mps().y();
    const double wanted_m = layer_m_ + (can_change_height ? height_offset_m(plan_, now) : 0.0);
    state.z_m += sinks_mps > 0.0 ? -sinks_mps * kSeconds : (wanted_m - state.z_m) * kSeconds / 3.0;
  }
  void decide(Instant now) {
    const bool piloted = detail == ActivityDetail::piloted;
    if (watch.watches())
      watch.step({.state = state, .activity = activity, .piloted = piloted}, now);
    while (const auto news = watch.poll_event()) {
      if (const auto* warning = std::get_if<event::SeparationWarning>(&*news)) {
        warnings.push_back(*warning);
        warned_at.push_back(now);
      } else {
        ++restored;
      }
    }
    gave_way = gave_way || watch.offset_m() != 0.0;
  }
  [[nodiscard]] Telemetry telemetry() const {
    Telemetry told;
    told.vehicle = id();
    told.instance = program_;
    told.state = state;
    told.activity = activity;
    told.detail = detail;
    return told;
  }
  [[nodiscard]] VehicleId id() const { return VehicleId{id_}; }
  /// From a landing, at that height.
  void climb_back(double height_m) {
    state.z_m = height_m;
    plan_.height_from_m = plan_.height_to_m = height_m - layer_m_;
    EXPECT_TRUE(watch.climb_back(state, 0.0, {}));
  }

  SeparationWatch watch;
  VehicleState state;
  Activity activity = Activity::searching;
  ActivityDetail detail = ActivityDetail::none;
  bool can_change_height = true;
  double sinks_mps = 0.0;  ///< its autopilot leads it down
  bool speaks = true;
  bool hears = true;
  std::vector<event::SeparationWarning> warnings;
  std::vector<Instant> warned_at;
  int restored = 0;
  bool gave_way = false;

 private:
  std::uint16_t id_;
  InstanceId program_;
  double layer_m_;
  FlightPlan plan_;
};

struct Least {
  double horizontal_m = 1e9;  ///< where they are in one layer
  double vertical_m = 1e9;    ///< where they are within the horizontal minimum
};

/// Judged by where they are, whatever they think.
class Sky {
 public:
  explicit Sky(std::vector<Flyer> all) : flyers{std::move(all)} {}

  void fly(double seconds) {
    const Instant until = now + from_seconds(seconds);
    for (; now < until; now += kTick) tick();
  }

  std::vector<Flyer> flyers;
  Instant now{};
  Least least;
  std::optional<Instant> too_near_at;  ///< to the side, whatever their heights

 private:
  struct Word {
    Instant at;
    Telemetry telemetry;
  };
  void tick() {
    for (Flyer& flyer : flyers) {
      flyer.fly(now);
      if (now.time_since_epoch() % kTelemetry == Duration{} && flyer.speaks) {
        air_.push_back({now + kDelay, flyer.telemetry()});
      }
    }
    const auto due = [this](const Word& word) { return word.at <= now; };
    for (const Word& word : air_) {
      if (!due(word)) continue;
      for (Flyer& flyer : flyers) {
        if (flyer.hears) flyer.watch.on_telemetry(word.telemetry, flyer.state, now);
      }
    }
    std::erase_if(air_, due);
    for (Flyer& flyer : flyers) flyer.decide(now);
    judge();
  }
  void judge() {
    for (std::size_t i = 0; i < flyers.size(); ++i) {
      for (std::size_t j = i + 1; j < flyers.size(); ++j) {
        const VehicleState& a = flyers[i].state;
        const VehicleState& b = flyers[j].state;
        const double side_m = std::hypot(a.x_m - b.x_m, a.y_m - b.y_m);
        const double height_m = std::abs(a.z_m - b.z_m);
        if (height_m < 5.0) least.horizontal_m = std::min(least.horizontal_m, side_m);
        if (side_m >= 20.0) continue;
        least.vertical_m = std::min(least.vertical_m, height_m);
        if (!too_near_at) too_near_at = now;
      }
    }
  }
  std::vector<Word> air_;
};

/// They meet head on at the origin, after 20 s.
Sky head_on(std::uint16_t first = 1, std::uint16_t second = 2, double second_height_m = kLayer_m) {
  return Sky{{Flyer{first, {-500.0, 0.0}, 0.0, 25.0},
              Flyer{second, {500.0, 2.0}, kPi, 25.0, second_height_m}}};
}

TEST(SeparationWatch, TheHigherNumberGivesWayUpwardsAndComesBack) {
  Sky sky = head_on();
  sky.fly(60.0);
  EXPECT_FALSE(sky.flyers[0].gave_way);
  EXPECT_TRUE(sky.flyers[1].gave_way);
  EXPECT_GE(sky.least.vertical_m, 5.0);
  EXPECT_NEAR(sky.flyers[1].state.z_m, kLayer_m, 0.1) << "back in its layer";
  for (const Flyer& flyer : sky.flyers) {
    ASSERT_EQ(flyer.warnings.size(), 1U);
    EXPECT_EQ(flyer.warnings[0].gives_way, VehicleId{2});
    EXPECT_NEAR(flyer.warnings[0].horizontal_m, 2.0, 0.5);
    EXPECT_NEAR(to_seconds(flyer.warnings[0].in), 20.0, 1.0);
    EXPECT_EQ(flyer.restored, 1);
    EXPECT_FALSE(flyer.watch.conflict());
  }
}

TEST(SeparationWatch, OfTwoUnderOneNumberOneGivesWay) {
  const coalition::ProtocolParams params;
  Sky sky{{Flyer{1, {-500.0, 0.0}, 0.0, 25.0, kLayer_m, params, {7}},
           Flyer{1, {500.0, 2.0}, kPi, 25.0, kLayer_m, params, {8}}}};
  sky.fly(60.0);
  EXPECT_FALSE(sky.flyers[0].gave_way);
  EXPECT_TRUE(sky.flyers[1].gave_way);
  EXPECT_GE(sky.least.vertical_m, 5.0);
}

TEST(SeparationWatch, WithoutItTheyWouldHaveMet) {
  coalition::ProtocolParams off;
  off.separation_look_ahead = {};
  Sky sky{{Flyer{1, {-500.0, 0.0}, 0.0, 25.0, kLayer_m, off},
           Flyer{2, {500.0, 2.0}, kPi, 25.0, kLayer_m, off}}};
  sky.fly(60.0);
  EXPECT_LT(sky.least.vertical_m, 0.1);
  EXPECT_TRUE(sky.flyers[0].warnings.empty() && sky.flyers[1].warnings.empty());
}

TEST(SeparationWatch, InLayersThatAreApartNothingIsKnownOfOthers) {
  for (const double apart_m : {9.0, 10.0, -10.0, 50.0}) {
    Sky sky = head_on(1, 2, kLayer_m + apart_m);
    for (int i = 0; i < 60; ++i) {
      sky.fly(1.0);
      ASSERT_FALSE(sky.flyers[0].watch.watches() || sky.flyers[1].watch.watches()) << apart_m;
    }
    EXPECT_LT(sky.least.vertical_m, 1e8) << "they did pass each other";
  }
}

TEST(SeparationWatch, WhoIsBelowOneThatLandsGivesWayInTime) {
  // It would be at the other's height where they meet, 5 m below, or has come far below by then.
  for (const double above_m : {40.0, 35.0, 10.0}) {
    Sky sky = head_on(1, 2, kLayer_m + above_m);
    sky.flyers[1].activity = Activity::landing;
    sky.flyers[1].sinks_mps = 2.0;
    sky.fly(30.0);
    EXPECT_EQ(sky.flyers[0].gave_way, above_m > 20.0);
    EXPECT_GE(sky.least.vertical_m, 5.0) << above_m;
  }
}

/// It comes from far above, and is at the other's height where they meet: that takes 12 s.
TEST(SeparationWatch, WhoGivesWayToOneThatLandsDoesSoUntilThatHasPassed) {
  Sky sky{{Flyer{1, {-300.0, 0.0}, 0.0, 25.0}, Flyer{2, {300.0, 2.0}, kPi, 25.0, kLayer_m + 60.0}}};
  sky.flyers[1].activity = Activity::landing;
  sky.flyers[1].sinks_mps = 5.0;
  sky.fly(10.0);
  EXPECT_EQ(sky.flyers[0].restored, 0);
  EXPECT_LT(sky.flyers[0].state.z_m, kLayer_m - 5.0) << "not up, past it";
  sky.fly(20.0);
  EXPECT_EQ(sky.flyers[0].restored, 1);
  EXPECT_GE(sky.least.vertical_m, 5.0);
}

/// They meet where it would pass the other's height.
TEST(SeparationWatch, WhoClimbsBackFromALandingWaitsBelowWhoMayCome) {
  for (const double from_m : {80.0, 97.0}) {  // below the other's height, and at it
    Sky sky{{Flyer{3, {-300.0, 0.0}, 0.0, 25.0}, Flyer{2, {300.0, 2.0}, kPi, 25.0, 100.0}}};
    Flyer& climber = sky.flyers[0];
    climber.climb_back(from_m);
    sky.fly(11.0);
    EXPECT_GE(sky.least.vertical_m, 5.0) << from_m;
    EXPECT_NEAR(climber.state.z_m, 93.0, 2.0);
    sky.fly(40.0);
    EXPECT_NEAR(climber.state.z_m, kLayer_m, 1.0) << "nobody can come";
    EXPECT_GE(sky.least.vertical_m, 5.0);
    EXPECT_FALSE(sky.flyers[1].gave_way);
  }
}

/// Beside it all the time, and free to turn.
TEST(SeparationWatch, WhoClimbsBackDoesNotStayAtTheHeightOfAnother) {
  Sky sky{{Flyer{3, {0.0, 0.0}, 0.0, 25.0}, Flyer{2, {0.0, 200.0}, 0.0, 25.0, 100.0}}};
  sky.flyers[0].climb_back(97.0);
  sky.fly(15.0);
  EXPECT_NEAR(sky.flyers[0].state.z_m, 93.0, 0.5);
  EXPECT_TRUE(sky.flyers[0].warnings.empty());

  Sky narrow{{Flyer{3, {0.0, 0.0}, 0.0, 25.0}, Flyer{1, {0.0, 200.0}, 0.0, 25.0, 100.0},
              Flyer{2, {0.0, -200.0}, 0.0, 25.0, 92.0}}};
  narrow.flyers[0].climb_back(97.0);
  narrow.fly(20.0);
  EXPECT_NEAR(narrow.flyers[0].state.z_m, 85.0, 0.5) << "nor between layers without room";
}

TEST(SeparationWatch, OnTheGroundNobodyIsWarned) {
  Sky sky{{Flyer{1, {0.0, 0.0}, 0.0, 0.0}, Flyer{2, {5.0, 0.0}, 0.0, 0.0}}};
  for (int i = 0; i * to_seconds(kTick) < 10.0; ++i) {
    for (Flyer& flyer : sky.flyers) flyer.state.z_m = 0.3;
    sky.fly(to_seconds(kTick));
  }
  for (const Flyer& flyer : sky.flyers) EXPECT_FALSE(flyer.watch.watches());
}

TEST(SeparationWatch, WhoIsBelowGivesWayDownwardsButNotBelowTheFloor) {
  Sky sky = head_on(1, 2, kLayer_m - 3.0);
  sky.fly(15.0);
  EXPECT_NEAR(sky.flyers[1].state.z_m, kLayer_m - 7.0, 0.5);
  EXPECT_FALSE(sky.flyers[0].gave_way);
  sky.fly(45.0);
  EXPECT_GE(sky.least.vertical_m, 5.0);

  coalition::ProtocolParams low;
  low.separation_floor_m = kLayer_m - 6.0;
  Sky above_floor{{Flyer{1, {-500.0, 0.0}, 0.0, 25.0, kLayer_m, low},
                   Flyer{2, {500.0, 2.0}, kPi, 25.0, kLayer_m - 3.0, low}}};
  above_floor.fly(15.0);
  EXPECT_NEAR(above_floor.flyers[1].state.z_m, kLayer_m + 7.0, 0.5) << "through, there was time";
  above_floor.fly(45.0);
  EXPECT_GE(above_floor.least.vertical_m, 5.0);
}

TEST(SeparationWatch, WhoExecutesATaskKeepsItsHeight) {
  Sky sky = head_on();
  sky.flyers[1].activity = Activity::executing;
  sky.fly(60.0);
  EXPECT_TRUE(sky.flyers[0].gave_way);
  EXPECT_FALSE(sky.flyers[1].gave_way);
  EXPECT_GE(sky.least.vertical_m, 5.0);
}

TEST(SeparationWatch, WhoIsPilotedIsGivenWayTo) {
  Sky sky = head_on();
  sky.flyers[1].can_change_height = false;
  sky.flyers[1].detail = ActivityDetail::piloted;
  sky.fly(60.0);
  EXPECT_TRUE(sky.flyers[0].gave_way);
  EXPECT_FALSE(sky.flyers[1].gave_way);
  EXPECT_GE(sky.least.vertical_m, 5.0);
  ASSERT_EQ(sky.flyers[1].warnings.size(), 1U);
  EXPECT_EQ(sky.flyers[1].warnings[0].gives_way, VehicleId{1});
}

TEST(SeparationWatch, WhereTheOtherDoesNotBeginToThisOneGivesWayAfterAll) {
  Sky sky = head_on();
  sky.flyers[1].can_change_height = false;  // nobody knows
  sky.fly(60.0);
  EXPECT_TRUE(sky.flyers[0].gave_way);
  EXPECT_GE(sky.least.vertical_m, 5.0);
  ASSERT_EQ(sky.flyers[0].warnings.size(), 2U) << "the operator is told that it does";
  EXPECT_EQ(sky.flyers[0].warnings[1].gives_way, VehicleId{1});
}

TEST(SeparationWatch, WhoHearsNobodyIsGivenWayTo) {
  Sky sky = head_on();
  sky.flyers[1].hears = false;
  sky.fly(60.0);
  EXPECT_TRUE(sky.flyers[0].gave_way);
  EXPECT_FALSE(sky.flyers[1].gave_way);
  EXPECT_GE(sky.least.vertical_m, 5.0);
}

TEST(SeparationWatch, WhoFallsSilentIsGivenWayToUntilTooLittleIsKnownOfIt) {
  Sky sky = head_on();
  sky.fly(4.0);
  sky.flyers[1].speaks = sky.flyers[1].hears = false;
  sky.flyers[1].can_change_height = false;
  sky.fly(8.0);
  EXPECT_TRUE(sky.flyers[0].gave_way);
  sky.fly(28.0);
  EXPECT_FALSE(sky.flyers[0].watch.watches());
  EXPECT_EQ(sky.flyers[0].restored, 1);
  EXPECT_NEAR(sky.flyers[0].state.z_m, kLayer_m, 0.5);
}

TEST(SeparationWatch, WhereNobodyHasRoomThatIsTold) {
  coalition::ProtocolParams none;
  none.separation_floor_m = kLayer_m - 1.0;
  none.separation_ceiling_m = kLayer_m + 1.0;
  Sky sky{{Flyer{1, {-500.0, 0.0}, 0.0, 25.0, kLayer_m, none},
           Flyer{2, {500.0, 2.0}, kPi, 25.0, kLayer_m, none}}};
  sky.fly(10.0);
  EXPECT_FALSE(sky.flyers[0].gave_way || sky.flyers[1].gave_way);
  ASSERT_FALSE(sky.flyers[1].warnings.empty());
  EXPECT_EQ(sky.flyers[1].warnings[0].gives_way, VehicleId{});
}

TEST(SeparationWatch, AThirdInTheNextLayerIsPassedToo) {
  // The second would climb into the third, which comes the same way a layer above.
  Sky sky{{Flyer{1, {-500.0, 0.0}, 0.0, 25.0}, Flyer{2, {500.0, 2.0}, kPi, 25.0},
           Flyer{3, {-500.0, 4.0}, 0.0, 25.0, kLayer_m + 10.0}}};
  sky.fly(60.0);
  EXPECT_TRUE(sky.flyers[1].gave_way);
  EXPECT_GE(sky.least.vertical_m, 5.0);
  for (const Flyer& flyer : sky.flyers) EXPECT_EQ(flyer.watch.offset_m(), 0.0);
}

TEST(SeparationWatch, TwoThatCircleInOneLayerAreToldOfSeldom) {
  Sky sky{{Flyer{1, {0.0, 0.0}, 0.0, 25.0}, Flyer{2, {150.0, 0.0}, 1.0, 25.0}}};
  constexpr double kSeconds = 120.0;
  for (int i = 0; i * to_seconds(kTick) < kSeconds; ++i) {
    for (Flyer& flyer : sky.flyers) {
      flyer.state.heading_rad = flyer.state.course_rad =
          wrap_pi(flyer.state.course_rad + 25.0 / 100.0 * to_seconds(kTick));
    }
    sky.fly(to_seconds(kTick));
  }
  for (const Flyer& flyer : sky.flyers) {
    EXPECT_FALSE(flyer.warnings.empty());
    for (std::size_t i = 1; i < flyer.warned_at.size(); ++i) {
      const bool gives_way_anew = flyer.warnings[i].gives_way != flyer.warnings[i - 1].gives_way;
      if (gives_way_anew) continue;
      EXPECT_GE(flyer.warned_at[i] - flyer.warned_at[i - 1], SeparationWatch::kToldEvery);
    }
  }
}

/// Warned so long before, two keep the vertical minimum, whoever meets how.
constexpr Duration kEnough = std::chrono::seconds{8};

class Geometries : public ::testing::TestWithParam<int> {};

TEST_P(Geometries, ExactlyOneGivesWayAndTheMinimumIsKept) {
  Random random{static_cast<std::uint64_t>(GetParam())};
  int conflicts = 0;
  int kept = 0;
  for (int i = 0; i < 60; ++i) {
    const double meet_s = random.uniform(10.0, 40.0);
    const auto flyer = [&](std::uint16_t id) {
      const double heading = random.uniform(-kPi, kPi);
      const double speed = random.uniform(10.0, 40.0);
      const Vec2 meets{random.uniform(-25.0, 25.0), random.uniform(-25.0, 25.0)};
      Flyer made{id, meets - meet_s * speed * unit_vector(heading), heading, speed,
                 kLayer_m + random.uniform(-2.0, 2.0)};
      if (random.chance(0.3)) made.activity = Activity::executing;
      return made;
    };
    Sky sky{{flyer(1), flyer(2)}};
    sky.fly(meet_s + 60.0);
    const auto& flyers = sky.flyers;
    if (flyers[0].warnings.empty() && flyers[1].warnings.empty()) {
      EXPECT_FALSE(sky.too_near_at) << "seed " << GetParam() << ", " << i;
      continue;
    }
    ++conflicts;
    EXPECT_NE(flyers[0].gave_way, flyers[1].gave_way) << "seed " << GetParam() << ", " << i;
    EXPECT_EQ(flyers[0].watch.offset_m(), 0.0);
    EXPECT_EQ(flyers[1].watch.offset_m(), 0.0);
    if (!sky.too_near_at) continue;
    const Instant warned = std::max(flyers[0].warned_at.at(0), flyers[1].warned_at.at(0));
    if (*sky.too_near_at - warned < kEnough) continue;
    ++kept;
    EXPECT_GE(sky.least.vertical_m, 5.0) << "seed " << GetParam() << ", " << i;
  }
  EXPECT_GT(conflicts, 20);
  EXPECT_GT(kept, 10);
}

INSTANTIATE_TEST_SUITE_P(Seeds, Geometries, ::testing::Range(1, 9));

TEST(TellsPiloted, WhoFliesAnAircraftIsDataOfItsNotices) {
  EXPECT_EQ(tells_piloted(AutopilotNews::mode_changed), true);
  EXPECT_EQ(tells_piloted(AutopilotNews::flying), false);
  EXPECT_EQ(tells_piloted(AutopilotNews::pre_arm), std::nullopt);
  EXPECT_EQ(tells_piloted(AutopilotNews::not_given_back), std::nullopt)
      << "of who flies it nothing, where the operator gives back what nobody has taken";
}

}  // namespace
}  // namespace skein::mission
