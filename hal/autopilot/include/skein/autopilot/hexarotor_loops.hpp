// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "skein/autopilot/lift_loops.hpp"

namespace skein::autopilot {

/// Thrust of each rotor as a share of its greatest, [0, 1]. Rotor i stands at 30 + 60 i degrees
/// from forward, clockwise; even ones turn clockwise, both seen from above.
struct RotorCommand {
  static constexpr std::size_t kRotors = 6;
  std::array<double, kRotors> thrust{};

  [[nodiscard]] double mean() const;
};

/// The defaults fly models::firefly().
struct HexarotorTuning : LiftTuning {
  double arm_m = 0.215;
  double torque_per_lift_m = 0.016;
  double rotor_thrust_max_n = 6.0;
};

/// LiftLoops and mixing. Pure: the time step is an argument.
class HexarotorLoops {
 public:
  explicit HexarotorLoops(const HexarotorTuning& tuning) : tuning_{tuning}, lift_{tuning} {}

  /// Forgets the integrals.
  void reset() { lift_.reset(); }

  /// Precondition for all: seconds > 0.
  RotorCommand fly(const Estimate& estimate, const MotionDemand& demand, double seconds);
  /// Roll and pitch as given (within tilt_max), turning at a rate; mean thrust as a share.
  RotorCommand hold_attitude(const Estimate& estimate, double roll_rad, double pitch_rad,
                             double yaw_rad, double yaw_rate_radps, double thrust, double seconds);

  /// Mean thrust share that carries the weight.
  [[nodiscard]] double hover_thrust() const;
  [[nodiscard]] const HexarotorTuning& tuning() const { return tuning_; }

 private:
  HexarotorTuning tuning_;
  LiftLoops lift_;
};

/// Forces and moments to rotors: roll and pitch come first, then thrust, then yaw, each as far as
/// the rotors' limits leave room.
[[nodiscard]] RotorCommand mix(const HexarotorTuning& tuning, const LiftDemand& demand);

}  // namespace skein::autopilot
