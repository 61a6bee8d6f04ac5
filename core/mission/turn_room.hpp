// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "skein/domain/vehicle.hpp"

namespace skein::mission {

/// The wind there is, and how wide a fixed wing's turns are planned in it. A plan has one airspeed
/// v, so before the wind w it is v + w fast over the ground, and circles that can be held there
/// have at least r_min ((v + w) / v)^2 and a reserve; one deviation of the gusts counts as wind.
/// Never tighter than the configuration has it, nor wider than the arcs that the vehicle's sensors
/// leave around a site, or kWidest times its turn radius.
class TurnRoom {
 public:
  static constexpr double kWidest = 3.0;
  static constexpr double kWindChange_mps = 1.0;

  /// Without `heeds_wind` the configuration's radius stays, and no wind is known.
  TurnRoom(const VehicleSpec& vehicle, bool heeds_wind);

  /// True where what is flown is to be planned anew: circles are now wider, or tighter again, by a
  /// twentieth at least, or the wind is another one by kWindChange_mps; so that a single gust, of
  /// which the mean of 20 s leaves little, changes nothing.
  bool on_state(const VehicleState& state);

  [[nodiscard]] double radius_m() const { return radius_m_; }
  /// In this wind circles would have to be a fifth wider than there is room for: they are flown
  /// well off their line.
  [[nodiscard]] bool lacks_room() const { return lacks_room_; }
  [[nodiscard]] const Vec2& wind_mps() const { return wind_mps_; }

 private:
  [[nodiscard]] double held_radius_m() const;

  VehicleSpec vehicle_;
  bool heeds_wind_;
  bool lacks_room_ = false;
  double widest_m_ = 0.0;
  double radius_m_ = 0.0;
  Vec2 wind_mps_{0.0, 0.0};
  double gusts_m2ps2_ = 0.0;         ///< mean square of what the wind is beside its mean
  Vec2 planned_wind_mps_{0.0, 0.0};  ///< when on_state() was last true
  double heard_s_ = 0.0;             ///< that the mean is of
  std::optional<Instant> last_;
};

}  // namespace skein::mission
