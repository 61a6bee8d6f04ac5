// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "skein/ardupilot/turn_ability.hpp"
#include "skein/ardupilot/wind_estimate.hpp"
#include "skein/base/frames.hpp"
#include "skein/base/time.hpp"
#include "skein/domain/vehicle.hpp"
#include "skein/mavlink/messages.hpp"

namespace skein::ardupilot {

/// A state as it was measured, and what it takes to carry it on for a moment. Trivially copyable.
struct MotionSample {
  VehicleState state;
  double turn_rate_radps = 0.0;  ///< of heading and course, counter-clockwise
  /// What a fixed wing turns by at its bank, against a coordinated turn.
  double turn_ability = 1.0;
  /// True per equivalent airspeed where it flies; autopilots are asked for the latter.
  double true_per_equivalent = 1.0;
};

/// How far a state is carried on. Older ones stay as old as they then are: who asks sees it.
inline constexpr Duration kCarryMax = std::chrono::milliseconds{250};

/// The state at `now`, on the arc that it was last seen on. Pure.
[[nodiscard]] VehicleState carried_to(const MotionSample& sample, Instant now);

/// Puts the vehicle's state together from ATTITUDE, GLOBAL_POSITION_INT and VFR_HUD. Each comes
/// with the mission time at which it was measured.
///
/// A fixed wing's heading is where it moves through the air: its velocity over the ground less the
/// wind, which is learned in flight. Its nose swings about that by some degrees when it rolls, and
/// stands out of the turn where nothing coordinates it; who steered by it would answer the swing.
/// Its turn rate is that of its bank, by what it is known to turn by at a bank.
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
  [[nodiscard]] double airspeed_mps() const;  ///< true
  [[nodiscard]] double turn_rate_radps() const;
  /// The wind, and what it turns by: from a velocity that is `since` younger than the last one.
  void learn(const Vec2& over_ground_mps, Duration since, Instant measured);

  MissionOrigin origin_;
  double geoid_height_m_;
  bool hovers_;
  bool has_attitude_ = false;
  bool has_position_ = false;
  bool has_hud_ = false;
  double nose_rad_ = 0.0;
  double nose_rate_radps_ = 0.0;
  double bank_rad_ = 0.0;  ///< positive to the right
  Instant attitude_at_;
  double equivalent_airspeed_mps_ = 0.0;
  double true_per_equivalent_ = 1.0;
  Instant hud_at_;
  double relative_height_m_ = 0.0;
  VehicleState state_;  ///< its airspeed stands above
  Vec2 over_ground_mps_{0.0, 0.0};
  WindEstimate wind_;
  TurnAbility turn_ability_;
};

}  // namespace skein::ardupilot
