// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "emulator_test.hpp"
#include "skein/base/atmosphere.hpp"

namespace skein::hil {
namespace {

/// The speeds of a small plane, in flight.
EmulatorConfig small_plane() {
  EmulatorConfig config = in_flight();
  config.airspeed_mps = 25.0;
  config.airspeed_min_mps = 20.0;
  config.airspeed_max_mps = 30.0;
  config.turn_radius_m = 66.0;
  return config;
}

void watch(Companion& c) {
  for (const std::uint32_t id :
       {mavlink::Attitude::kDefinition.id, mavlink::GlobalPositionInt::kDefinition.id,
        mavlink::VfrHud::kDefinition.id}) {
    EXPECT_EQ(c.stream(id, 20.0), mavlink::CommandResult::accepted);
  }
  c.run(0.2);
}

constexpr std::uint8_t kRollAlone = mavlink::ignore_attitude | mavlink::ignore_thrust |
                                    mavlink::ignore_pitch_rate | mavlink::ignore_body_yaw_rate;

TEST(SmallPlane, FliesItsSpeedsAtItsHeight) {
  Companion companion{small_plane()};
  companion.run(15.0);
  for (const float wanted : {20.0F, 30.0F, 25.0F}) {
    EXPECT_EQ(companion.command(mavlink::Command::do_change_speed, 0.0F, wanted),
              mavlink::CommandResult::accepted);
    companion.run(40.0);
    const auto hud = companion.last<mavlink::VfrHud>().value();
    EXPECT_NEAR(hud.airspeed, wanted, 0.7);
    EXPECT_NEAR(hud.alt, 780.0F, 3.0);
  }
}

/// Held at a bank for so many tenths of a second; what it turns in the five seconds after, in
/// shares of g tan(bank) / V.
double turn_share(Companion& c, double bank_rad, int tenths) {
  const auto hold = [&](int steps) {
    for (int i = 0; i < steps; ++i) {
      c.hold_roll(bank_rad, 0.0, kRollAlone);
      c.run(0.1);
    }
  };
  const auto course = [&] {
    const auto p = c.last<mavlink::GlobalPositionInt>().value();
    return std::atan2(p.vy, p.vx);
  };
  hold(tenths);
  double turned = 0.0;
  double bank = 0.0;
  double airspeed = 0.0;
  double before = course();
  constexpr int kSamples = 50;
  for (int i = 0; i < kSamples; ++i) {
    hold(1);
    turned += wrap_pi(course() - before);
    before = course();
    bank += std::tan(static_cast<double>(c.last<mavlink::Attitude>()->roll)) / kSamples;
    airspeed += static_cast<double>(c.last<mavlink::VfrHud>()->airspeed) *
                true_per_equivalent_airspeed(780.0) / kSamples;
  }
  return turned / (0.1 * kSamples) / (kGravity_mps2 * bank / airspeed);
}

TEST(SmallPlane, SlipsInTurnsAsArduPlaneDoes) {
  for (const double bank_deg : {-40.0, 30.0, 45.0}) {
    Companion c{small_plane()};
    watch(c);
    EXPECT_NEAR(turn_share(c, radians(bank_deg), 60), 0.73, 0.03) << bank_deg;
  }
}

struct SpeedStep {
  double half_way_s = 0.0;
  double lowest_m = 0.0;  ///< of its height, off what it was told
  double highest_m = 0.0;
};

/// Straight on at an airspeed for 40 s, then another is asked for.
SpeedStep step_of(float from_mps, float to_mps) {
  Companion c{small_plane()};
  watch(c);
  const auto straight = [&](int tenths, const auto& look) {
    for (int i = 0; i < tenths; ++i) {
      c.hold_roll(0.0, 0.0, kRollAlone);
      c.run(0.1);
      look(0.1 * i);
    }
  };
  const auto ask = [&](float mps) {
    EXPECT_EQ(c.command(mavlink::Command::do_change_speed, 0.0F, mps),
              mavlink::CommandResult::accepted);
  };
  ask(from_mps);
  straight(400, [](double) {});
  ask(to_mps);
  SpeedStep step;
  const float middle = (from_mps + to_mps) / 2.0F;
  straight(250, [&](double t) {
    const auto hud = c.last<mavlink::VfrHud>().value();
    const bool passed = to_mps > from_mps ? hud.airspeed > middle : hud.airspeed < middle;
    if (passed && step.half_way_s == 0.0) step.half_way_s = t;
    step.lowest_m = std::min(step.lowest_m, static_cast<double>(hud.alt) - 780.0);
    step.highest_m = std::max(step.highest_m, static_cast<double>(hud.alt) - 780.0);
  });
  return step;
}

TEST(SmallPlane, FollowsAirspeedsLateAndHoldsItsHeight) {
  // A ramp of 0.82 m/s^2 up and 0.74 m/s^2 down.
  const SpeedStep faster = step_of(21.0F, 27.0F);
  EXPECT_GT(faster.half_way_s, 2.5);
  EXPECT_LT(faster.half_way_s, 5.5);
  EXPECT_GT(faster.lowest_m, -2.0);
  const SpeedStep slower = step_of(27.0F, 21.0F);
  EXPECT_GT(slower.half_way_s, 4.1);
  EXPECT_LT(slower.half_way_s, 7.0);
  EXPECT_LT(slower.highest_m, 2.0);
}

TEST(SmallPlane, ShortGustsAreThoseOfArduPilotsSimulator) {
  EmulatorConfig config = small_plane();
  config.turbulence_mps = 1.5;
  Companion c{config};
  watch(c);
  c.run(10.0);
  double sum = 0.0;
  double square = 0.0;
  double both = 0.0;
  double before = 0.0;
  constexpr int kSamples = 300;
  for (int i = 0; i < kSamples; ++i) {
    const double slow = static_cast<double>(c.last<mavlink::VfrHud>()->airspeed);
    c.run(0.2);
    const double change = static_cast<double>(c.last<mavlink::VfrHud>()->airspeed) - slow;
    sum += change;
    square += change * change;
    both += change * before;
    before = change;
  }
  // Changes of what has nothing in common with before: root two of it, half of it taken back next.
  EXPECT_NEAR(std::sqrt(square / kSamples), std::sqrt(2.0) * 0.71, 0.2);
  EXPECT_NEAR(both / square, -0.5, 0.12);
  EXPECT_NEAR(sum / kSamples, 0.0, 0.05);
}

TEST(SmallPlane, SaysEachAirspeedThatItIsGiven) {
  Companion c{small_plane()};
  EXPECT_EQ(c.command(mavlink::Command::do_change_speed, 0.0F, 27.0F),
            mavlink::CommandResult::accepted);
  EXPECT_TRUE(c.said("Set airspeed 27 m/s"));
}

TEST(SmallPlane, IsInTheAirOnItsTakeOffRun) {
  EmulatorConfig config = small_plane();
  config.airborne = false;
  Companion c{config};
  watch(c);
  EXPECT_EQ(c.stream(mavlink::ExtendedSysState::kDefinition.id, 20.0),
            mavlink::CommandResult::accepted);
  c.run(0.5);
  const auto landed = [&] { return c.last<mavlink::ExtendedSysState>()->landed_state; };
  EXPECT_EQ(landed(), static_cast<std::uint8_t>(mavlink::LandedState::on_ground));
  EXPECT_EQ(c.mode(13), mavlink::CommandResult::accepted);
  EXPECT_EQ(c.command(mavlink::Command::component_arm_disarm, 1.0F),
            mavlink::CommandResult::accepted);
  EXPECT_TRUE(c.run_until(
      [&] { return landed() == static_cast<std::uint8_t>(mavlink::LandedState::in_air); }, 20.0));
  EXPECT_LT(c.last<mavlink::VfrHud>()->alt, 480.5F);
}

TEST(SmallPlane, TakesOff) {
  EmulatorConfig config = small_plane();
  config.airborne = false;
  Companion companion{config};
  companion.run(1.0);
  EXPECT_EQ(companion.mode(13), mavlink::CommandResult::accepted);
  EXPECT_EQ(companion.command(mavlink::Command::component_arm_disarm, 1.0F),
            mavlink::CommandResult::accepted);
  EXPECT_TRUE(companion.run_until(
      [&] { return companion.last<mavlink::VfrHud>().value().alt > 535.0F; }, 60.0));
}

}  // namespace
}  // namespace skein::hil
