// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "skein/base/time.hpp"
#include "skein/domain/vehicle.hpp"

namespace skein::mission {

/// How far a vehicle can still fly: the less of what its configuration leaves after the distance
/// flown, and of what its battery does (VehicleState::battery_percent). Without a battery that is
/// told, the configuration alone. Pure: the same states give the same numbers.
///
/// The battery leaves what stands above its reserve, times the metres that a percent of it flies.
/// These begin as the configuration has them, which is that a full battery flies range_m down to
/// its reserve, and are learned from the steps of the percentage: an exponential mean over 10 % of
/// the battery, so that one step more or less decides on nothing. What was used without flying (on
/// the ground, in a hover) is gone, but teaches nothing; nor does a percentage that falls by more
/// than 5 at once, which is a gauge that has found out, not a flight. It counts once it has stood
/// for 3 s.
class RangeBudget {
 public:
  explicit RangeBudget(const VehicleSpec& vehicle)
      : range_m_{vehicle.range_m},
        flies_from_mps_{vehicle.cruise_speed_mps / 2.0},
        reserve_percent_{vehicle.battery_reserve_percent},
        metres_per_percent_{configured()} {}

  /// True where the percentage has changed: then what is left is another than who plans by the
  /// distance flown alone expects. Times of states never decrease.
  bool on_state(const VehicleState& state);

  /// m, over the ground, from the newest state on. Negative where it is overdrawn.
  [[nodiscard]] double left_m() const;
  /// The battery leaves less than the configuration does.
  [[nodiscard]] bool battery_decides() const;
  /// As learned by now.
  [[nodiscard]] double metres_per_percent() const { return metres_per_percent_; }

 private:
  struct Step {
    Instant at;
    double flown_m = 0.0;
  };
  [[nodiscard]] double configured() const { return range_m_ / (100.0 - reserve_percent_); }
  [[nodiscard]] std::optional<double> battery_left_m() const;
  [[nodiscard]] bool jumps(double percent, Instant now);
  bool rises(double percent, const VehicleState& state);
  void learn(double percent, const VehicleState& state);

  double range_m_;
  double flies_from_mps_;  ///< slower on the whole, it does not fly from place to place
  double reserve_percent_;
  double metres_per_percent_;
  double flown_m_ = 0.0;
  std::optional<double> percent_ = std::nullopt;  ///< left; whatever a restarted autopilot tells
  double told_too_much_ = 0.0;                    ///< by one that has restarted in flight
  double stepped_at_m_ = 0.0;                     ///< distance flown when percent_ came up
  std::optional<Instant> jumps_since_ = std::nullopt;  ///< that percentage is not believed yet
  std::optional<Step> step_ = std::nullopt;  ///< the last one; of the first percentage nobody knows
};

}  // namespace skein::mission
