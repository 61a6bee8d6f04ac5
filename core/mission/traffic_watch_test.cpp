// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/traffic_watch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "skein/base/angles.hpp"
#include "skein/base/random.hpp"
#include "skein/mission/guidance.hpp"

namespace skein::mission {
namespace {

constexpr double kLayer_m = 120.0;
constexpr Duration kTick = std::chrono::milliseconds{100};

Aircraft aircraft(const Vec2& from, const Vec2& velocity, double height_m, double climb_mps = 0.0) {
  return {.address = 0x4ca2d6,
          .position = from,
          .height_m = height_m,
          .east_mps = velocity.x(),
          .north_mps = velocity.y(),
          .climb_mps = climb_mps};
}

/// A vehicle that flies straight on, and an aircraft that the ground station tells of once a
/// second; the vehicle's height follows at the rate of plans, with the lag of a plane.
struct Meeting {
  explicit Meeting(const Aircraft& other, const TrafficParams& params = {})
      : watch{params}, other_{other}, params_{params} {
    self.state.z_m = self.layer_m = kLayer_m;
    self.state.groundspeed_mps = 25.0;
    self.may_give_way = true;
  }

  void fly(double seconds) {
    for (const Instant until = now + from_seconds(seconds); now < until; now += kTick) tick();
  }

  /// From now on, from where it is.
  void other_flies(const Vec2& velocity_mps) {
    const Vec2 at = there().position;
    other_.position = at - to_seconds(now.time_since_epoch()) * velocity_mps;
    other_.east_mps = velocity_mps.x();
    other_.north_mps = velocity_mps.y();
  }

  TrafficWatch::Self self;
  TrafficWatch watch;
  Instant now{};
  bool told = true;
  std::vector<event::TrafficWarning> warnings;
  int cleared = 0;
  double least_vertical_m = std::numeric_limits<double>::infinity();  ///< while near to the side
  double lowest_m = kLayer_m;
  double highest_m = kLayer_m;

  [[nodiscard]] Aircraft there() const {
    Aircraft at = other_;
    const double s = to_seconds(now.time_since_epoch());
    at.position += s * Vec2{at.east_mps, at.north_mps};
    at.height_m += s * at.climb_mps;
    at.time = now;
    return at;
  }

 private:
  void tick() {
    constexpr double kSeconds = to_seconds(kTick);
    self.state.time = now;
    self.state.x_m += kSeconds * self.state.velocity_mps().x();
    self.state.y_m += kSeconds * self.state.velocity_mps().y();
    const double wanted_m = watch.height_m().value_or(self.layer_m) - self.layer_m;
    if (plan_.height_to_m != wanted_m) {
      plan_.height_from_m = height_offset_m(plan_, now);
      plan_.height_to_m = wanted_m;
      plan_.height_since = now;
    }
    if (self.may_give_way) {
      const double asked_m = self.layer_m + height_offset_m(plan_, now);
      self.state.z_m += (asked_m - self.state.z_m) * kSeconds / 3.0;
    }
    if (told && now.time_since_epoch() % std::chrono::seconds{1} == Duration{}) {
      watch.on_traffic({{there()}});
    }
    watch.step(self, now);
    while (const auto news = watch.poll_event()) {
      if (const auto* warning = std::get_if<event::TrafficWarning>(&*news)) {
        warnings.push_back(*warning);
      } else {
        ++cleared;
      }
    }
    lowest_m = std::min(lowest_m, self.state.z_m);
    highest_m = std::max(highest_m, self.state.z_m);
    const Aircraft at = there();
    const double side_m = (at.position - Vec2{self.state.x_m, self.state.y_m}).norm();
    if (side_m < params_.horizontal_m) {
      least_vertical_m = std::min(least_vertical_m, std::abs(at.height_m - self.state.z_m));
    }
  }

  Aircraft other_;
  TrafficParams params_;
  FlightPlan plan_;
};

TEST(TrafficWatch, WhatPassesHighAboveIsNoConflict) {
  Meeting meeting{aircraft({6000.0, 0.0}, {-60.0, 0.0}, 400.0)};
  meeting.fly(150.0);
  EXPECT_TRUE(meeting.warnings.empty());
  EXPECT_EQ(meeting.lowest_m, kLayer_m);
}

TEST(TrafficWatch, WhatPassesFarToTheSideIsNoConflict) {
  Meeting meeting{aircraft({6000.0, 2000.0}, {-60.0, 0.0}, 150.0)};
  meeting.fly(150.0);
  EXPECT_TRUE(meeting.warnings.empty());
}

TEST(TrafficWatch, ItGivesWayDownwardsAndComesBack) {
  Meeting meeting{aircraft({9000.0, 100.0}, {-60.0, 0.0}, 220.0)};
  meeting.fly(200.0);
  ASSERT_EQ(meeting.warnings.size(), 1U);
  EXPECT_TRUE(meeting.warnings[0].gives_way);
  EXPECT_EQ(meeting.warnings[0].address, 0x4ca2d6U);
  EXPECT_GE(meeting.least_vertical_m, 150.0);
  EXPECT_LT(meeting.lowest_m, 70.0);
  EXPECT_LE(meeting.highest_m, kLayer_m + 0.5);
  EXPECT_EQ(meeting.cleared, 1);
  EXPECT_FALSE(meeting.watch.gives_way());
  EXPECT_NEAR(meeting.self.state.z_m, kLayer_m, 1.0);
}

TEST(TrafficWatch, WhereItsMomentHasPassedAndItIsStillToComeItIsToldAnew) {
  Meeting meeting{aircraft({6000.0, 100.0}, {-60.0, 0.0}, 220.0)};
  meeting.fly(30.0);
  ASSERT_EQ(meeting.warnings.size(), 1U);
  const double first_s = to_seconds(meeting.warnings[0].in);
  EXPECT_LT(first_s, 75.0);
  meeting.other_flies({-15.0, 0.0});  // it has slowed down, and is there half a minute later
  meeting.fly(60.0);
  ASSERT_EQ(meeting.warnings.size(), 2U);
  EXPECT_TRUE(meeting.warnings[1].gives_way);
  EXPECT_GT(to_seconds(meeting.warnings[1].in), 10.0);
  meeting.fly(200.0);
  EXPECT_EQ(meeting.warnings.size(), 2U);
  EXPECT_EQ(meeting.cleared, 1);
}

TEST(TrafficWatch, BelowTheFloorThereIsNoRoom) {
  Meeting meeting{aircraft({9000.0, 100.0}, {-60.0, 0.0}, 150.0)};
  meeting.fly(110.0);
  ASSERT_FALSE(meeting.warnings.empty());
  EXPECT_FALSE(meeting.warnings[0].gives_way) << "30 m is not 150 m below 150 m";
  EXPECT_NEAR(meeting.lowest_m, 30.0, 1.0) << "but as far away as there is room";
  EXPECT_GE(meeting.lowest_m, 29.0);
  EXPECT_GT(meeting.least_vertical_m, 115.0);
}

TEST(TrafficWatch, AboveWhatComesLowItClimbs) {
  Meeting meeting{aircraft({9000.0, 100.0}, {-40.0, 0.0}, 20.0)};
  meeting.fly(200.0);
  ASSERT_EQ(meeting.warnings.size(), 1U);
  EXPECT_TRUE(meeting.warnings[0].gives_way);
  EXPECT_GE(meeting.least_vertical_m, 150.0);
  EXPECT_GT(meeting.highest_m, 165.0);
  EXPECT_NEAR(meeting.self.state.z_m, kLayer_m, 1.0);
}

TEST(TrafficWatch, WhatDescendsThroughItsHeightIsForeseen) {
  Meeting meeting{aircraft({9000.0, 100.0}, {-60.0, 0.0}, 700.0, -4.0)};
  meeting.fly(150.0);
  ASSERT_FALSE(meeting.warnings.empty());
  EXPECT_TRUE(meeting.least_vertical_m >= 150.0 || !meeting.warnings.back().gives_way);
}

TEST(TrafficWatch, WhoMayNotGiveWayIsWarned) {
  Meeting meeting{aircraft({9000.0, 100.0}, {-60.0, 0.0}, 220.0)};
  meeting.self.may_give_way = false;
  meeting.fly(150.0);
  ASSERT_EQ(meeting.warnings.size(), 1U);
  EXPECT_FALSE(meeting.warnings[0].gives_way);
  EXPECT_EQ(meeting.lowest_m, kLayer_m);
  EXPECT_EQ(meeting.cleared, 1);
}

TEST(TrafficWatch, WhatIsHeardNoMoreIsForgottenAndItComesBack) {
  Meeting meeting{aircraft({6000.0, 100.0}, {-60.0, 0.0}, 220.0)};
  meeting.fly(20.0);
  ASSERT_TRUE(meeting.watch.gives_way());
  meeting.told = false;
  meeting.fly(25.0);
  EXPECT_TRUE(meeting.watch.gives_way()) << "it is where it was heading";
  meeting.fly(120.0);
  EXPECT_FALSE(meeting.watch.watches());
  EXPECT_EQ(meeting.cleared, 1);
  EXPECT_NEAR(meeting.self.state.z_m, kLayer_m, 1.0);
}

TEST(TrafficWatch, NoneIsToldOfMeansClear) {
  Meeting meeting{aircraft({6000.0, 100.0}, {-60.0, 0.0}, 220.0)};
  meeting.fly(20.0);
  meeting.told = false;
  meeting.watch.on_traffic({});
  meeting.fly(2.0);
  EXPECT_FALSE(meeting.watch.gives_way());
}

TEST(TrafficWatch, WhatIsNoNumberIsNotHeeded) {
  Meeting meeting{aircraft({6000.0, 100.0}, {-60.0, 0.0}, 220.0)};
  meeting.told = false;
  Aircraft broken = meeting.there();
  broken.height_m = std::numeric_limits<double>::quiet_NaN();
  meeting.watch.on_traffic({{broken}});
  EXPECT_FALSE(meeting.watch.watches());
}

TEST(TrafficWatch, LookAheadZeroLooksAtNothing) {
  TrafficParams off;
  off.look_ahead = {};
  Meeting meeting{aircraft({6000.0, 100.0}, {-60.0, 0.0}, 150.0), off};
  meeting.fly(150.0);
  EXPECT_TRUE(meeting.warnings.empty());
}

/// Whoever meets how: the minima are kept, or it was told before that they would not be.
class TrafficGeometries : public ::testing::TestWithParam<int> {};

TEST_P(TrafficGeometries, TheMinimaAreKeptOrItIsTold) {
  Random random{static_cast<std::uint64_t>(GetParam())};
  int conflicts = 0;
  int kept = 0;
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE(i);
    const double meet_s = random.uniform(20.0, 180.0);
    const double heading = random.uniform(-kPi, kPi);
    const Vec2 velocity = random.uniform(20.0, 120.0) * unit_vector(heading);
    const Vec2 meets{25.0 * meet_s + random.uniform(-800.0, 800.0), random.uniform(-800.0, 800.0)};
    const double climb = random.chance(0.3) ? random.uniform(-6.0, 6.0) : 0.0;
    const double height = random.uniform(0.0, 400.0) - climb * meet_s;
    Meeting meeting{aircraft(meets - meet_s * velocity, velocity, height, climb)};
    meeting.fly(meet_s + 150.0);
    const bool told_no = std::ranges::any_of(
        meeting.warnings, [](const auto& warning) { return !warning.gives_way; });
    if (!meeting.warnings.empty()) ++conflicts;
    if (!meeting.warnings.empty() && !told_no) ++kept;
    EXPECT_TRUE(meeting.least_vertical_m >= 150.0 || told_no) << meeting.least_vertical_m;
    EXPECT_GE(meeting.lowest_m, 29.0);
    EXPECT_FALSE(meeting.watch.gives_way());
  }
  EXPECT_GT(conflicts, 10);
  EXPECT_GT(kept, 2);
}

INSTANTIATE_TEST_SUITE_P(Seeds, TrafficGeometries, ::testing::Range(1, 9));

}  // namespace
}  // namespace skein::mission
