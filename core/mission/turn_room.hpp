// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "skein/domain/vehicle.hpp"

namespace skein::mission {

/// How wide a fixed wing's turns are planned in the wind there is. A plan has one speed v over the
/// ground, so in wind w its airspeed rises and falls by w in each circle. Circles that can be held
/// have at least
///   r_min (v / (v - w))^2    flown before the wind with the airspeed v - w, and
///   w v / a                  at the airspeed's change a that the autopilot follows.
/// Never tighter than the configuration has it, nor wider than the arcs that the vehicle's sensors
/// leave around a site, or kWidest times its turn radius.
class TurnRoom {
 public:
  static constexpr double kWidest = 3.0;

  /// Without `airspeed_change_mps2` (> 0) the configuration's radius stays, whatever the wind.
  TurnRoom(const VehicleSpec& vehicle, std::optional<double> airspeed_change_mps2);

  /// True where circles are now planned wider, or tighter again: by a twentieth at least, so that
  /// gusts, of which the mean of 20 s leaves little, change nothing.
  bool on_state(const VehicleState& state);

  [[nodiscard]] double radius_m() const { return radius_m_; }
  /// In this wind circles would have to be a fifth wider than there is room for: they are flown
  /// well off their line.
  [[nodiscard]] bool lacks_room() const { return lacks_room_; }
  [[nodiscard]] double wind_mps() const { return wind_mps_.norm(); }

 private:
  [[nodiscard]] double held_radius_m() const;

  VehicleSpec vehicle_;
  std::optional<double> airspeed_change_mps2_;
  double widest_m_ = 0.0;
  double radius_m_ = 0.0;
  bool lacks_room_ = false;
  Vec2 wind_mps_{0.0, 0.0};
  double heard_s_ = 0.0;  ///< that the mean is of
  std::optional<Instant> last_;
};

}  // namespace skein::mission
