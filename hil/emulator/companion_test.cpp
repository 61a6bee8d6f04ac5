// SPDX-License-Identifier: Apache-2.0
// The companion's side as it flies on a vehicle (hal/ardupilot), against the emulated flight
// controller: nothing between them but frames.
#include <gtest/gtest.h>

#include <deque>
#include <memory>
#include <string>

#include "skein/ardupilot/can_link.hpp"
#include "skein/base/angles.hpp"
#include "skein/hil/emulated_flight_controller.hpp"
#include "skein/wording/wording.hpp"

namespace skein::hil {
namespace {

using ardupilot::Companion;
using State = Companion::State;

constexpr Wgs84 kOrigin{31.5, 105.0, 480.0};

/// The companion's end of a wire in memory.
class WireBus final : public can::Bus {
 public:
  WireBus(std::deque<can::Frame>& out, std::deque<can::Frame>& in) : out_{&out}, in_{&in} {}

  using Bus::send;
  bool send(std::span<const can::Frame> frames) override {
    out_->insert(out_->end(), frames.begin(), frames.end());
    return true;
  }
  void flush() override {}
  [[nodiscard]] std::size_t pending() const override { return 0; }
  void discard() override {}
  std::optional<can::Frame> receive() override {
    if (in_->empty()) return std::nullopt;
    const can::Frame frame = in_->front();
    in_->pop_front();
    return frame;
  }
  [[nodiscard]] int descriptor() const override { return -1; }
  Result<void> set_filters(std::span<const can::Filter> /*filters*/) override { return {}; }
  [[nodiscard]] can::State state() const override { return can::State::error_active; }
  [[nodiscard]] const can::Statistics& statistics() const override { return statistics_; }
  [[nodiscard]] const std::string& name() const override { return name_; }
  [[nodiscard]] bool fd() const override { return false; }

 private:
  std::deque<can::Frame>* out_;
  std::deque<can::Frame>* in_;
  can::Statistics statistics_;
  std::string name_ = "wire";
};

class Bench {
 public:
  explicit Bench(const EmulatorConfig& config)
      : controller_{EmulatedFlightController::make(config, Instant{}).value()},
        link_{std::make_unique<WireBus>(up_, down_), params(config),
              MissionOrigin::make(kOrigin).value(), Instant{}} {}

  void run(double seconds) {
    const Instant end = now_ + from_seconds(seconds);
    while (now_ < end) tick();
  }
  bool run_until(State state, double seconds) {
    const Instant end = now_ + from_seconds(seconds);
    while (companion().state() != state && now_ < end) tick();
    return companion().state() == state;
  }
  void interfere(const std::string& line) {
    const auto done = controller_.interfere(line, now_);
    EXPECT_TRUE(done.ok()) << done.error().message;
  }
  [[nodiscard]] Companion& companion() { return link_.companion(); }
  [[nodiscard]] ardupilot::CanLink& link() { return link_; }
  [[nodiscard]] VehicleState state() { return carried_to(companion().sample().value(), now_); }
  [[nodiscard]] Instant now() const { return now_; }
  [[nodiscard]] const std::string& log() const { return log_; }

  Setpoint setpoint;

 private:
  static ardupilot::CanLinkParams params(const EmulatorConfig& config) {
    const bool plane = config.airframe == Airframe::plane;
    ardupilot::CanLinkParams p;
    p.companion.airframe = plane ? ardupilot::Airframe::plane : ardupilot::Airframe::copter;
    p.companion.take_over = ardupilot::TakeOver::in_flight;
    VehicleSpec& spec = p.companion.vehicle;
    spec.id = VehicleId{1};
    spec.cruise_speed_mps = config.airspeed_mps;
    spec.speed_min_mps = plane ? 42.5 : 0.0;
    spec.speed_max_mps = plane ? 57.5 : 10.0;
    spec.turn_radius_m = plane ? config.turn_radius_m : 20.0;
    spec.heading_gain_per_s = 1.5;
    spec.height_m = config.height_m;
    return p;
  }

  void tick() {
    now_ += std::chrono::milliseconds{5};
    if (++ticks_ % 4 == 0) companion().command(setpoint, now_);
    while (!up_.empty()) {
      controller_.on_frame(up_.front(), now_);
      up_.pop_front();
    }
    controller_.step(now_);
    for (auto frames = controller_.front(); !frames.empty(); frames = controller_.front()) {
      down_.insert(down_.end(), frames.begin(), frames.end());
      controller_.pop();
    }
    link_.step(now_);
    while (const auto notice = companion().poll_notice())
      log_ += wording::text_of(notice->what) + "\n";
  }

  std::deque<can::Frame> up_;
  std::deque<can::Frame> down_;
  EmulatedFlightController controller_;
  ardupilot::CanLink link_;
  Instant now_;
  int ticks_ = 0;
  std::string log_;
};

EmulatorConfig plane_in_wind() {
  EmulatorConfig config;
  config.origin = kOrigin;
  config.start = {1000.0, 2000.0, kPi / 2.0};
  config.height_m = 300.0;
  config.airborne = true;
  config.companion_failsafe = true;
  config.wind_mps = {4.0, -3.0};
  config.gusts_wind_mps = 5.0;
  return config;
}

TEST(CompanionAndEmulator, APlaneIsFlownInWindWithGusts) {
  EmulatorConfig config = plane_in_wind();
  config.hold_until = at_seconds(3.0);
  Bench bench{config};
  bench.setpoint = {.heading_rad = kPi / 2.0, .airspeed_mps = 50.0, .height_m = 300.0};
  ASSERT_TRUE(bench.run_until(State::flying, 2.9)) << bench.log();
  EXPECT_NEAR(bench.state().x_m, 1000.0, 1.0);
  EXPECT_NEAR(bench.state().heading_rad, kPi / 2.0, 0.01);
  bench.setpoint = {.heading_rad = 0.0, .airspeed_mps = 55.0, .height_m = 320.0};
  bench.run(20.0);
  for (int i = 0; i < 20; ++i) {
    bench.run(0.5);
    EXPECT_NEAR(degrees(bench.state().heading_rad), 0.0, 3.0) << bench.log();
    EXPECT_NEAR(bench.state().airspeed_mps, 55.0, 2.0);
    EXPECT_NEAR(bench.state().z_m, 320.0, 5.0);
  }
  EXPECT_EQ(bench.companion().parser().lost, 0U);
  EXPECT_EQ(bench.companion().parser().bad_crc, 0U);
  EXPECT_EQ(bench.link().reassembly().broken(), 0U);
}

TEST(CompanionAndEmulator, PilotSilenceAndRestartAreNoticed) {
  Bench bench{plane_in_wind()};
  bench.setpoint = {.heading_rad = kPi / 2.0, .airspeed_mps = 50.0, .height_m = 300.0};
  ASSERT_TRUE(bench.run_until(State::flying, 10.0)) << bench.log();
  bench.run(2.0);
  bench.interfere("mode LOITER");
  EXPECT_TRUE(bench.run_until(State::piloted, 0.25)) << bench.log();
  bench.run(2.0);
  EXPECT_EQ(bench.companion().state(), State::piloted);
  EXPECT_TRUE(bench.companion().give_back(bench.now(), bench.now())) << bench.log();
  EXPECT_TRUE(bench.run_until(State::flying, 3.0)) << bench.log();

  bench.interfere("silent on");
  EXPECT_TRUE(bench.run_until(State::lost, 0.25)) << bench.log();
  bench.run(1.0);
  bench.interfere("silent off");
  EXPECT_TRUE(bench.run_until(State::flying, 1.0)) << bench.log();

  bench.interfere("reboot");
  EXPECT_TRUE(bench.run_until(State::lost, 0.25)) << bench.log();
  bench.run(10.0);
  EXPECT_NE(bench.companion().state(), State::lost) << bench.log();
  EXPECT_NE(bench.companion().state(), State::silent) << bench.log();
}

TEST(CompanionAndEmulator, APlaneThatDoesNotKnowWhereItIsIsNotTaken) {
  Bench bench{plane_in_wind()};
  bench.setpoint = {.heading_rad = kPi / 2.0, .airspeed_mps = 50.0, .height_m = 300.0};
  bench.interfere("position lost");
  ASSERT_TRUE(bench.run_until(State::standing_by, 10.0)) << bench.log();
  bench.run(2.0);
  EXPECT_EQ(bench.companion().state(), State::standing_by) << bench.log();
  EXPECT_FALSE(bench.companion().give_back(bench.now(), bench.now()));
  bench.interfere("position good");
  EXPECT_TRUE(bench.run_until(State::flying, 3.0)) << bench.log();
}

TEST(CompanionAndEmulator, ACopterIsFlown) {
  EmulatorConfig config = plane_in_wind();
  config.airframe = Airframe::copter;
  config.airspeed_mps = 10.0;
  config.height_m = 30.0;
  config.wind_mps = {2.0, -1.0};
  config.gusts_wind_mps = 0.0;
  Bench bench{config};
  bench.setpoint = {.heading_rad = 0.0, .airspeed_mps = 5.0, .height_m = 30.0};
  ASSERT_TRUE(bench.run_until(State::flying, 10.0)) << bench.log();
  bench.run(10.0);
  EXPECT_NEAR(bench.state().groundspeed_mps, 5.0, 0.7) << bench.log();
  EXPECT_NEAR(degrees(bench.state().course_rad), 0.0, 8.0);
  EXPECT_NEAR(bench.state().z_m, 30.0, 1.5);
}

}  // namespace
}  // namespace skein::hil
