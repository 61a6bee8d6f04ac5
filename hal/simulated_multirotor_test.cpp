// SPDX-License-Identifier: Apache-2.0
#include "skein/hal/simulated_multirotor.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>

#include "skein/base/angles.hpp"

namespace skein::hal {
namespace {

using std::chrono::milliseconds;

static_assert(std::is_trivially_copyable_v<PositionSetpoint>);
static_assert(std::is_trivially_copyable_v<VehicleState>);

constexpr std::array<std::uint64_t, 6> kSeeds{1, 2, 3, 4, 5, 6};

PositionSetpoint at_rest(double x_m, double y_m, double z_m, double yaw_rad = 0.0) {
  PositionSetpoint s;
  s.x_m = x_m;
  s.y_m = y_m;
  s.z_m = z_m;
  s.yaw_rad = yaw_rad;
  return s;
}

SimulatedMultirotorParams windy(std::uint64_t seed) {
  SimulatedMultirotorParams p;
  p.start = {10.0, -5.0, 0.0};
  p.wind_mps = {-3.2, 2.4};
  p.gust_mps = 1.0;
  p.seed = seed;
  return p;
}

/// Commands it 50 times a second until `until_s`, and looks after each period.
template <class Point, class Look>
void fly(SimulatedMultirotor& fc, double from_s, double until_s, const Point& point,
         const Look& look) {
  const Instant end = at_seconds(until_s);
  for (Instant now = at_seconds(from_s); now < end; now += milliseconds{20}) {
    fc.command(point(to_seconds(now)), now);
    look(*fc.state(now), to_seconds(now));
  }
}
void fly(SimulatedMultirotor& fc, double from_s, double until_s, const PositionSetpoint& place) {
  fly(
      fc, from_s, until_s, [&](double) { return place; }, [](const VehicleState&, double) {});
}

/// A move along x from rest to rest with limited jerk: 20 m at 5 m/s, 2 m/s^2, 4 m/s^3.
PositionSetpoint on_the_move(double seconds, const PositionSetpoint& from) {
  constexpr std::array<std::array<double, 2>, 7> kJerks{
      {{4.0, 0.5}, {0.0, 2.0}, {-4.0, 0.5}, {0.0, 1.0}, {-4.0, 0.5}, {0.0, 2.0}, {4.0, 0.5}}};
  PositionSetpoint s = from;
  for (const auto& [jerk, length] : kJerks) {
    const double dt = std::clamp(seconds, 0.0, length);
    s.x_m += dt * (s.vx_mps + dt * (s.ax_mps2 / 2.0 + dt * jerk / 6.0));
    s.vx_mps += dt * (s.ax_mps2 + dt * jerk / 2.0);
    s.ax_mps2 += dt * jerk;
    seconds -= dt;
  }
  return s;
}

double off(const VehicleState& state, const PositionSetpoint& point) {
  return (state.position().metres() - point.position_m()).norm();
}

TEST(SimulatedMultirotor, RestsUntilTheMissionBeginsAndASetpointLiftsIt) {
  SimulatedMultirotorParams p = windy(1);
  p.start = {10.0, -5.0, 3.0};
  p.yaw_rad = 1.0;
  SimulatedMultirotor fc{p};
  fc.command(at_rest(10.0, -5.0, 13.0), at_seconds(-10.0));
  for (const double s : {-5.0, 0.0, 5.0}) {
    const auto state = fc.state(at_seconds(s));
    ASSERT_TRUE(state);
    EXPECT_EQ(state->time, at_seconds(s));
    EXPECT_NEAR(off(*state, at_rest(10.0, -5.0, 3.0)), 0.0, 1e-12);
    EXPECT_NEAR(state->heading_rad, 1.0, 1e-12);
    EXPECT_NEAR(state->course_rad, 1.0, 1e-12);
    EXPECT_EQ(state->groundspeed_mps, 0.0);
    EXPECT_FALSE(fc.flying());
  }
  fly(fc, 5.0, 8.0, at_rest(10.0, -5.0, 3.0));  // on the ground
  EXPECT_FALSE(fc.flying());
  fly(fc, 8.0, 20.0, at_rest(10.0, -5.0, 13.0, -2.0));
  EXPECT_TRUE(fc.flying());
  EXPECT_LT(off(*fc.state(at_seconds(20.0)), at_rest(10.0, -5.0, 13.0)), 0.5);
  EXPECT_NEAR(wrap_pi(fc.state(at_seconds(20.0))->heading_rad + 2.0), 0.0, 0.1);
}

TEST(SimulatedMultirotor, HoldsItsPlaceInWindWithGusts) {
  for (const std::uint64_t seed : kSeeds) {
    SimulatedMultirotor fc{windy(seed)};
    const PositionSetpoint place = at_rest(10.0, -5.0, 12.0);
    fly(fc, 0.0, 15.0, place);
    double horizontal_m2 = 0.0;
    double vertical_m2 = 0.0;
    double worst_m = 0.0;
    int n = 0;
    fly(
        fc, 15.0, 75.0, [&](double) { return place; },
        [&](const VehicleState& state, double) {
          horizontal_m2 += std::pow(state.x_m - place.x_m, 2) + std::pow(state.y_m - place.y_m, 2);
          vertical_m2 += std::pow(state.z_m - place.z_m, 2);
          worst_m = std::max(worst_m, off(state, place));
          ++n;
        });
    std::printf("seed %d: horizontal %.3f m rms, vertical %.3f m rms, worst %.3f m\n",
                static_cast<int>(seed), std::sqrt(horizontal_m2 / n), std::sqrt(vertical_m2 / n),
                worst_m);
    EXPECT_LT(std::sqrt(horizontal_m2 / n), 0.3);
    EXPECT_LT(std::sqrt(vertical_m2 / n), 0.3);
  }
}

TEST(SimulatedMultirotor, FollowsAMove) {
  for (const std::uint64_t seed : kSeeds) {
    SimulatedMultirotor fc{windy(seed)};
    const PositionSetpoint from = at_rest(10.0, -5.0, 12.0);
    fly(fc, 0.0, 15.0, from);
    double worst_m = 0.0;
    fly(
        fc, 15.0, 25.0, [&](double s) { return on_the_move(s - 15.0, from); },
        [&](const VehicleState& state, double s) {
          worst_m = std::max(worst_m, off(state, on_the_move(s - 15.0, from)));
        });
    std::printf("seed %d: worst %.3f m\n", static_cast<int>(seed), worst_m);
    EXPECT_LT(worst_m, 0.5);
    EXPECT_NEAR(fc.state(at_seconds(25.0))->x_m, 30.0, 0.5);
  }
}

TEST(SimulatedMultirotor, TellsItsMotion) {
  SimulatedMultirotor fc{{}};
  fly(fc, 0.0, 10.0, at_rest(0.0, 0.0, 10.0, 0.5));
  PositionSetpoint course = at_rest(0.0, 0.0, 10.0, 0.5);
  course.vx_mps = -3.0;
  course.vy_mps = 4.0;
  course.vz_mps = 1.0;
  fly(
      fc, 10.0, 20.0, [&](double s) { return course.carried_on(s - 10.0); },
      [](const VehicleState&, double) {});
  const VehicleState state = *fc.state(at_seconds(20.0));
  EXPECT_NEAR(state.groundspeed_mps, 5.0, 0.05);
  EXPECT_NEAR(state.airspeed_mps, std::sqrt(26.0), 0.05);
  EXPECT_NEAR(state.course_rad, std::atan2(4.0, -3.0), 0.02);
  EXPECT_NEAR(state.heading_rad, 0.5, 0.02);
  EXPECT_NEAR(state.climb_mps, 1.0, 0.05);
  EXPECT_LT((state.velocity_mps() - course.velocity_mps()).norm(), 0.1);
  EXPECT_NEAR(state.distance_flown_m, 50.0, 2.0);
  // Between two steps it moves on.
  const VehicleState later = *fc.state(at_seconds(20.0) + milliseconds{1});
  EXPECT_NEAR(later.y_m - state.y_m, 0.004, 1e-4);
}

TEST(SimulatedMultirotor, StaysWhereItsPointComesToRestWhenSetpointsEnd) {
  SimulatedMultirotor fc{windy(3)};
  fly(fc, 0.0, 15.0, at_rest(10.0, -5.0, 12.0));
  const PositionSetpoint from = at_rest(10.0, -5.0, 12.0);
  fly(
      fc, 15.0, 18.02, [&](double s) { return on_the_move(s - 15.0, from); },
      [](const VehicleState&, double) {});
  // It goes on with 5 m/s at 7.5 m for half a second, and then brakes at 2 m/s^2.
  const double rest_x_m = 10.0 + 7.5 + 0.5 * 5.0 + 25.0 / 4.0;
  for (int i = 0; i < 70; ++i) {
    const VehicleState state = *fc.state(at_seconds(25.0 + 0.5 * i));
    EXPECT_NEAR(state.x_m, rest_x_m, 0.6);
    EXPECT_NEAR(state.y_m, -5.0, 0.6);
    EXPECT_NEAR(state.z_m, 12.0, 0.6);
  }
}

TEST(SimulatedMultirotor, LandsWhereItsSetpointIsOnTheGround) {
  SimulatedMultirotor fc{windy(4)};
  fly(fc, 0.0, 15.0, at_rest(14.0, -5.0, 12.0));
  double landed_s = 0.0;
  double sink_mps = 0.0;
  fly(
      fc, 15.0, 40.0, [](double) { return at_rest(14.0, -5.0, -2.0); },
      [&](const VehicleState& state, double s) {
        if (fc.flying() && state.z_m < 0.2) sink_mps = std::max(sink_mps, -state.climb_mps);
        if (fc.flying()) landed_s = s;
      });
  EXPECT_FALSE(fc.flying());
  EXPECT_GT(landed_s, 20.0);
  EXPECT_LT(sink_mps, 0.7);
  const VehicleState state = *fc.state(at_seconds(40.0));
  EXPECT_NEAR(state.x_m, 14.0, 0.3);
  EXPECT_NEAR(state.y_m, -5.0, 0.3);
  EXPECT_NEAR(state.z_m, 0.0, 1e-9);
  EXPECT_EQ(state.groundspeed_mps, 0.0);
  // And up again.
  fly(fc, 40.0, 50.0, at_rest(14.0, -5.0, 8.0));
  EXPECT_LT(off(*fc.state(at_seconds(50.0)), at_rest(14.0, -5.0, 8.0)), 0.5);
}

TEST(SimulatedMultirotor, DoesTheSameHoweverOftenItIsAsked) {
  SimulatedMultirotor often{windy(5)};
  SimulatedMultirotor seldom{windy(5)};
  for (int i = 0; i < 200; ++i) {
    const PositionSetpoint place = at_rest(10.0, -5.0 + 0.1 * i, 8.0);
    const double now_s = 0.1 * i;
    often.command(place, at_seconds(now_s));
    seldom.command(place, at_seconds(now_s));
    for (int k = 1; k < 33; ++k) (void)often.state(at_seconds(now_s + 0.003 * k));
  }
  const VehicleState a = *often.state(at_seconds(20.0));
  const VehicleState b = *seldom.state(at_seconds(20.0));
  EXPECT_EQ(a.x_m, b.x_m);
  EXPECT_EQ(a.y_m, b.y_m);
  EXPECT_EQ(a.z_m, b.z_m);
  EXPECT_EQ(a.distance_flown_m, b.distance_flown_m);
}

TEST(SimulatedMultirotor, KnowsItsPlaceAsWellAsItsNavigation) {
  SimulatedMultirotorParams p;
  p.gnss = models::GnssParams{};
  SimulatedMultirotor fc{p};
  fly(fc, 0.0, 30.0, at_rest(0.0, 0.0, 10.0));
  const VehicleState state = *fc.state(at_seconds(30.0));
  EXPECT_LT(off(state, at_rest(0.0, 0.0, 10.0)), 0.5);
  const double error_m = (state.position() - fc.true_position()).norm();
  EXPECT_GT(error_m, 0.05);
  EXPECT_LT(error_m, 5.0);
}

TEST(SimulatedMultirotor, FliesNothingThatIsNoNumberNorASetpointOfAFixedWing) {
  SimulatedMultirotor fc{{}};
  fly(fc, 0.0, 10.0, at_rest(0.0, 0.0, 10.0));
  PositionSetpoint broken = at_rest(0.0, 0.0, 10.0);
  broken.vy_mps = std::numeric_limits<double>::quiet_NaN();
  fc.command(broken, at_seconds(10.0));
  FlightController& any = fc;
  any.command(Setpoint{.heading_rad = 1.0, .airspeed_mps = 9.0, .height_m = 50.0},
              at_seconds(10.0));
  EXPECT_LT(off(*fc.state(at_seconds(15.0)), at_rest(0.0, 0.0, 10.0)), 0.2);
}

}  // namespace
}  // namespace skein::hal
