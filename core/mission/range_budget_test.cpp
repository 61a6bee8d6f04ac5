// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/range_budget.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "skein/base/random.hpp"

namespace skein::mission {
namespace {

constexpr double kSpeed_mps = 50.0;
constexpr double kRange_m = 50'000.0;
constexpr double kReserve_percent = 20.0;
constexpr double kConfigured_m = kRange_m / (100.0 - kReserve_percent);  // of a percent

VehicleSpec spec() {
  VehicleSpec vehicle;
  vehicle.cruise_speed_mps = kSpeed_mps;
  vehicle.range_m = kRange_m;
  vehicle.battery_reserve_percent = kReserve_percent;
  return vehicle;
}

/// A vehicle whose gauge tells whole percents, rounded down, as ArduPilot does.
class Flown {
 public:
  explicit Flown(double lasts_m, double full_percent = 100.0)
      : lasts_m_{lasts_m}, percent_{full_percent} {
    tell();
  }
  void fly(double metres, Duration period = std::chrono::milliseconds{50}) {
    const double end_m = state_.distance_flown_m + metres;
    while (state_.distance_flown_m < end_m) {
      const double step_m =
          std::min(kSpeed_mps * to_seconds(period), end_m - state_.distance_flown_m);
      state_.groundspeed_mps = kSpeed_mps;
      state_.distance_flown_m += step_m;
      state_.time += from_seconds(step_m / kSpeed_mps);
      percent_ -= 100.0 * step_m / lasts_m_;
      tell();
    }
  }
  void wait(double seconds, double used_percent) {
    state_.groundspeed_mps = 0.0;
    for (int i = 0; i < 100; ++i) {
      state_.time += from_seconds(seconds / 100.0);
      percent_ -= used_percent / 100.0;
      tell();
    }
  }
  /// For so long, and on the way from there on.
  void gauge(double percent, double seconds = 4.0) {
    percent_ = percent;
    const auto times = static_cast<int>(2.0 * seconds);
    for (int i = 0; i <= times; ++i) {
      tell();
      state_.time += from_seconds(0.5);
    }
  }
  void forget_gauge() { tells_ = false; }
  [[nodiscard]] double true_left_m() const {
    return (percent_ - kReserve_percent) / 100.0 * lasts_m_;
  }
  [[nodiscard]] double configured_left_m() const { return kRange_m - state_.distance_flown_m; }

  RangeBudget budget{spec()};
  int changes = 0;

 private:
  void tell() {
    const double told = std::clamp(std::floor(percent_ + 1e-9), 0.0, 100.0);
    state_.battery_percent = tells_ ? static_cast<std::uint8_t>(told) : kBatteryNotTold;
    changes += budget.on_state(state_) ? 1 : 0;
  }
  double lasts_m_;
  double percent_;
  bool tells_ = true;
  VehicleState state_;
};

TEST(RangeBudget, WithoutABatteryTheConfigurationAloneCounts) {
  RangeBudget budget{spec()};
  VehicleState state;
  state.distance_flown_m = 12'345.0;
  EXPECT_FALSE(budget.on_state(state));
  EXPECT_EQ(budget.left_m(), kRange_m - 12'345.0);
  EXPECT_FALSE(budget.battery_decides());
  state.battery_percent = 101;  // no percentage
  EXPECT_FALSE(budget.on_state(state));
  EXPECT_EQ(budget.left_m(), kRange_m - 12'345.0);
  state.distance_flown_m = 60'000.0;
  (void)budget.on_state(state);
  EXPECT_EQ(budget.left_m(), -10'000.0);
}

TEST(RangeBudget, OnTheGroundItIsWhatTheConfigurationMakesOfThePercentage) {
  Flown full{200'000.0};
  EXPECT_EQ(full.budget.left_m(), kRange_m);
  Flown half{200'000.0, 50.0};
  EXPECT_EQ(half.budget.left_m(), 30.0 * kConfigured_m);
  EXPECT_TRUE(half.budget.battery_decides());
  half.wait(3600.0, 4.0);  // its electronics run
  EXPECT_EQ(half.budget.metres_per_percent(), kConfigured_m);
  EXPECT_EQ(half.budget.left_m(), 26.0 * kConfigured_m);
}

TEST(RangeBudget, LearnsABatteryThatDoesNotLastAsLongAsConfigured) {
  Flown flown{25'000.0};  // half of it
  flown.fly(500.0);
  EXPECT_GT(flown.budget.left_m(), 0.85 * (kRange_m - 500.0));  // two steps decide on nothing
  flown.fly(12'000.0);
  EXPECT_NEAR(flown.budget.metres_per_percent(), 250.0, 6.0);
  EXPECT_NEAR(flown.budget.left_m(), flown.true_left_m(), 500.0);
  flown.fly(6'500.0);
  EXPECT_NEAR(flown.budget.left_m(), flown.true_left_m(), 260.0);  // a percent
}

TEST(RangeBudget, ABatteryThatLastsLongerAddsNothingToTheConfiguration) {
  Flown flown{200'000.0};
  flown.fly(40'000.0);
  EXPECT_EQ(flown.budget.left_m(), flown.configured_left_m());
  EXPECT_FALSE(flown.budget.battery_decides());
}

TEST(RangeBudget, WhatIsUsedWithoutFlyingIsGoneButTeachesNothing) {
  Flown flown{50'000.0};
  flown.fly(10'100.0);
  const double before = flown.budget.metres_per_percent();
  const double left_m = flown.budget.left_m();
  flown.wait(600.0, 10.0);
  EXPECT_EQ(flown.budget.metres_per_percent(), before);
  EXPECT_NEAR(flown.budget.left_m(), left_m - 10.0 * before, before);
}

TEST(RangeBudget, AGaugeThatFallsAtOnceIsBelievedButTeachesNothing) {
  Flown flown{50'000.0};
  flown.fly(10'000.0);
  const double before = flown.budget.metres_per_percent();
  flown.gauge(25.0);
  EXPECT_EQ(flown.budget.metres_per_percent(), before);
  EXPECT_EQ(flown.budget.left_m(), 5.0 * before);
}

TEST(RangeBudget, AGaugeThatIsWrongForAMomentIsNotBelieved) {
  Flown flown{50'000.0};
  flown.fly(10'100.0);
  const double left_m = flown.budget.left_m();
  for (const double wrong : {0.0, 100.0}) {
    flown.gauge(wrong, 2.0);
    EXPECT_EQ(flown.budget.left_m(), left_m);
    flown.gauge(79.8, 1.0);
    EXPECT_EQ(flown.budget.left_m(), left_m);
  }
}

TEST(RangeBudget, AnAutopilotThatRestartsInFlightAndCountsFromFullChargesNoBattery) {
  Flown flown{50'000.0};
  flown.fly(20'000.0);
  const double left_m = flown.budget.left_m();
  flown.gauge(100.0);
  EXPECT_EQ(flown.budget.left_m(), left_m);
  flown.fly(5'000.0);
  EXPECT_NEAR(flown.budget.left_m(), left_m - 5'000.0, 600.0);
}

TEST(RangeBudget, OnTheGroundItIsAnotherBattery) {
  Flown flown{50'000.0};
  flown.fly(20'000.0);
  flown.wait(60.0, 0.0);
  flown.gauge(100.0);
  EXPECT_EQ(flown.budget.left_m(), kRange_m - 20'000.0);  // the configuration's
  EXPECT_FALSE(flown.budget.battery_decides());
}

TEST(RangeBudget, ALittleMoreIsNoise) {
  Flown flown{50'000.0};
  flown.fly(10'000.0);
  const double left_m = flown.budget.left_m();
  flown.gauge(83.0);
  EXPECT_EQ(flown.budget.left_m(), left_m);
}

TEST(RangeBudget, WhatWasToldLastCountsWhileNothingIsTold) {
  Flown flown{50'000.0, 60.0};
  flown.fly(2'000.0);
  const double left_m = flown.budget.left_m();
  flown.forget_gauge();
  flown.fly(300.0);
  EXPECT_TRUE(flown.budget.battery_decides());
  EXPECT_LT(flown.budget.left_m(), left_m);
}

TEST(RangeBudget, SaysWhenThePercentageHasChanged) {
  Flown flown{50'000.0};
  flown.changes = 0;
  flown.fly(5'000.0);
  EXPECT_NEAR(flown.changes, 10, 1);
}

/// Whatever its battery is, how it is flown and how often it is told: never more than the
/// configuration leaves, never up by more than a percent, and right within a twentieth once two
/// fifths of the battery have been flown.
TEST(RangeBudget, HoldsForAnyBattery) {
  Random random{20'261'125};
  for (int run = 0; run < 200; ++run) {
    const double lasts_m = random.uniform(0.3, 3.0) * kRange_m;
    Flown flown{lasts_m, random.uniform(60.0, 100.0)};
    const Duration period = std::chrono::milliseconds{20 + run % 500};
    double before = flown.budget.left_m();
    double flown_m = 0.0;
    while (flown.true_left_m() > 0.0 && flown_m < kRange_m) {
      const bool waits = random.uniform(0.0, 1.0) < 0.1;
      if (waits) {
        flown.wait(random.uniform(1.0, 100.0), random.uniform(0.0, 0.5));
      } else {
        const double metres = random.uniform(10.0, 2'000.0);
        flown.fly(metres, period);
        flown_m += metres;
      }
      const double left_m = flown.budget.left_m();
      const double percent_m = flown.budget.metres_per_percent();
      EXPECT_LE(left_m, flown.configured_left_m());
      // By learning that it lasts longer; else not by more than a percent that came late.
      const double most_m = lasts_m > kRange_m ? 80.0 * 0.2 * percent_m : 1.1 * percent_m;
      EXPECT_LE(left_m - before, most_m) << run;
      before = left_m;
      const double true_m = std::min(flown.true_left_m(), flown.configured_left_m());
      if (flown_m < 0.4 * lasts_m) continue;
      EXPECT_NEAR(left_m, true_m, 0.05 * kRange_m) << run << ", lasts " << lasts_m;
    }
  }
}

TEST(RangeBudget, TheSameStatesGiveTheSameNumbers) {
  Flown one{31'415.0};
  Flown other{31'415.0};
  for (Flown* flown : {&one, &other}) {
    flown->fly(9'000.0);
    flown->wait(20.0, 0.7);
    flown->fly(3'000.0);
  }
  EXPECT_EQ(one.budget.left_m(), other.budget.left_m());
  EXPECT_EQ(one.budget.metres_per_percent(), other.budget.metres_per_percent());
}

}  // namespace
}  // namespace skein::mission
