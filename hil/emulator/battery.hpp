// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "skein/base/time.hpp"

namespace skein::hil {

/// A battery that thrust empties, and the autopilot's gauge, which counts what flows from when the
/// autopilot started, of a full battery: as ArduPilot does with a current sensor.
class Battery {
 public:
  explicit Battery(double capacity_mah) : capacity_mah_{capacity_mah} {}

  /// What it gave in that time at that throttle, [0, 1].
  void give(double throttle, Duration time) {
    amperes_ = kElectronics_a + kFullThrottle_a * std::clamp(throttle, 0.0, 1.0);
    const double mah = amperes_ * to_seconds(time) / 3.6;
    used_mah_ += mah;
    counted_mah_ += mah;
  }
  /// Suddenly, a cell that fails: the gauge says so too.
  void fall_to(double percent) {
    used_mah_ = counted_mah_ = (1.0 - percent / 100.0) * capacity_mah_;
  }
  /// The gauge's autopilot has started.
  void count_from_full() { counted_mah_ = 0.0; }

  [[nodiscard]] std::int8_t percent_told() const { return percent(counted_mah_); }
  [[nodiscard]] double counted_mah() const { return counted_mah_; }
  [[nodiscard]] double amperes() const { return amperes_; }
  /// Of three cells of lithium polymer, by what is left in truth.
  [[nodiscard]] double volts() const {
    constexpr double kFull_v = 12.6;
    constexpr double kEmpty_v = 10.5;
    return kEmpty_v + (kFull_v - kEmpty_v) * std::max(0.0, 1.0 - used_mah_ / capacity_mah_);
  }

 private:
  static constexpr double kElectronics_a = 0.5;
  static constexpr double kFullThrottle_a = 60.0;
  [[nodiscard]] std::int8_t percent(double used_mah) const {
    return static_cast<std::int8_t>(
        std::clamp(100.0 * (1.0 - used_mah / capacity_mah_), 0.0, 100.0));
  }

  double capacity_mah_;
  double used_mah_ = 0.0;
  double counted_mah_ = 0.0;
  double amperes_ = kElectronics_a;
};

}  // namespace skein::hil
