// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <optional>

#include "air.hpp"
#include "skein/base/frames.hpp"
#include "skein/hil/emulator_config.hpp"
#include "vehicle.hpp"

namespace skein::hil {

/// What vehicles have in common, whatever their autopilot.
template <class Autopilot>
class AutopilotVehicle : public Vehicle {
 public:
  [[nodiscard]] const FlightReport& report() const override { return report_; }
  autopilot::CommandResult arm() override {
    const bool was_armed = autopilot_.armed();
    const auto result = autopilot_.arm();
    if (!was_armed && autopilot_.armed()) report_.home_m = home_of(report_.estimate.position_m);
    tell();
    return result;
  }
  autopilot::CommandResult disarm(bool force) override {
    const auto result = autopilot_.disarm(force);
    tell();
    return result;
  }
  void companion_heard(Instant now) override { autopilot_.companion_heard(now); }
  void set_health(const autopilot::Health& health) override {
    health_ = health;
    autopilot_.set_health(health);
  }
  [[nodiscard]] std::optional<autopilot::Notice> poll_notice() override {
    return autopilot_.poll_notice();
  }

 protected:
  template <class Params>
  AutopilotVehicle(const EmulatorConfig& config, const Earth& earth, const Params& params,
                   Instant now)
      : earth_{earth},
        hold_until_{config.airborne ? config.hold_until : Instant::min()},
        air_{config},
        senses_{config},
        flown_to_{now},
        autopilot_{params} {
    report_.home_m = ned_from_enu({config.start.x_m, config.start.y_m, 0.0});
  }

  /// Where the home of a vehicle is that is armed there.
  [[nodiscard]] virtual Vec3 home_of(const Vec3& position_m) const { return position_m; }
  /// Brings the report up to date.
  virtual void tell() = 0;

  [[nodiscard]] bool held(Instant now) const { return now < hold_until_; }
  /// Flies a model from where it was flown to, step by step, as near to `now` as these go.
  template <class Fly>
  void fly_until(Instant now, Duration step, Fly fly) {
    if (held(now)) {
      flown_to_ = now;
      return;
    }
    flown_to_ = std::max(flown_to_, hold_until_);
    for (; flown_to_ + step <= now; flown_to_ += step) fly(to_seconds(step));
  }
  template <class Aircraft>
  void sense(const Aircraft& aircraft) {
    report_.truth = aircraft.state();
    report_.estimate =
        senses_.estimate(aircraft.state(), aircraft.specific_force(air_.wind_ned_mps()),
                         air_.airspeed_mps(aircraft.state()), to_seconds(period()));
  }

  Earth earth_;
  Instant hold_until_;
  Air air_;
  Senses senses_;
  Instant flown_to_;
  Autopilot autopilot_;
  autopilot::Health health_;
  FlightReport report_;
};

}  // namespace skein::hil
