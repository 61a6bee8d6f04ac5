// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "skein/base/frames.hpp"
#include "skein/base/time.hpp"
#include "skein/domain/vehicle.hpp"
#include "skein/mavlink/messages.hpp"

namespace skein::ardupilot {

/// A state as it was measured, and what it takes to carry it on for a moment. Trivially copyable.
struct MotionSample {
  VehicleState state;
  double turn_rate_radps = 0.0;  ///< of heading and course, counter-clockwise
};

/// How far a state is carried on. Older ones stay as old as they then are: who asks sees it.
inline constexpr Duration kCarryMax = std::chrono::milliseconds{250};

/// The state at `now`, on the arc that it was last seen on. Pure.
[[nodiscard]] VehicleState carried_to(const MotionSample& sample, Instant now);

/// Puts the vehicle's state together from ATTITUDE, GLOBAL_POSITION_INT and VFR_HUD. Each comes
/// with the mission time at which it was measured.
class Motion {
 public:
  /// `geoid_height_m`: of the geoid above the ellipsoid at the origin; autopilots count heights
  /// from it. `hovers`: an aircraft that flies where it is pushed, not where its nose points; its
  /// heading and airspeed are those of its motion over the ground, the heading its nose's while it
  /// hardly moves.
  Motion(const MissionOrigin& origin, double geoid_height_m, bool hovers)
      : origin_{origin}, geoid_height_m_{geoid_height_m}, hovers_{hovers} {}

  void on_attitude(const mavlink::Attitude& attitude, Instant measured);
  void on_position(const mavlink::GlobalPositionInt& position, Instant measured);
  /// It tells no time, so that of its coming counts.
  void on_hud(const mavlink::VfrHud& hud, Instant now);
  /// The clock of the autopilot was set anew: nothing that was heard counts. The distance stays.
  void forget();

  /// Nothing until all three have been heard. As old as the oldest of what it is made of: position,
  /// attitude (but of an aircraft that hovers), and the airspeed once that is older than a second.
  [[nodiscard]] std::optional<MotionSample> sample() const;
  /// Above the place that it was first heard on.
  [[nodiscard]] double relative_height_m() const { return relative_height_m_; }

 private:
  MissionOrigin origin_;
  double geoid_height_m_;
  bool hovers_;
  bool has_attitude_ = false;
  bool has_position_ = false;
  bool has_hud_ = false;
  double heading_rad_ = 0.0;
  double turn_rate_radps_ = 0.0;
  Instant attitude_at_;
  double airspeed_mps_ = 0.0;
  Instant hud_at_;
  double relative_height_m_ = 0.0;
  VehicleState state_;  ///< its heading and airspeed stand above
};

}  // namespace skein::ardupilot
