// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "skein/models/ground_contact.hpp"
#include "skein/models/rigid_body.hpp"

namespace skein::models {

inline constexpr std::size_t kRotors = 6;

/// A flat hexarotor. Rotor i turns at w: it lifts by k_f w^2, its drag turns the body by
/// k_m k_f w^2 against its own turning, and the air passing it in its plane at v drags by
/// k_d w v (Furrer, Burri, Achtelik and Siegwart, "RotorS", 2016, eq. 1-5; Mahony, Kumar and Corke
/// 2012). Speeds follow their command with a first-order lag, faster up than down.
struct HexarotorParams {
  MassProperties mass{1.0, Eigen::Matrix3d::Identity()};
  std::array<Vec3, kRotors> rotor_m{};  ///< their places, body axes
  /// +1 where the rotor turns clockwise seen from above (its drag turns the body the other way).
  std::array<double, kRotors> turning{};
  double lift_ns2_per_rad2 = 0.0;      ///< k_f
  double torque_per_lift_m = 0.0;      ///< k_m
  double drag_ns_per_rad_m = 0.0;      ///< k_d, N per rad/s and m/s
  double rolling_nms_per_rad_m = 0.0;  ///< rolling moment, N m per rad/s and m/s
  double speed_max_radps = 0.0;
  double time_up_s = 0.0;             ///< motor lag, > 0
  double time_down_s = 0.0;           ///< > 0
  double body_drag_n_per_mps2 = 0.0;  ///< of the fuselage, quadratic
  GroundContactParams ground;
};

/// The AscTec Firefly with the constants that RotorS publishes (1.57 kg, arm 0.215 m). Fuselage
/// drag and feet are ours.
[[nodiscard]] HexarotorParams firefly();

using RotorSpeeds = std::array<double, kRotors>;

/// Air and rotors on the vehicle; neither gravity nor the ground.
[[nodiscard]] Wrench hexarotor_wrench(const HexarotorParams& params, const RigidBodyState& state,
                                      const RotorSpeeds& speeds_radps, const Vec3& wind_ned_mps);
/// Of each rotor, in still air, to hover.
[[nodiscard]] double hover_speed_radps(const HexarotorParams& params);

/// The vehicle with its motors. Deterministic; allocates nothing.
class Hexarotor {
 public:
  Hexarotor(const HexarotorParams& params, const RigidBodyState& state);

  /// Advances by one step of Runge-Kutta with command and wind held; at most 2.5 ms. Commands are
  /// limited to [0, speed_max].
  void step(const RotorSpeeds& command_radps, const Vec3& wind_ned_mps, double seconds);

  [[nodiscard]] const RigidBodyState& state() const { return state_; }
  [[nodiscard]] const RotorSpeeds& speeds_radps() const { return speeds_; }
  [[nodiscard]] const HexarotorParams& params() const { return params_; }
  [[nodiscard]] Vec3 specific_force(const Vec3& wind_ned_mps) const;
  [[nodiscard]] bool on_ground() const { return touches_ground(params_.ground, state_); }
  /// For a start in flight.
  void set_speeds(const RotorSpeeds& speeds_radps) { speeds_ = speeds_radps; }

 private:
  [[nodiscard]] Wrench wrench(const RigidBodyState& state, const RotorSpeeds& speeds_radps,
                              const Vec3& wind_ned_mps) const;

  HexarotorParams params_;
  RigidBodyState state_;
  RotorSpeeds speeds_{};
};

}  // namespace skein::models
