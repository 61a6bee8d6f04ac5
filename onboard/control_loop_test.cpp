// SPDX-License-Identifier: Apache-2.0
#include "skein/onboard/control_loop.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <mutex>
#include <vector>

#include "counted_calls.hpp"
#include "skein/hal/simulated_flight_controller.hpp"

namespace skein::onboard {
namespace {

VehicleSpec vehicle() {
  VehicleSpec spec;
  spec.id = {1};
  spec.cruise_speed_mps = 50.0;
  spec.speed_min_mps = 40.0;
  spec.speed_max_mps = 60.0;
  spec.turn_radius_m = 100.0;
  spec.heading_gain_per_s = 2.0;
  spec.height_m = 100.0;
  return spec;
}

/// East for 10 s, a quarter turn left, north for 10 s, then circles to the left.
mission::FlightPlan plan(std::uint32_t number) {
  mission::FlightPlan p;
  p.number = number;
  p.timed.speed_mps = 50.0;
  p.timed.tail_curvature_per_m = 1.0 / 110.0;
  EXPECT_TRUE(p.timed.path.append(Segment{0.0, 500.0}));
  EXPECT_TRUE(p.timed.path.append(Segment{1.0 / 110.0, 110.0 * M_PI_2}));
  EXPECT_TRUE(p.timed.path.append(Segment{0.0, 500.0}));
  return p;
}

struct Cockpit {
  hal::SimulatedFlightController flight_controller{vehicle(), Pose2{}, {}};
  ControlPorts ports;
  ControlLoop loop{vehicle(), flight_controller, ports};

  VehicleState fly(double from_s, double until_s) {
    for (int i = 0; from_s + 0.02 * i <= until_s; ++i) loop.step(at_seconds(from_s + 0.02 * i));
    const auto* state = ports.state.read();
    EXPECT_NE(state, nullptr);
    return state == nullptr ? VehicleState{} : *state;
  }
};

TEST(ControlLoop, FollowsTheNewestPlan) {
  Cockpit cockpit;
  EXPECT_EQ(cockpit.ports.airborne.load(), hal::Airborne::unknown);
  cockpit.ports.guidance.write(plan(1));
  const auto state = cockpit.fly(0.0, 20.0);
  const Pose2 wanted = plan(1).timed.pose_at(state.time);
  EXPECT_LT((state.pose().position() - wanted.position()).norm(), 10.0);
  EXPECT_EQ(cockpit.ports.airborne.load(), hal::Airborne::yes);
}

TEST(ControlLoop, FliesTheHoldWhenTheAgentFallsSilent) {
  Cockpit cockpit;
  cockpit.ports.guidance.write(plan(1));
  const Instant end = plan(1).timed.end_time();
  const auto state = cockpit.fly(0.0, to_seconds(end) + 120.0);
  const Vec2 centre = plan(1).timed.path.end().position() + Vec2{-110.0, 0.0};
  EXPECT_NEAR((state.pose().position() - centre).norm(), 110.0, 15.0);
}

TEST(ControlLoop, WithoutAPlanItCommandsNothing) {
  Cockpit cockpit;
  const auto state = cockpit.fly(0.0, 5.0);
  EXPECT_NEAR(state.x_m, 250.0, 1e-3);  // the flight controller's own straight flight
  EXPECT_FALSE(cockpit.ports.plans.pop());
}

TEST(ControlLoop, StepNeitherAllocatesNorLocks) {
  if (!counted_calls::available()) GTEST_SKIP() << "a sanitizer stands in for what is counted";
  Cockpit cockpit;
  const auto first = plan(1);
  const auto second = plan(2);
  cockpit.loop.step(at_seconds(-0.1));
  // The counters count: this is what a violation would look like.
  counted_calls::reset();
  {
    std::mutex mutex;
    const std::lock_guard lock{mutex};
    int* volatile made = new int{1};  // volatile: or the compiler leaves both calls out
    delete made;
  }
  EXPECT_GT(counted_calls::allocations(), 0);
  EXPECT_GT(counted_calls::locks(), 0);

  counted_calls::reset();
  for (int i = 0; i < 5000; ++i) {
    if (i == 10) cockpit.ports.guidance.write(first);
    if (i == 700) cockpit.ports.guidance.write(second);
    cockpit.loop.step(at_seconds(0.02 * i));
  }
  EXPECT_EQ(counted_calls::allocations(), 0);
  EXPECT_EQ(counted_calls::locks(), 0);
  EXPECT_EQ(cockpit.ports.periods, 5001U);
  EXPECT_GT(cockpit.ports.track.dropped(), 0U);  // nobody reads: refused, not waited for
}

TEST(ControlLoop, RecordsTwentyStatesASecondAndEveryPlanOnce) {
  Cockpit cockpit;
  for (int i = -50; i < 0; ++i) cockpit.loop.step(at_seconds(0.02 * i));
  EXPECT_FALSE(cockpit.ports.track.pop());  // before mission time 0
  for (int i = 0; i < 500; ++i) {
    if (i == 100) cockpit.ports.guidance.write(plan(7));
    cockpit.loop.step(at_seconds(0.02 * i));
  }
  int samples = 0;
  while (const auto point = cockpit.ports.track.pop()) {
    EXPECT_EQ(point->plan_number, point->state.time < at_seconds(2.0) ? 0U : 7U);
    ++samples;
  }
  EXPECT_NEAR(samples, 200, 1);
  const auto record = cockpit.ports.plans.pop();
  ASSERT_TRUE(record);
  EXPECT_EQ(record->number, 7U);
  EXPECT_EQ(record->since, at_seconds(2.0));
  EXPECT_FALSE(cockpit.ports.plans.pop());
}

class SilentFlightController final : public hal::FlightController {
 public:
  std::optional<VehicleState> state(Instant) override { return last; }
  void command(const Demand&, Instant) override { ++commands; }
  std::optional<VehicleState> last;
  int commands = 0;
};

TEST(ControlLoop, RecordsAStateThatIsToldAgainOnce) {
  SilentFlightController flight_controller;
  ControlPorts ports;
  ControlLoop loop{vehicle(), flight_controller, ports};
  flight_controller.last = VehicleState{};
  flight_controller.last->time = at_seconds(1.0);
  for (const double now : {1.0, 1.1, 1.2}) loop.step(at_seconds(now));
  flight_controller.last->time = at_seconds(1.3);
  loop.step(at_seconds(1.3));
  std::vector<Instant> times;
  while (const auto point = ports.track.pop()) times.push_back(point->state.time);
  EXPECT_EQ(times, (std::vector{at_seconds(1.0), at_seconds(1.3)}));
}

TEST(ControlLoop, LeavesASilentFlightControllerToItsFailsafe) {
  SilentFlightController flight_controller;
  ControlPorts ports;
  ControlLoop loop{vehicle(), flight_controller, ports};
  ports.guidance.write(plan(1));
  loop.step(at_seconds(0.0));  // nothing heard yet
  EXPECT_EQ(flight_controller.commands, 0);
  flight_controller.last =
      VehicleState{.time = at_seconds(0.0), .groundspeed_mps = 50.0, .airspeed_mps = 50.0};
  loop.step(at_seconds(0.4));
  EXPECT_EQ(flight_controller.commands, 1);
  loop.step(at_seconds(0.6));
  EXPECT_EQ(flight_controller.commands, 1);
  EXPECT_EQ(ports.stale_states, 2U);
}

TEST(PeriodicSchedule, CountsThePeriodsThatPassedUnserved) {
  constexpr Duration kPeriod = std::chrono::milliseconds{20};
  PeriodicSchedule schedule{at_seconds(1.0), kPeriod};
  EXPECT_EQ(schedule.advance(at_seconds(1.001)), 0U);
  EXPECT_EQ(schedule.next(), at_seconds(1.02));
  EXPECT_EQ(schedule.advance(at_seconds(1.045)), 0U);  // late, but still in the next one
  EXPECT_EQ(schedule.next(), at_seconds(1.04));
  EXPECT_EQ(schedule.advance(at_seconds(1.101)), 2U);
  EXPECT_EQ(schedule.next(), at_seconds(1.1));
}

}  // namespace
}  // namespace skein::onboard
