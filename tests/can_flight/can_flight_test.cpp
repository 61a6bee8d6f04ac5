// SPDX-License-Identifier: Apache-2.0
//
// The companion against the bench's flight controller, over frames in memory and in virtual time.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "skein/ardupilot/can_link.hpp"
#include "skein/base/angles.hpp"
#include "skein/hil/emulated_flight_controller.hpp"
#include "skein/mission/guidance.hpp"
#include "skein/planning/path_follower.hpp"
#include "skein/wording/wording.hpp"

namespace skein {
namespace {

using ardupilot::Companion;
using State = Companion::State;
using std::chrono::milliseconds;

constexpr Wgs84 kOrigin{31.522062, 105.044327, 480.0};

/// The companion's end of the line.
class LineBus final : public can::Bus {
 public:
  using Bus::send;
  bool send(std::span<const can::Frame> frames) override {
    out.insert(out.end(), frames.begin(), frames.end());
    return true;
  }
  void flush() override {}
  [[nodiscard]] std::size_t pending() const override { return 0; }
  void discard() override {}
  std::optional<can::Frame> receive() override {
    if (in.empty()) return std::nullopt;
    const can::Frame frame = in.front();
    in.pop_front();
    return frame;
  }
  [[nodiscard]] int descriptor() const override { return -1; }
  Result<void> set_filters(std::span<const can::Filter> /*filters*/) override { return {}; }
  [[nodiscard]] can::State state() const override { return can::State::error_active; }
  [[nodiscard]] const can::Statistics& statistics() const override { return statistics_; }
  [[nodiscard]] const std::string& name() const override { return name_; }
  [[nodiscard]] bool fd() const override { return false; }

  std::deque<can::Frame> in;
  std::deque<can::Frame> out;

 private:
  can::Statistics statistics_;
  std::string name_ = "line";
};

VehicleSpec vehicle(double speed_mps = 50.0, double turn_radius_m = 150.0) {
  VehicleSpec v;
  v.id = {1};
  v.cruise_speed_mps = speed_mps;
  v.speed_min_mps = 0.85 * speed_mps;
  v.speed_max_mps = 1.15 * speed_mps;
  v.turn_radius_m = turn_radius_m;
  v.turn_radius_margin = 1.3;
  v.heading_gain_per_s = 1.5;
  v.height_m = 300.0;
  return v;
}

struct Wind {
  double speed_mps = 0.0;
  double gusts_mps = 0.0;  ///< as skein-fc takes them
};

hil::EmulatorConfig emulator(const VehicleSpec& spec, const Wind& wind) {
  hil::EmulatorConfig c;
  c.companion_failsafe = true;
  c.origin = kOrigin;
  c.airborne = true;
  c.mode = "LOITER";
  c.height_m = spec.height_m;
  c.airspeed_mps = spec.cruise_speed_mps;
  c.airspeed_min_mps = spec.speed_min_mps;
  c.airspeed_max_mps = spec.speed_max_mps;
  c.turn_radius_m = spec.turn_radius_m;
  c.wind_mps = -wind.speed_mps * unit_vector(heading_from_compass_deg(240.0));
  c.gusts_wind_mps = wind.gusts_mps;
  c.seed = 5;
  return c;
}

ardupilot::CanLinkParams link_params(const VehicleSpec& spec) {
  ardupilot::CanLinkParams p;
  p.companion.vehicle = spec;
  p.companion.take_over = ardupilot::TakeOver::in_flight;
  return p;
}

/// Processes start before mission time 0, at which the aircraft is let go.
struct Flight {
  explicit Flight(const VehicleSpec& v, const Wind& wind = {})
      : Flight{v, emulator(v, wind), link_params(v)} {}
  Flight(const VehicleSpec& v, const hil::EmulatorConfig& config,
         const ardupilot::CanLinkParams& params)
      : spec{v} {
    auto own = std::make_unique<LineBus>();
    bus = own.get();
    fc = std::make_unique<hil::EmulatedFlightController>(
        hil::EmulatedFlightController::make(config, now).value());
    link = std::make_unique<ardupilot::CanLink>(std::move(own), params,
                                                MissionOrigin::make(kOrigin).value(), now);
  }

  void tick() {
    now += milliseconds{2};
    for (; !bus->out.empty(); bus->out.pop_front()) {
      if (!cut) fc->on_frame(bus->out.front(), now);
    }
    fc->step(now);
    for (auto frames = fc->front(); !frames.empty(); frames = fc->front()) {
      if (!cut) bus->in.insert(bus->in.end(), frames.begin(), frames.end());
      fc->pop();
    }
    if (now >= next_control) {
      next_control += milliseconds{20};
      control();
    }
    link->step(now);
    while (const auto notice = link->companion().poll_notice()) {
      if (notice->warning) last_warning = wording::text_of(notice->what);
    }
  }
  void run_until(double seconds) {
    while (now < at_seconds(seconds)) tick();
  }
  Duration until(State wanted, double limit_s) {
    const Instant begin = now;
    while (state() != wanted && now - begin < from_seconds(limit_s)) tick();
    return now - begin;
  }
  [[nodiscard]] State state() const { return link->companion().state(); }
  [[nodiscard]] VehicleState vehicle_state() const {
    return ardupilot::carried_to(*link->companion().sample(), now);
  }

  VehicleSpec spec;
  Instant now = at_seconds(-8.0);
  Instant next_control = now;
  LineBus* bus = nullptr;
  bool cut = false;
  std::unique_ptr<hil::EmulatedFlightController> fc;
  std::unique_ptr<ardupilot::CanLink> link;
  std::optional<TimedPath> plan;
  /// Flown instead of a plan, with the time as its argument.
  std::function<PositionSetpoint(double)> point;
  std::string last_warning;

  planning::PathFollowerParams follower{.turn_lead_s = 0.5};

  double along_max_m = 0.0;
  double cross_max_m = 0.0;
  double height_max_m = 0.0;
  double radius_min_m = 1e9;  ///< of a second's turn through the air
  planning::FollowError last;
  double judged_from_s = 20.0;

 private:
  void control() {
    if (point) return link->companion().command(point(to_seconds(now)), now);
    const auto sample = link->companion().sample();
    if (!sample || !plan) return;
    const VehicleState state = ardupilot::carried_to(*sample, now);
    link->companion().command(planning::follow_path(follower, spec, *plan, state, now), now);
    last = planning::follow_error(*plan, state, now);
    watch_turns(state);
    if (now < at_seconds(judged_from_s)) return;
    along_max_m = std::max(along_max_m, std::abs(last.along_m));
    cross_max_m = std::max(cross_max_m, std::abs(last.cross_m));
    height_max_m = std::max(height_max_m, std::abs(state.z_m - spec.height_m));
  }
  void watch_turns(const VehicleState& state) {
    const Instant begin = now - std::chrono::seconds{1};
    while (!second_.empty() && second_.front().time < begin) second_.pop_front();
    if (!second_.empty() && now > at_seconds(1.0)) {
      const VehicleState& then = second_.front();
      const double turned = std::abs(wrap_pi(state.heading_rad - then.heading_rad));
      const double flown =
          0.5 * (state.airspeed_mps + then.airspeed_mps) * to_seconds(state.time - then.time);
      if (turned > 0.1) radius_min_m = std::min(radius_min_m, flown / turned);
    }
    second_.push_back(state);
  }

  std::deque<VehicleState> second_;
};

/// Straight, half a circle to the left, straight, a whole circle to the right, at once to the left
/// again, and on.
TimedPath course(const VehicleSpec& spec) {
  TimedPath plan{.start_time = at_seconds(0.0),
                 .speed_mps = spec.cruise_speed_mps,
                 .tail_curvature_per_m = 0.0,
                 .path = {.start = {0, 0, 0}, .segments = {}}};
  const double r = spec.planning_radius_m();
  for (const Segment& s :
       {Segment{0.0, 20.0 * spec.cruise_speed_mps}, Segment{1.0 / r, r * kPi}, Segment{0.0, 800.0},
        Segment{-1.0 / r, 2.0 * kPi * r}, Segment{1.0 / r, 0.7 * r}, Segment{0.0, 1500.0}}) {
    EXPECT_TRUE(plan.path.append(s));
  }
  return plan;
}

TEST(CanFlight, KeepsItsPathAndItsTimesInWindWithGusts) {
  for (const auto& [speed, radius] : {std::pair{50.0, 150.0}, std::pair{60.0, 200.0}}) {
    for (const Wind& wind : {Wind{}, Wind{5.0, 5.0}}) {
      Flight flight{vehicle(speed, radius), wind};
      flight.plan = course(flight.spec);
      flight.run_until(to_seconds(flight.plan->end_time()));
      EXPECT_EQ(flight.state(), State::flying);
      EXPECT_EQ(flight.last_warning, "");
      std::printf(
          "%.0f m/s, wind %.0f m/s: along %.1f m, cross %.1f m, height %.1f m, turn radius %.1f m; "
          "end %.1f %.1f\n",
          speed, wind.speed_mps, flight.along_max_m, flight.cross_max_m, flight.height_max_m,
          flight.radius_min_m, flight.last.along_m, flight.last.cross_m);
      EXPECT_LT(flight.along_max_m, 10.0);
      EXPECT_LT(flight.cross_max_m, 8.0);
      EXPECT_LT(flight.height_max_m, 4.0);
      EXPECT_GT(flight.radius_min_m, 0.97 * radius);
      EXPECT_LT(std::abs(flight.last.along_m), 10.0);
      EXPECT_LT(std::abs(flight.last.cross_m), 5.0);
    }
  }
}

TEST(CanFlight, ThePilotHasTheAircraftAtOnce) {
  Flight flight{vehicle()};
  flight.plan = course(flight.spec);
  flight.run_until(5.0);
  ASSERT_EQ(flight.state(), State::flying);
  ASSERT_TRUE(flight.fc->interfere("mode RTL", flight.now));
  EXPECT_LE(flight.until(State::piloted, 1.0), milliseconds{100});
  flight.run_until(15.0);
  EXPECT_EQ(flight.state(), State::piloted);
  ASSERT_TRUE(flight.link->companion().give_back(flight.now, flight.now));
  EXPECT_LE(flight.until(State::flying, 2.0), milliseconds{300});
}

TEST(CanFlight, ALinkThatWasLostIsFlownOnWithin200Ms) {
  Flight flight{vehicle()};
  flight.plan = course(flight.spec);
  flight.run_until(5.0);
  flight.cut = true;
  EXPECT_LE(flight.until(State::lost, 1.0), milliseconds{105});
  flight.run_until(7.0);
  flight.cut = false;
  EXPECT_LE(flight.until(State::flying, 1.0), milliseconds{200});
}

TEST(CanFlight, ASilentAutopilotIsLostToo) {
  Flight flight{vehicle()};
  flight.plan = course(flight.spec);
  flight.run_until(5.0);
  ASSERT_TRUE(flight.fc->interfere("silent on", flight.now));
  const Instant begin = flight.now;
  while (flight.state() == State::flying && flight.now - begin < milliseconds{500}) flight.tick();
  EXPECT_LE(flight.now - begin, milliseconds{145});  // the last packet was 40 ms old
  ASSERT_TRUE(flight.fc->interfere("silent off", flight.now));
  EXPECT_LE(flight.until(State::flying, 1.0), milliseconds{200});
}

TEST(CanFlight, ARebootedAutopilotIsTakenOverAgain) {
  Flight flight{vehicle()};
  flight.plan = course(flight.spec);
  flight.run_until(5.0);
  ASSERT_TRUE(flight.fc->interfere("reboot", flight.now));
  EXPECT_LE(flight.until(State::lost, 1.0), milliseconds{145});
  flight.until(State::searching, 3.0);
  EXPECT_EQ(flight.last_warning, "the autopilot has rebooted");
  flight.until(State::flying, 12.0);
  EXPECT_EQ(flight.state(), State::flying);
}

// --- a copter ------------------------------------------------------------------------------------

/// It starts on the ground, away from the mission's origin, where its filter begins.
constexpr Pose2 kPad{120.0, -80.0, 0.4};

struct CopterFlight : Flight {
  explicit CopterFlight(std::uint64_t seed) : Flight{VehicleSpec{}, config(seed), params()} {}

  static hil::EmulatorConfig config(std::uint64_t seed) {
    hil::EmulatorConfig c;
    c.airframe = Airframe::copter;
    c.companion_failsafe = true;
    c.origin = kOrigin;
    c.start = kPad;
    c.airspeed_mps = 10.0;
    c.wind_mps = -4.0 * unit_vector(heading_from_compass_deg(240.0));
    c.gusts_wind_mps = 4.0;
    c.seed = seed;
    return c;
  }
  static ardupilot::CanLinkParams params() {
    ardupilot::CanLinkParams p;
    p.companion.vehicle.airframe = Airframe::copter;
    p.companion.take_over = ardupilot::TakeOver::from_ground;
    p.companion.takeoff_height_m = 10.0;
    return p;
  }
  [[nodiscard]] double off_m() const {
    return (vehicle_state().position().metres() - point(to_seconds(now)).position_m()).norm();
  }
};

PositionSetpoint above_pad(double height_m) {
  PositionSetpoint s;
  s.x_m = kPad.x_m;
  s.y_m = kPad.y_m;
  s.z_m = height_m;
  return s;
}

/// 20 m to the north-west from rest to rest, at 5 m/s, 2 m/s^2, 4 m/s^3.
PositionSetpoint on_the_move(double seconds, const PositionSetpoint& from) {
  constexpr std::array<std::array<double, 2>, 7> kJerks{
      {{4.0, 0.5}, {0.0, 2.0}, {-4.0, 0.5}, {0.0, 1.0}, {-4.0, 0.5}, {0.0, 2.0}, {4.0, 0.5}}};
  double way = 0.0;
  double speed = 0.0;
  double acceleration = 0.0;
  for (const auto& [jerk, length] : kJerks) {
    const double dt = std::clamp(seconds, 0.0, length);
    way += dt * (speed + dt * (acceleration / 2.0 + dt * jerk / 6.0));
    speed += dt * (acceleration + dt * jerk / 2.0);
    acceleration += dt * jerk;
    seconds -= dt;
  }
  const Vec2 along = unit_vector(0.75 * kPi);
  PositionSetpoint s = from;
  s.x_m += way * along.x();
  s.y_m += way * along.y();
  s.vx_mps = speed * along.x();
  s.vy_mps = speed * along.y();
  s.ax_mps2 = acceleration * along.x();
  s.ay_mps2 = acceleration * along.y();
  return s;
}

TEST(CopterFlight, TakesOffHoldsAPlaceFollowsAMoveAndLandsAtItsPlace) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    CopterFlight flight{seed};
    flight.point = [](double) { return above_pad(12.0); };
    flight.until(State::flying, 40.0);
    ASSERT_EQ(flight.state(), State::flying) << flight.last_warning;
    flight.run_until(to_seconds(flight.now) + 10.0);

    double held_m2 = 0.0;
    int n = 0;
    for (const Instant end = flight.now + std::chrono::seconds{30}; flight.now < end; ++n) {
      flight.tick();
      held_m2 += std::pow(flight.off_m(), 2);
    }
    const double begin_s = to_seconds(flight.now);
    flight.point = [begin_s](double s) { return on_the_move(s - begin_s, above_pad(12.0)); };
    double worst_m = 0.0;
    for (const Instant end = flight.now + std::chrono::seconds{10}; flight.now < end;) {
      flight.tick();
      worst_m = std::max(worst_m, flight.off_m());
    }
    const PositionSetpoint place = flight.point(begin_s + 10.0);
    flight.point = [place, down_s = begin_s + 10.0](double s) {
      PositionSetpoint p = place;
      p.z_m = std::max(12.0 - (s - down_s), -2.0);
      p.vz_mps = p.z_m > -2.0 ? -1.0 : 0.0;
      return p;
    };
    flight.until(State::landing, 30.0);
    EXPECT_EQ(flight.state(), State::landing);
    EXPECT_LT(flight.vehicle_state().z_m, 4.0);
    flight.until(State::standing_by, 30.0);
    EXPECT_EQ(flight.state(), State::standing_by);
    flight.run_until(to_seconds(flight.now) + 3.0);
    EXPECT_EQ(flight.state(), State::standing_by);  // it is not launched again
    const VehicleState landed = flight.vehicle_state();
    std::printf("seed %u: held within %.2f m rms, followed within %.2f m, landed %.2f m off\n",
                static_cast<unsigned>(seed), std::sqrt(held_m2 / n), worst_m,
                std::hypot(landed.x_m - place.x_m, landed.y_m - place.y_m));
    // The noise of what it tells is in these, 0.25 m rms.
    EXPECT_LT(std::sqrt(held_m2 / n), 0.3);
    EXPECT_LT(worst_m, 1.2);
    EXPECT_LT(std::hypot(landed.x_m - place.x_m, landed.y_m - place.y_m), 1.0);
    EXPECT_EQ(flight.last_warning, "");
  }
}

/// Straight on, half a circle to the left, straight on, and orbits to the right.
mission::FlightPlan plan_from(const Pose2& start, Instant at) {
  mission::FlightPlan plan;
  plan.number = 1;
  plan.timed.start_time = at;
  plan.timed.speed_mps = 6.0;
  plan.timed.tail_curvature_per_m = -1.0 / 30.0;
  plan.timed.path.start = start;
  EXPECT_TRUE(plan.timed.path.append(Segment{0.0, 70.0}));
  EXPECT_TRUE(plan.timed.path.append(Segment{1.0 / 30.0, kPi * 30.0}));
  EXPECT_TRUE(plan.timed.path.append(Segment{0.0, 70.0}));
  return plan;
}

TEST(CopterFlight, FliesThePlanOfACoalitionByPosition) {
  VehicleSpec spec;
  spec.airframe = Airframe::copter;
  spec.height_m = 20.0;
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    CopterFlight flight{seed};
    flight.point = [](double) { return above_pad(20.0); };
    flight.until(State::flying, 40.0);
    ASSERT_EQ(flight.state(), State::flying) << flight.last_warning;
    flight.run_until(to_seconds(flight.now) + 10.0);
    const Instant begin = flight.now;
    const mission::HeldGuidance guidance{plan_from(kPad, begin)};
    flight.point = [&](double s) {
      const Demand demand =
          mission::follow(guidance, {}, spec, flight.vehicle_state(), at_seconds(s));
      return std::get<PositionSetpoint>(demand);
    };
    double worst_m = 0.0;
    double late_m = 0.0;
    while (flight.now < begin + std::chrono::seconds{60}) {
      flight.tick();
      if (flight.now < begin + std::chrono::seconds{8}) continue;  // it starts from rest
      worst_m = std::max(worst_m, flight.off_m());
      const auto off = mission::deviation(guidance, spec, flight.vehicle_state(), flight.now);
      late_m = std::max(late_m, std::abs(off.along_error_m));
    }
    std::printf("seed %u: within %.2f m, along %.2f m\n", static_cast<unsigned>(seed), worst_m,
                late_m);
    EXPECT_LT(worst_m, 1.5);
    EXPECT_LT(late_m, 1.5);
    EXPECT_EQ(flight.state(), State::flying) << flight.last_warning;
  }
}

}  // namespace
}  // namespace skein
