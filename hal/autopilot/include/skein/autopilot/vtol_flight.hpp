// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "skein/autopilot/fixed_wing_loops.hpp"
#include "skein/autopilot/lift_loops.hpp"

namespace skein::autopilot {

/// Four rotors in an X: front right, back left, front left, back right; the first two turn
/// counter-clockwise seen from above. Speeds are those of ArduPlane's Q_ parameters.
struct VtolParams {
  LiftTuning tuning{};  ///< its climb_max_mps and sink_max_mps: Q_WP_SPD_UP, Q_WP_SPD_DN
  double arm_forward_m = 0.25;
  double arm_right_m = 0.25;
  double rotor_thrust_max_n = 6.0;  ///< of each
  double torque_per_lift_m = 0.02;
  double touch_mps = 0.5;          ///< Q_LAND_FINAL_SPD
  double touch_from_m = 6.0;       ///< Q_LAND_FINAL_ALT
  double approach_mps = 5.0;       ///< Q_WP_SPD
  double wings_from_mps = 15.0;    ///< true airspeed that ends a transition: AIRSPEED_MIN
  double fade_s = 5.0;             ///< Q_TRANSITION_MS
  double brakes_until_mps = 10.0;  ///< airspeed from which on rotors move it to its place
  double braking_mps2 = 1.5;       ///< what its drag gives on the way to that
};

/// A quadplane where its rotors carry it: lifted off, in hover, between rotors and wings, and set
/// down, as ArduPlane's QuadPlane does it as far as a companion sees it. Heights are above the
/// mission's origin. Pure: the time step is an argument.
class VtolFlight {
 public:
  static constexpr std::size_t kRotors = 4;

  explicit VtolFlight(const VtolParams& params);

  /// To a place, {north, east}, at the climb and sink rates of the tuning; none: where it comes to
  /// a stop.
  void hover(const Estimate& estimate, const std::optional<Vec2>& place_m, double height_m);
  /// To the place at the height that it has, and down there.
  void set_down(const Estimate& estimate, const std::optional<Vec2>& place_m, double ground_m);
  /// On the wings, once it is fast enough for them.
  void fly_on_wings(const Estimate& estimate);
  /// The rotors stand.
  void stop();

  /// The rotors carry it: step() flies it. Else its wings do.
  [[nodiscard]] bool carries() const { return phase_ != Phase::wings; }
  enum class Carried : std::uint8_t { by_wings, to_wings, to_rotors, by_rotors };
  [[nodiscard]] Carried carried() const {
    if (phase_ == Phase::wings) return Carried::by_wings;
    if (phase_ == Phase::transition) return Carried::to_wings;
    return phase_ == Phase::brake ? Carried::to_rotors : Carried::by_rotors;
  }
  /// On the ground after set_down().
  [[nodiscard]] bool touched_down() const { return rested_s_ >= kRested_s; }
  /// From there on it has to brake to be over a place.
  [[nodiscard]] double stopping_m(double groundspeed_mps) const;

  /// `wings` move the surfaces. Precondition: carries(), seconds > 0.
  SurfaceCommand step(const Estimate& estimate, FixedWingLoops& wings, double seconds);
  /// What is left of the rotors' thrust after a transition. Precondition: not carries().
  void fade(double seconds);

  /// Of each, as a share of its greatest thrust.
  [[nodiscard]] const std::array<double, kRotors>& rotors() const { return rotors_; }

 private:
  enum class Phase : std::uint8_t { wings, transition, brake, hover, sink };
  static constexpr double kRested_s = 1.0;

  void lift(const LiftDemand& demand);
  /// Level, at its height, as fast as it is.
  [[nodiscard]] MotionDemand level(const Estimate& estimate) const;
  [[nodiscard]] MotionDemand sinking(const Estimate& estimate) const;

  VtolParams params_;
  LiftLoops loops_;
  Phase phase_ = Phase::wings;
  bool sets_down_ = false;
  Vec2 place_m_{0.0, 0.0};
  bool stops_anywhere_ = false;  ///< its place is where it has stopped
  double height_m_ = 0.0;
  double ground_m_ = 0.0;
  double yaw_rad_ = 0.0;
  double thrust_n_ = 0.0;
  double fading_n_ = 0.0;  ///< at the end of the transition
  double sink_mps_ = 0.0;  ///< smoothed, on the way down
  double rested_s_ = 0.0;
  std::array<double, kRotors> rotors_{};
};

}  // namespace skein::autopilot
