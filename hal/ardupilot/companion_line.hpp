// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "autopilot_double.hpp"
#include "skein/ardupilot/companion.hpp"
#include "skein/wording/wording.hpp"

namespace skein::ardupilot {

inline VehicleSpec test_vehicle(Airframe airframe = Airframe::plane) {
  VehicleSpec v;
  v.airframe = airframe;
  v.id = {7};
  v.cruise_speed_mps = 50.0;
  v.speed_min_mps = 42.5;
  v.speed_max_mps = 57.5;
  v.turn_radius_m = 150.0;
  v.heading_gain_per_s = 1.5;
  v.height_m = 300.0;
  return v;
}

inline CompanionParams params(TakeOver take_over = TakeOver::in_flight,
                              Airframe airframe = Airframe::plane) {
  CompanionParams p;
  p.vehicle = test_vehicle(airframe);
  p.take_over = take_over;
  return p;
}

/// A companion and an autopilot with a line between them that takes its time.
struct Line {
  explicit Line(const CompanionParams& p = params())
      : companion{p, MissionOrigin::make(kTestOrigin).value(), now} {}

  static constexpr Duration kTick = std::chrono::milliseconds{5};
  Instant now = at_seconds(-20.0);  // processes start before the mission does
  Duration delay = std::chrono::milliseconds{10};
  bool cut = false;      ///< nothing comes through
  bool frames = true;    ///< the flight controller's node is on the bus
  bool commands = true;  ///< the control loop sends setpoints
  Setpoint setpoint{.heading_rad = 0.7, .airspeed_mps = 53.0, .height_m = 310.0};
  std::optional<PositionSetpoint> point;  ///< sent instead, where there is one
  AutopilotDouble autopilot{now - std::chrono::seconds{60}};
  Companion companion;
  std::vector<std::string> notices;
  std::vector<std::string> warnings;

  void tick() {
    now += kTick;
    const auto said = autopilot.speak(now);
    if (!said.empty() && !cut) down_.push_back({now + delay, said});
    while (!down_.empty() && down_.front().at <= now) {
      if (!cut) companion.on_bytes(down_.front().bytes, now);
      down_.pop_front();
    }
    if (frames && !cut) companion.on_frame_heard(now);
    if (commands && point) companion.command(*point, now);
    if (commands && !point) companion.command(setpoint, now);
    companion.step(now);
    while (const auto packet = companion.poll_packet()) {
      sent_at = now;
      if (!cut) up_.push_back({now + delay, {packet->begin(), packet->end()}});
    }
    while (!up_.empty() && up_.front().at <= now) {
      autopilot.hear(up_.front().bytes, now);
      up_.pop_front();
    }
    while (const auto notice = companion.poll_notice()) {
      notices.push_back(wording::text_of(notice->what));
      if (notice->warning) warnings.push_back(notices.back());
    }
  }
  void run(double seconds) {
    for (const Instant end = now + from_seconds(seconds); now < end;) tick();
  }
  /// How long it took until the companion was in that state; the limit if it never was.
  Duration until(Companion::State state, double limit_s) {
    const Instant begin = now;
    while (companion.state() != state && now - begin < from_seconds(limit_s)) tick();
    return now - begin;
  }
  std::size_t targets_within(double seconds) {
    const std::size_t before = autopilot.target_times.size();
    run(seconds);
    return autopilot.target_times.size() - before;
  }

  Instant sent_at;

 private:
  struct Bytes {
    Instant at;
    std::vector<std::uint8_t> bytes;
  };
  std::deque<Bytes> down_;
  std::deque<Bytes> up_;
};

}  // namespace skein::ardupilot
