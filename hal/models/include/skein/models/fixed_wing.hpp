// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "skein/models/ground_contact.hpp"
#include "skein/models/lift_rotors.hpp"
#include "skein/models/rigid_body.hpp"

namespace skein::models {

/// An electric motor with a fixed propeller (Beard and McLain, eq. 4.17-4.22 of the edition of 2020
/// and its supplement on propulsion): C_T and C_Q are quadratic in the advance ratio, the speed is
/// where the motor's torque equals the propeller's.
struct PropulsionParams {
  double diameter_m = 0.0;
  double ct0 = 0.0, ct1 = 0.0, ct2 = 0.0;
  double cq0 = 0.0, cq1 = 0.0, cq2 = 0.0;
  double volts_max = 0.0;
  double volts_per_radps = 0.0;  ///< K_V, and K_Q in N m / A
  double resistance_ohm = 0.0;
  double no_load_amps = 0.0;
};

/// Aerodynamic coefficients (Beard and McLain, table E.2). Angles in rad, rates normalised by
/// chord / (2 airspeed) lengthwise and span / (2 airspeed) sideways.
struct AerodynamicParams {
  double cl0 = 0.0, cl_alpha = 0.0, cl_q = 0.0, cl_elevator = 0.0;
  double cd_parasitic = 0.0, cd_q = 0.0, cd_elevator = 0.0;
  double cm0 = 0.0, cm_alpha = 0.0, cm_q = 0.0, cm_elevator = 0.0;
  double cy0 = 0.0, cy_beta = 0.0, cy_p = 0.0, cy_r = 0.0, cy_aileron = 0.0, cy_rudder = 0.0;
  double croll0 = 0.0, croll_beta = 0.0, croll_p = 0.0, croll_r = 0.0, croll_aileron = 0.0,
         croll_rudder = 0.0;
  double cn0 = 0.0, cn_beta = 0.0, cn_p = 0.0, cn_r = 0.0, cn_aileron = 0.0, cn_rudder = 0.0;
  double oswald = 1.0;
  double stall_rad = 0.0;        ///< where lift passes over to that of a flat plate
  double stall_sharpness = 0.0;  ///< M of eq. 4.10
};

struct FixedWingParams {
  MassProperties mass{1.0, Eigen::Matrix3d::Identity()};
  double wing_area_m2 = 0.0;
  double span_m = 0.0;
  double chord_m = 0.0;
  double air_density_kgpm3 = 1.225;
  AerodynamicParams aero;
  PropulsionParams propulsion;
  double servo_time_s = 0.0;     ///< first-order lag of the surfaces, > 0
  double throttle_time_s = 0.0;  ///< and of the motor's voltage, > 0
  double surface_max_rad = 0.0;
  GroundContactParams ground;
  std::optional<LiftRotorParams> lift = {};  ///< of a quadplane
};

/// The Aerosonde: tables E.1-E.3 of Beard and McLain, 11 kg, 2.9 m span, 25 m/s. Their table gives
/// the drag at no lift as 0.043 (C_D0), and their formula's parasitic part C_Dp as 0; it is 0.043
/// here, since a vehicle without it would glide as none does. Lag, limits and wheels are ours.
[[nodiscard]] FixedWingParams aerosonde();

/// The dynamically similar (Froude) vehicle of `scale` times the length: mass by the cube, inertia
/// by the fifth power, speeds and times by the square root, so that angles and coefficients stay.
[[nodiscard]] FixedWingParams froude_scaled(const FixedWingParams& params, double scale);

/// A vehicle for missions at 40 to 70 m/s: the Aerosonde at twice its length (88 kg, 5.8 m; 50 m/s
/// are as 35 m/s to the original, lift coefficient 0.27). The Aerosonde's own propeller gives no
/// thrust above 28 m/s (40 scaled), so this one has twice the pitch (the same coefficients over
/// half the advance ratio, and twice the torque, so that efficiency stays) and 20 % more voltage.
[[nodiscard]] FixedWingParams fast_fixed_wing();

/// A vehicle for missions at 15 to 35 m/s: fast_fixed_wing() at a quarter of its length (1.4 kg,
/// 1.45 m, 25 m/s are as 50 to the other). What was measured of ArduPlane 4.6.3's own simulated
/// plane is put on it: a weak fin and strong yaw damping, so that without rudder it slips by 3
/// degrees and turns at 0.73 of what its bank should give; twice the drag, and the motor for it.
[[nodiscard]] FixedWingParams small_fixed_wing();

/// small_fixed_wing() with four rotors that lift 1.9 times its weight, a quarter of a metre ahead,
/// behind and to the sides.
[[nodiscard]] FixedWingParams small_quadplane();

/// Deflections in rad; positive elevator is trailing edge down (nose down), positive aileron rolls
/// right, positive rudder yaws left.
struct FixedWingInput {
  double elevator_rad = 0.0;
  double aileron_rad = 0.0;
  double rudder_rad = 0.0;
  double throttle = 0.0;  ///< [0, 1]
  RotorShares rotors{};   ///< of a quadplane
};

struct AirData {
  double airspeed_mps = 0.0;
  double alpha_rad = 0.0;
  double beta_rad = 0.0;
};
[[nodiscard]] AirData air_data(const RigidBodyState& state, const Vec3& wind_ned_mps);

struct Propulsion {
  double thrust_n = 0.0;
  double torque_nm = 0.0;
  double shaft_radps = 0.0;
};
[[nodiscard]] Propulsion propulsion(const PropulsionParams& params, double air_density_kgpm3,
                                    double airspeed_mps, double throttle);

/// Lift coefficient without elevator and pitch rate, blended into the flat plate's beyond the stall
/// (eq. 4.9, 4.10).
[[nodiscard]] double lift_coefficient(const AerodynamicParams& params, double alpha_rad);

/// Air and propeller on the vehicle; neither gravity nor the ground.
[[nodiscard]] Wrench fixed_wing_wrench(const FixedWingParams& params, const RigidBodyState& state,
                                       const FixedWingInput& input, const Vec3& wind_ned_mps);

/// The vehicle with its servos and motors. Deterministic; allocates nothing.
class FixedWing {
 public:
  FixedWing(const FixedWingParams& params, const RigidBodyState& state,
            const FixedWingInput& actuators);

  /// Advances by one step of Runge-Kutta with command and wind held. Up to 10 ms in the air, 2.5 ms
  /// with ground contact. Commands beyond the limits are limited.
  void step(const FixedWingInput& command, const Vec3& wind_ned_mps, double seconds);

  [[nodiscard]] const RigidBodyState& state() const { return state_; }
  [[nodiscard]] const FixedWingInput& actuators() const { return actuators_; }
  [[nodiscard]] const FixedWingParams& params() const { return params_; }
  /// What accelerometers at the centre of mass feel, body axes, m/s^2.
  [[nodiscard]] Vec3 specific_force(const Vec3& wind_ned_mps) const;
  [[nodiscard]] bool on_ground() const { return touches_ground(params_.ground, state_); }

 private:
  [[nodiscard]] Wrench wrench(const RigidBodyState& state, const FixedWingInput& actuators,
                              const Vec3& wind_ned_mps) const;

  FixedWingParams params_;
  RigidBodyState state_;
  FixedWingInput actuators_;
};

/// Steady flight: level, climbing, or in a turn without sideslip.
struct TrimCondition {
  double airspeed_mps = 0.0;
  double climb_angle_rad = 0.0;
  double turn_rate_radps = 0.0;  ///< positive turns right
};
struct Trim {
  RigidBodyState state;  ///< at the origin (mind the ground there), heading north
  FixedWingInput input;
  double residual = 0.0;  ///< greatest of the accelerations left, m/s^2 and rad/s^2
};
/// Newton's method on the six accelerations. Fails where none is found or it needs more than the
/// vehicle's throttle or deflections.
[[nodiscard]] Result<Trim> trim(const FixedWingParams& params, const TrimCondition& condition);

}  // namespace skein::models
