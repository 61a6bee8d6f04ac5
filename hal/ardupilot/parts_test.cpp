// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "boot_clock.hpp"
#include "command_desk.hpp"
#include "skein/ardupilot/airframe.hpp"
#include "skein/ardupilot/motion.hpp"
#include "skein/base/angles.hpp"
#include "skein/base/atmosphere.hpp"
#include "skein/base/attitude.hpp"
#include "skein/base/random.hpp"
#include "steady_error.hpp"
#include "steering.hpp"

namespace skein::ardupilot {
namespace {

using mavlink::Command;
using std::chrono::milliseconds;
using std::chrono::seconds;

mavlink::CommandLong command(Command c, float p1 = 0.0F) {
  mavlink::CommandLong l;
  l.command = static_cast<std::uint16_t>(c);
  l.param1 = p1;
  return l;
}

TEST(BootClock, FindsTheOffsetThroughADelayThatVaries) {
  Random random{3};
  BootClock clock;
  const Instant zero = at_seconds(-73.25);
  EXPECT_FALSE(clock.mission_time(seconds{80}, at_seconds(7.0)));
  Instant now = at_seconds(0.0);
  for (int i = 0; i < 60; ++i) {
    const Duration there = from_seconds(random.uniform(0.002, 0.060));
    const Duration back = from_seconds(random.uniform(0.002, 0.060));
    clock.on_round_trip(now, now + there + back, now + there - zero);
    now += seconds{1};
  }
  const auto mapped = clock.mission_time(seconds{100}, at_seconds(100.0));
  ASSERT_TRUE(mapped);
  EXPECT_LT(std::abs(to_seconds(*mapped - (zero + seconds{100}))), 0.010);
  EXPECT_LT(clock.uncertainty(now), milliseconds{20});
}

TEST(BootClock, TakesArrivalForMeasurementUntilItKnowsBetter) {
  BootClock clock;
  clock.on_arrival(at_seconds(10.0), seconds{5});
  EXPECT_EQ(clock.mission_time(seconds{5}, at_seconds(10.0)), at_seconds(10.0));
  clock.on_arrival(at_seconds(11.2), seconds{6});  // this one was delayed
  EXPECT_EQ(clock.mission_time(seconds{6}, at_seconds(11.2)), at_seconds(11.0));
  clock.restart();
  EXPECT_FALSE(clock.mission_time(seconds{6}, at_seconds(11.2)));
}

TEST(BootClock, NeverSaysThatAMessageCameBeforeItWasMeasured) {
  BootClock clock;
  clock.on_round_trip(at_seconds(1.0), at_seconds(1.1), seconds{5});
  EXPECT_EQ(clock.mission_time(seconds{6}, at_seconds(2.0)), at_seconds(2.0));
}

TEST(BootClock, BeginsAnewWhereTwoRoundTripsContradict) {
  BootClock clock;
  const auto answer = [&clock](double at, Duration boot) {
    clock.on_round_trip(at_seconds(at), at_seconds(at + 0.01), boot + milliseconds{5});
  };
  answer(1.0, std::chrono::hours{700});  // whoever said that
  EXPECT_TRUE(clock.synchronised());
  answer(2.0, seconds{6});
  EXPECT_FALSE(clock.synchronised());
  answer(3.0, seconds{7});
  EXPECT_EQ(clock.mission_time(seconds{7}, at_seconds(10.0)), at_seconds(3.0));
  answer(4.0, seconds{8});
  EXPECT_TRUE(clock.synchronised());
}

TEST(CommandDesk, HasOneOfAKindUnderWayAndRepeatsIt) {
  CommandDesk desk;
  const Instant t{};
  desk.ask(command(Command::set_message_interval, 30.0F), {2, milliseconds{300}}, false);
  desk.ask(command(Command::set_message_interval, 33.0F), {2, milliseconds{300}}, false);
  desk.ask(command(Command::do_set_mode, 1.0F), {1, milliseconds{300}}, true);
  ASSERT_EQ(desk.next(t)->param1, 30.0F);
  ASSERT_EQ(desk.next(t)->param1, 1.0F);
  EXPECT_FALSE(desk.next(t));
  const auto again = desk.next(t + milliseconds{300});
  ASSERT_TRUE(again);
  EXPECT_EQ(again->param1, 30.0F);
  EXPECT_EQ(again->confirmation, 1);
  mavlink::CommandAck ack;
  ack.command = static_cast<std::uint16_t>(Command::set_message_interval);
  const auto first = desk.on_ack(ack);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->command.param1, 30.0F);
  EXPECT_EQ(first->answer, Answer::accepted);
  EXPECT_EQ(desk.next(t + milliseconds{300})->param1, 33.0F);
  const auto given_up = desk.give_up(t + milliseconds{301});
  ASSERT_TRUE(given_up);
  EXPECT_EQ(given_up->answer, Answer::unanswered);
  EXPECT_EQ(given_up->command.command, static_cast<std::uint16_t>(Command::do_set_mode));
  EXPECT_FALSE(desk.give_up(t + milliseconds{302}));
}

TEST(CommandDesk, KeepsOnlyTheNewestWhereThatIsAllThatMatters) {
  CommandDesk desk;
  desk.ask(command(Command::do_change_speed, 50.0F), {}, true);
  ASSERT_EQ(desk.next(Instant{})->param1, 50.0F);
  desk.ask(command(Command::do_change_speed, 51.0F), {}, true);
  desk.ask(command(Command::do_change_speed, 52.0F), {}, true);
  mavlink::CommandAck ack;
  ack.command = static_cast<std::uint16_t>(Command::do_change_speed);
  ack.result = 2;
  EXPECT_EQ(desk.on_ack(ack)->answer, Answer::refused);
  EXPECT_EQ(desk.next(Instant{})->param1, 52.0F);
  ASSERT_TRUE(desk.on_ack(ack));
  EXPECT_TRUE(desk.idle());
}

TEST(CommandDesk, WaitsOnWhileACommandIsInProgressAndIgnoresAnswersToOthers) {
  CommandDesk desk;
  desk.ask(command(Command::component_arm_disarm), {}, true);
  mavlink::CommandAck ack;
  ack.command = static_cast<std::uint16_t>(Command::component_arm_disarm);
  EXPECT_FALSE(desk.on_ack(ack));  // not even sent
  ASSERT_TRUE(desk.next(Instant{}));
  ack.result = 5;
  EXPECT_FALSE(desk.on_ack(ack));
  EXPECT_TRUE(desk.asks(Command::component_arm_disarm));
  ack.command = 999;
  EXPECT_FALSE(desk.on_ack(ack));
}

TEST(CarriedTo, GoesOnAlongTheArcAndNoFurtherThanItMay) {
  MotionSample sample;
  sample.state = {.time = at_seconds(10.0),
                  .x_m = 5.0,
                  .y_m = 0.0,
                  .z_m = 100.0,
                  .heading_rad = 0.0,
                  .course_rad = 0.0,
                  .groundspeed_mps = 50.0,
                  .airspeed_mps = 48.0,
                  .distance_flown_m = 1000.0};
  sample.turn_rate_radps = 0.5;
  sample.state.climb_mps = 2.0;
  const auto state = carried_to(sample, at_seconds(10.2));
  EXPECT_EQ(state.time, at_seconds(10.2));
  const double radius = 50.0 / 0.5;
  EXPECT_NEAR(state.x_m, 5.0 + radius * std::sin(0.1), 0.01);
  EXPECT_NEAR(state.y_m, radius * (1.0 - std::cos(0.1)), 0.01);
  EXPECT_NEAR(state.z_m, 100.4, 1e-9);
  EXPECT_NEAR(state.course_rad, 0.1, 1e-9);
  EXPECT_NEAR(state.distance_flown_m, 1010.0, 1e-6);
  EXPECT_EQ(carried_to(sample, at_seconds(20.0)).time, at_seconds(10.25));
  EXPECT_EQ(carried_to(sample, at_seconds(9.0)).time, at_seconds(10.0));
}

struct Heard {
  Motion motion{MissionOrigin::make({31.0, 105.0, 0.0}).value(), 0.0, false};
  void position(double at, double east_deg = 0.0) {
    mavlink::GlobalPositionInt p;
    p.lat = 310'000'000;
    p.lon = 1'050'000'000 + static_cast<std::int32_t>(std::lround(1e7 * east_deg));
    p.vy = 5000;  // east, 50 m/s
    motion.on_position(p, at_seconds(at));
  }
  void attitude(double at) {
    mavlink::Attitude a;
    a.yaw = static_cast<float>(kPi / 2.0);
    a.yawspeed = -0.3F;
    motion.on_attitude(a, at_seconds(at));
  }
  void airspeed(double at) {
    mavlink::VfrHud hud;
    hud.airspeed = 50.0F;
    motion.on_hud(hud, at_seconds(at));
  }
};

TEST(Motion, IsAsOldAsTheOldestOfItsParts) {
  Heard heard;
  heard.airspeed(10.0);
  heard.attitude(9.98);
  heard.position(10.0);
  auto sample = heard.motion.sample();
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->state.time, at_seconds(9.98));
  // Where it was then; carried on, it is where it was measured.
  EXPECT_NEAR(sample->state.x_m, -1.0, 0.01);
  const VehicleState at_position = carried_to(*sample, at_seconds(10.0));
  EXPECT_NEAR(at_position.x_m, 0.0, 1e-3);
  EXPECT_NEAR(at_position.y_m, 0.0, 1e-3);
  EXPECT_NEAR(at_position.heading_rad, 0.3 * 0.02, 1e-6);
  // An attitude that comes no more.
  heard.position(11.0);
  EXPECT_EQ(heard.motion.sample()->state.time, at_seconds(9.98));
  heard.attitude(11.0);
  EXPECT_EQ(heard.motion.sample()->state.time, at_seconds(11.0));
  // An airspeed that comes no more.
  heard.attitude(11.5);
  heard.position(11.5);
  EXPECT_EQ(heard.motion.sample()->state.time, at_seconds(10.0));
}

TEST(Motion, KnowsWhereACopterDriftsThoughNotWhereItIsHeaded) {
  Motion motion{MissionOrigin::make({31.0, 105.0, 0.0}).value(), 0.0, true};
  mavlink::Attitude attitude;
  attitude.yaw = 0.0F;  // north
  motion.on_attitude(attitude, at_seconds(10.0));
  motion.on_hud({}, at_seconds(10.0));
  mavlink::GlobalPositionInt p;
  p.lat = 310'000'000;
  p.lon = 1'050'000'000;
  p.vx = -50;  // south
  p.vz = -80;  // up
  motion.on_position(p, at_seconds(10.0));
  VehicleState state = motion.sample()->state;
  EXPECT_NEAR(state.heading_rad, kPi / 2.0, 1e-6);
  EXPECT_LT((state.velocity_mps() - Eigen::Vector3d{0.0, -0.5, 0.8}).norm(), 1e-9);
  p.vx = -300;
  motion.on_position(p, at_seconds(10.1));
  state = motion.sample()->state;
  EXPECT_NEAR(state.heading_rad, -kPi / 2.0, 1e-6);
  EXPECT_NEAR(carried_to(*motion.sample(), at_seconds(10.2)).z_m - state.z_m, 0.08, 1e-9);
}

TEST(Motion, KnowsNotWhereItIsBeforeTheAutopilotDoes) {
  Motion motion{MissionOrigin::make({31.0, 105.0, 0.0}).value(), 0.0, true};
  motion.on_attitude({}, at_seconds(10.0));
  motion.on_hud({}, at_seconds(10.0));
  mavlink::GlobalPositionInt p;  // 0, 0
  p.alt = 480'000;
  motion.on_position(p, at_seconds(10.0));
  EXPECT_FALSE(motion.sample());
}

TEST(Motion, TakesNothingThatIsNoNumber) {
  Heard heard;
  heard.airspeed(10.0);
  heard.position(10.0);
  mavlink::Attitude a;
  a.yawspeed = std::numeric_limits<float>::quiet_NaN();
  heard.motion.on_attitude(a, at_seconds(10.0));
  EXPECT_FALSE(heard.motion.sample());
}

TEST(Motion, HasTheTrueAirspeed) {
  Heard heard;
  heard.airspeed(10.0);
  heard.attitude(10.0);
  mavlink::GlobalPositionInt p;
  p.lat = 310'000'000;
  p.lon = 1'050'000'000;
  p.alt = 3'000'000;
  heard.motion.on_position(p, at_seconds(10.0));
  const auto sample = heard.motion.sample();
  ASSERT_TRUE(sample);
  EXPECT_NEAR(sample->state.airspeed_mps, 50.0 * std::sqrt(1.2250 / 0.9093), 0.01);
  EXPECT_EQ(sample->true_per_equivalent, true_per_equivalent_airspeed(3000.0));
}

/// An aircraft that turns at `share` of a coordinated turn's rate, in wind, its nose swinging about
/// where it moves through the air and standing out of the turn.
struct Turning {
  double share = 0.73;
  Vec2 wind_mps{0.0, 0.0};
  Motion motion{MissionOrigin::make({31.0, 105.0, 0.0}).value(), 0.0, false};
  double heading_rad = 0.0;  ///< where it moves through the air
  double bank_rad = 0.0;
  double time_s = 1.0;
  static constexpr double kAirspeed_mps = 25.0;

  void tell() {
    const Instant now = at_seconds(time_s);
    mavlink::Attitude a;
    const double nose =
        heading_rad + radians(8.0) * std::sin(3.0 * time_s) + radians(4.0) * std::tan(bank_rad);
    a.yaw = static_cast<float>(heading_from_yaw(nose));  // the rule is its own inverse
    a.roll = static_cast<float>(bank_rad);
    motion.on_attitude(a, now);
    mavlink::VfrHud hud;
    hud.airspeed = static_cast<float>(kAirspeed_mps);
    motion.on_hud(hud, now);
    const Vec2 over_ground = kAirspeed_mps * unit_vector(heading_rad) + wind_mps;
    mavlink::GlobalPositionInt p;
    p.lat = 310'000'000;
    p.lon = 1'050'000'000;
    p.vx = static_cast<std::int16_t>(std::lround(100.0 * over_ground.y()));
    p.vy = static_cast<std::int16_t>(std::lround(100.0 * over_ground.x()));
    motion.on_position(p, now);
  }
  [[nodiscard]] double rate_radps() const {
    return -share * kGravity_mps2 * std::tan(bank_rad) / kAirspeed_mps;
  }
  void fly(double seconds_flown, double wanted_radps) {
    VehicleSpec spec;
    spec.turn_radius_m = 50.0;
    spec.speed_min_mps = 20.0;
    for (const double end_s = time_s + seconds_flown; time_s < end_s; time_s += 0.04) {
      tell();
      const auto sample = motion.sample();
      const Setpoint ahead{.heading_rad = sample->state.heading_rad + wanted_radps};
      bank_rad += 0.15 * (bank_for(spec, ahead, sample->state, sample->turn_ability) - bank_rad);
      heading_rad = wrap_pi(heading_rad + 0.04 * rate_radps());
    }
  }
};

TEST(TurnAbility, BanksSlippingAircraftUntilTheyTurnAsTheyShall) {
  for (const double share : {0.6, 0.73, 1.0}) {
    for (const double rate : {0.3, -0.3, 0.15}) {
      Turning turning{.share = share, .wind_mps = {6.0, -3.0}};
      turning.fly(30.0, rate);
      EXPECT_NEAR(turning.rate_radps(), rate, 0.03 * std::abs(rate)) << share;
      EXPECT_NEAR(turning.motion.sample()->turn_rate_radps, rate, 0.03 * std::abs(rate)) << share;
    }
  }
}

TEST(TurnAbility, KeepsFromTurnToTurnWhatItHasLearned) {
  Turning turning;
  turning.fly(10.0, 0.3);
  const double learned = turning.motion.sample()->turn_ability;
  EXPECT_NEAR(learned, 0.73, 0.03);
  turning.fly(60.0, 0.0);
  EXPECT_NEAR(turning.motion.sample()->turn_ability, learned, 0.02);
}

TEST(TurnAbility, LearnsFromNothingThatIsNoTurn) {
  TurnAbility ability;
  for (int i = 1; i < 500; ++i) ability.on_measurement(at_seconds(0.04 * i), 5.0, 0.1);
  for (int i = 500; i < 1000; ++i) ability.on_measurement(at_seconds(0.04 * i), 5.0, 1.5);
  ability.on_measurement(at_seconds(100.0), 5.0, std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(ability.share(), 1.0);
  for (int i = 0; i < 100; ++i) ability.on_measurement(at_seconds(50.0), 5.0, 0.7);
  EXPECT_EQ(ability.share(), 1.0);  // one measurement, told again
  for (int i = 0; i < 500; ++i) ability.on_measurement(at_seconds(60.0 + 0.04 * i), -5.0, 0.7);
  EXPECT_EQ(ability.share(), TurnAbility::kLeast);  // it turns against its bank
}

TEST(Motion, KnowsTheWindAndWhereAFixedWingMovesThroughIt) {
  Turning turning{.wind_mps = {6.0, -3.0}};
  turning.fly(60.0, 0.3);
  for (int i = 0; i < 50; ++i) {
    turning.fly(0.3, 0.3);
    turning.tell();
    const VehicleState state = turning.motion.sample()->state;
    EXPECT_NEAR(wrap_pi(state.heading_rad - turning.heading_rad), 0.0, radians(2.0));
    const Vec2 wind = state.groundspeed_mps * unit_vector(state.course_rad) -
                      state.airspeed_mps * unit_vector(state.heading_rad);
    EXPECT_LE((wind - turning.wind_mps).norm(), 1.0);
  }
}

TEST(SteadyError, GoesAwayAndStaysWithinItsLimit) {
  SteadyError error{{.time_s = 8.0, .most = 5.0, .small_enough = 4.0}};
  // An autopilot that flies 3 m below what it is told, three seconds late.
  double height = 97.0;
  double told = 100.0;
  for (int i = 0; i < 1500; ++i) {
    told = 100.0 + error.step(100.0 - height, 0.04);
    height += 0.04 / 3.0 * (told - 3.0 - height);
  }
  EXPECT_NEAR(height, 100.0, 0.1);
  for (int i = 0; i < 1000; ++i) told = error.step(3.0, 0.04);
  EXPECT_EQ(told, 5.0);
  EXPECT_EQ(error.step(-20.0, 0.04), 5.0);  // on the way to another height
  error.reset();
  EXPECT_EQ(error.step(0.0, 0.04), 0.0);
}

TEST(Airframes, HaveTheirModesAndTypes) {
  const AirframeTraits& plane = traits_of(Airframe::plane);
  const AirframeTraits& copter = traits_of(Airframe::copter);
  const AirframeTraits& quadplane = traits_of(Airframe::quadplane);
  EXPECT_EQ(plane.guided_mode, 15U);
  EXPECT_EQ(copter.guided_mode, 4U);
  EXPECT_EQ(copter.name_of(4), "GUIDED");
  EXPECT_EQ(plane.name_of(4), "ACRO");
  EXPECT_EQ(plane.name_of(77), "mode 77");
  EXPECT_EQ(quadplane.name_of(21), "QRTL");
  EXPECT_TRUE(quadplane.is_return(21));
  EXPECT_TRUE(quadplane.is_return(11));
  EXPECT_FALSE(plane.is_return(21));
  EXPECT_TRUE(plane.is_of(1));
  EXPECT_FALSE(plane.is_of(13));
  EXPECT_TRUE(copter.is_of(13));
  EXPECT_TRUE(quadplane.is_of(22));
  EXPECT_TRUE(quadplane.is_of(1));
  EXPECT_FALSE(quadplane.is_of(2));
}

}  // namespace
}  // namespace skein::ardupilot
