// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "skein/domain/motion_track.hpp"
#include "skein/domain/vehicle.hpp"
#include "skein/formation/passage.hpp"

namespace skein::mission {

/// How a copter comes to its height before its first flight plan: straight up from where it stands,
/// as in the take-off of a formation (or, where it is in the air already, up or down). Who is not
/// lifted, since a pilot has it, begins anew from where it is then.
class TakeOff {
 public:
  explicit TakeOff(const VehicleSpec& vehicle) : vehicle_{vehicle} {}

  /// Is the vehicle at its height? A plane always is. Until then poll_track() has what to follow.
  [[nodiscard]] bool done(const VehicleState& state, Instant now);
  /// The newest, once.
  [[nodiscard]] std::optional<MotionTrack> poll_track();

 private:
  [[nodiscard]] bool at_height(const VehicleState& state) const;
  void begin(const Vec3& from, Instant now);

  VehicleSpec vehicle_;
  std::optional<formation::Passage> climb_;
  std::optional<MotionTrack> track_;
};

}  // namespace skein::mission
