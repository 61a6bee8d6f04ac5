// SPDX-License-Identifier: Apache-2.0
#include "skein/autopilot/fixed_wing_loops.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "flight_test.hpp"
#include "skein/autopilot/guidance.hpp"
#include "skein/base/angles.hpp"

namespace skein::autopilot {
namespace {

constexpr double kGain = 1.2;

class Worst {
 public:
  void take(double value) {
    worst_ = std::max(worst_, std::abs(value));
    sum_ += value * value;
    ++count_;
  }
  [[nodiscard]] double worst() const { return worst_; }
  [[nodiscard]] double rms() const { return std::sqrt(sum_ / count_); }

 private:
  double worst_ = 0.0;
  double sum_ = 0.0;
  int count_ = 0;
};

TEST(FixedWingLoops, HoldsCourseAirspeedAndHeightInWindWithGusts) {
  for (const double airspeed : {50.0, 60.0}) {
    for (const double from_rad : {0.0, 1.6, 4.0}) {
      TestFlight flight{{.airspeed_mps = airspeed,
                         .heading_rad = 0.7,
                         .wind_mps = {5.0 * std::cos(from_rad), 5.0 * std::sin(from_rad), 0.0},
                         .gusts_wind_mps = 5.0,
                         .seed = 17,
                         .noise = true}};
      FixedWingLoops loops{{}};
      Worst course;
      Worst speed;
      Worst height;
      while (flight.seconds() < 130.0) {
        const Estimate e = flight.estimate();
        flight.advance(loops.fly(e,
                                 {.lateral_mps2 = steer_to_course(e, 0.7, kGain),
                                  .height_m = 300.0,
                                  .airspeed_mps = airspeed},
                                 TestFlight::kControl_s));
        if (flight.seconds() < 10.0) continue;
        course.take(wrap_pi(flight.course_rad() - 0.7));
        speed.take(flight.airspeed_mps() - airspeed);
        height.take(flight.height_m() - 300.0);
      }
      EXPECT_LT(degrees(course.worst()), 0.5) << airspeed << " " << from_rad;
      EXPECT_LT(speed.worst(), 1.0) << airspeed << " " << from_rad << " rms " << speed.rms();
      EXPECT_LT(height.worst(), 3.0) << airspeed << " " << from_rad;
    }
  }
}

TEST(FixedWingLoops, FliesTheMissionsCircleInWindWithGusts) {
  struct Case {
    double airspeed_mps;
    double turn_radius_m;
  };
  for (const Case& c : {Case{50.0, 150.0}, Case{60.0, 200.0}}) {
    for (const bool clockwise : {true, false}) {
      const Orbit orbit{
          .centre_m = {0.0, 0.0}, .radius_m = 1.1 * c.turn_radius_m, .clockwise = clockwise};
      TestFlight flight{{.airspeed_mps = c.airspeed_mps,
                         .wind_mps = {3.0, -4.0, 0.0},
                         .gusts_wind_mps = 5.0,
                         .seed = 5,
                         .noise = true}};
      FixedWingLoops loops{{}};
      Worst off;
      Worst height;
      while (flight.seconds() < 120.0) {
        const Estimate e = flight.estimate();
        flight.advance(loops.fly(e,
                                 {.lateral_mps2 = steer_to_orbit(e, orbit, kGain),
                                  .height_m = 300.0,
                                  .airspeed_mps = c.airspeed_mps},
                                 TestFlight::kControl_s));
        if (flight.seconds() < 30.0) continue;
        off.take(flight.plane().state().position_m.head<2>().norm() - orbit.radius_m);
        height.take(flight.height_m() - 300.0);
      }
      EXPECT_LT(off.worst(), 5.0) << c.airspeed_mps << " " << clockwise << " rms " << off.rms();
      EXPECT_LT(height.worst(), 5.0) << c.airspeed_mps << " " << clockwise;
    }
  }
}

TEST(FixedWingLoops, TurnsAsFastAsTheMissionsPlan) {
  // 90 degrees to the right at 50 m/s: the planar model of the missions (radius 150 m) takes 4.7 s
  // and the decay of its last degrees.
  TestFlight flight{{.airspeed_mps = 50.0}};
  FixedWingLoops loops{{}};
  double settled = 0.0;
  while (flight.seconds() < 20.0) {
    const Estimate e = flight.estimate();
    flight.advance(loops.fly(e,
                             {.lateral_mps2 = steer_to_heading(e, kPi / 2, kGain),
                              .height_m = 300.0,
                              .airspeed_mps = 50.0},
                             TestFlight::kControl_s));
    const double yaw = euler_angles(flight.plane().state().attitude).yaw_rad;
    EXPECT_LT(degrees(yaw), 95.0);
    if (std::abs(wrap_pi(yaw - kPi / 2)) > radians(3.0)) settled = flight.seconds();
    EXPECT_NEAR(flight.height_m(), 300.0, 8.0);
    EXPECT_NEAR(flight.airspeed_mps(), 50.0, 3.0);
  }
  EXPECT_LT(settled, 8.0);
}

TEST(FixedWingLoops, ClimbsAndDescends) {
  for (const double change : {100.0, -100.0}) {
    TestFlight flight{{.airspeed_mps = 50.0}};
    FixedWingLoops loops{{}};
    double reached = 0.0;
    while (flight.seconds() < 60.0) {
      const Estimate e = flight.estimate();
      flight.advance(loops.fly(e,
                               {.lateral_mps2 = steer_to_course(e, 0.0, kGain),
                                .height_m = 300.0 + change,
                                .airspeed_mps = 50.0},
                               TestFlight::kControl_s));
      if (std::abs(flight.height_m() - 300.0 - change) > 5.0) reached = flight.seconds();
      EXPECT_NEAR(flight.airspeed_mps(), 50.0, 3.0);
    }
    EXPECT_LT(reached, 100.0 / 8.0 + 15.0);
    EXPECT_NEAR(flight.height_m(), 300.0 + change, 2.0);
  }
}

TEST(FixedWingLoops, FollowsAnAirspeed) {
  TestFlight flight{{.airspeed_mps = 50.0}};
  FixedWingLoops loops{{}};
  double reached = 0.0;
  while (flight.seconds() < 40.0) {
    const Estimate e = flight.estimate();
    flight.advance(loops.fly(e, {.height_m = 300.0, .airspeed_mps = 57.5}, TestFlight::kControl_s));
    if (std::abs(flight.airspeed_mps() - 57.5) > 0.75) reached = flight.seconds();
    EXPECT_NEAR(flight.height_m(), 300.0, 5.0);
  }
  EXPECT_LT(reached, 10.0);
  EXPECT_NEAR(flight.airspeed_mps(), 57.5, 0.3);
}

TEST(FixedWingLoops, FollowsALine) {
  TestFlight flight{{.airspeed_mps = 50.0, .wind_mps = {0.0, 5.0, 0.0}}};
  FixedWingLoops loops{{}};
  const Vec2 from{0.0, 150.0};
  const Vec2 to{5000.0, 150.0};
  while (flight.seconds() < 40.0) {
    const Estimate e = flight.estimate();
    flight.advance(loops.fly(e,
                             {.lateral_mps2 = steer_to_line(e, from, to, kGain),
                              .height_m = 300.0,
                              .airspeed_mps = 50.0},
                             TestFlight::kControl_s));
    EXPECT_LT(flight.plane().state().position_m.y(), 160.0);
  }
  EXPECT_NEAR(flight.plane().state().position_m.y(), 150.0, 2.0);
  EXPECT_NEAR(progress_on_line(flight.estimate(), from, to), 0.4, 0.05);
}

TEST(FixedWingLoops, LimitsBankPitchAndSurfaces) {
  const FixedWingLoops loops{{}};
  EXPECT_NEAR(loops.bank_for(kGravity_mps2), kPi / 4, 1e-12);
  EXPECT_NEAR(loops.bank_for(-1000.0), -loops.tuning().roll_max_rad, 1e-12);
  FixedWingLoops wild{{}};
  Estimate e;
  e.airspeed_mps = 50.0;
  e.rates_radps = {20.0, -20.0, 20.0};
  for (int i = 0; i < 1000; ++i) {
    const SurfaceCommand c = wild.hold_attitude(e, -3.0, 2.0, 7.0, 0.01);
    EXPECT_LE(std::abs(c.aileron_rad), 0.436);
    EXPECT_LE(std::abs(c.elevator_rad), 0.436);
    EXPECT_LE(std::abs(c.rudder_rad), 0.436);
    EXPECT_EQ(c.throttle, 1.0);
  }
  EXPECT_NEAR(wild.pitch_demand_rad(), wild.tuning().pitch_max_rad, 1e-12);
}

}  // namespace
}  // namespace skein::autopilot
