// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <deque>
#include <memory>
#include <string>

#include "skein/ardupilot/can_link.hpp"
#include "skein/hil/emulated_flight_controller.hpp"
#include "skein/wording/wording.hpp"

/// The companion's side as it flies on a vehicle (hal/ardupilot), against the emulated flight
/// controller: nothing between them but frames.
namespace skein::hil {

using ardupilot::Companion;
using State = ardupilot::Companion::State;

inline constexpr Wgs84 kOrigin{31.5, 105.0, 480.0};

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

/// A companion, an emulated flight controller and time.
class Bench {
 public:
  static ardupilot::CanLinkParams params(const EmulatorConfig& config) {
    const bool copter = config.airframe == Airframe::copter;
    ardupilot::CanLinkParams p;
    p.companion.take_over = ardupilot::TakeOver::in_flight;
    VehicleSpec& spec = p.companion.vehicle;
    spec.id = VehicleId{1};
    spec.airframe = config.airframe;
    spec.cruise_speed_mps = copter ? config.climb_mps : config.airspeed_mps;
    spec.speed_min_mps = copter ? 0.0 : config.airspeed_min_mps + 2.5;
    spec.speed_max_mps = copter ? 10.0 : 1.15 * config.airspeed_mps;
    spec.turn_radius_m = copter ? 20.0 : config.turn_radius_m;
    spec.heading_gain_per_s = 1.5;
    spec.height_m = config.height_m;
    return p;
  }

  explicit Bench(const EmulatorConfig& config) : Bench{config, params(config)} {}
  /// With a companion that looks for another one.
  Bench(const EmulatorConfig& config, const ardupilot::CanLinkParams& expected)
      : controller_{EmulatedFlightController::make(config, Instant{}).value()},
        link_{std::make_unique<WireBus>(up_, down_), expected, MissionOrigin::make(kOrigin).value(),
              Instant{}} {}

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

}  // namespace skein::hil
