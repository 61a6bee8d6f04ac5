// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "skein/base/time.hpp"

namespace skein::ardupilot {

/// How fast the aircraft turns at its bank, against a coordinated turn's g tan(bank) / airspeed
/// (Beard and McLain, eq. 9.14): 1 is as fast. One that slips turns more slowly, an ArduPlane
/// without rudder in its turns at 0.73 of it. Learned in flight from the turns that are flown, by
/// least squares with forgetting over the lateral acceleration that is flown and the one that
/// belongs to the bank, both filtered alike: the turn lags behind the bank, and one against the
/// other at a moment of rolling says nothing. What was learned in one turn begins the next.
class TurnAbility {
 public:
  /// `lateral_mps2`: across the velocity through the air. `bank_rad`: of the same sign in a turn.
  /// At a time that is not later than the last one it does nothing.
  void on_measurement(Instant measured, double lateral_mps2, double bank_rad);
  /// Within [kLeast, kMost]; 1 before a turn was flown.
  [[nodiscard]] double share() const;

  static constexpr double kLeast = 0.5;
  static constexpr double kMost = 1.1;

 private:
  /// Before anything was flown: share 1, by that much evidence, (m/s^2)^2 s.
  static constexpr double kPrior = 10.0;

  std::optional<Instant> last_;
  double flown_mps2_ = 0.0;  ///< filtered
  double of_bank_mps2_ = 0.0;
  double product_ = kPrior;
  double square_ = kPrior;
};

}  // namespace skein::ardupilot
