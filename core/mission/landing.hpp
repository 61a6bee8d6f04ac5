// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "skein/domain/fence.hpp"
#include "skein/domain/hazard.hpp"
#include "skein/domain/landing.hpp"
#include "skein/domain/motion_track.hpp"
#include "skein/domain/vehicle.hpp"
#include "skein/formation/passage.hpp"

namespace skein::mission {

/// Where a vehicle lands whose first flight plan began there.
[[nodiscard]] Landing landing_of(const VehicleSpec& vehicle, const Pose2& start);

/// The same on a final approach that begins there, wherever the configuration has it.
[[nodiscard]] Landing landing_after(const VehicleSpec& vehicle, const Pose2& begin);

/// Does a plane's way down, the circle and the final approach, keep `margin_m` from the hazards and
/// within the fence?
[[nodiscard]] bool is_open(const Landing& landing, const std::vector<Hazard>& hazards,
                           double margin_m, const Fence& fence);

/// How a copter comes down: at its height over the place, then straight down to it. Who does not
/// follow, since it was still moving or a pilot has it, begins anew from where it is then.
class Descent {
 public:
  Descent(const Landing& landing, double height_m, double ground_m)
      : over_{landing.x_m, landing.y_m, height_m}, ground_m_{ground_m} {}

  void step(const VehicleState& state, Instant now);
  /// The newest, once.
  [[nodiscard]] std::optional<MotionTrack> poll_track();

 private:
  void begin(const Vec3& from, Instant now);

  Vec3 over_;
  double ground_m_;
  bool sinks_ = false;
  std::optional<formation::Passage> passage_;
  std::optional<MotionTrack> track_;
};

}  // namespace skein::mission
