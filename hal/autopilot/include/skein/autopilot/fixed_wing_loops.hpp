// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "skein/autopilot/energy_loop.hpp"
#include "skein/autopilot/estimate.hpp"

namespace skein::autopilot {

/// Deflections in rad, with the signs of Beard and McLain: positive elevator noses down, positive
/// aileron rolls right, positive rudder yaws left. Throttle in [0, 1].
struct SurfaceCommand {
  double elevator_rad = 0.0;
  double aileron_rad = 0.0;
  double rudder_rad = 0.0;
  double throttle = 0.0;
};

/// A rate loop: feedforward of the wanted rate, proportional and integral of its error.
struct RateGains {
  double feedforward_s = 0.0;
  double proportional_s = 0.0;
  double integral = 0.0;
};

/// What the loops know about the airframe. The defaults fly models::fast_fixed_wing().
struct FixedWingTuning {
  double airspeed_min_mps = 40.0;
  double airspeed_cruise_mps = 50.0;
  double airspeed_max_mps = 70.0;
  double reference_airspeed_mps = 50.0;  ///< at which the gains below were set

  double roll_max_rad = 1.134;  ///< 65 degrees: load factor 2.4
  double pitch_max_rad = 0.35;
  double pitch_min_rad = -0.26;
  double roll_gain_per_s = 5.0;  ///< angle error to rate
  double pitch_gain_per_s = 3.0;
  double roll_rate_max_radps = 1.6;
  double pitch_rate_max_radps = 0.6;
  RateGains roll{.feedforward_s = 0.17, .proportional_s = 0.12, .integral = 0.3};
  RateGains pitch{.feedforward_s = 0.5, .proportional_s = 0.4, .integral = 1.5};
  double yaw_gain_s = 0.25;             ///< rudder for yaw rate beyond that of the turn
  double sideslip_gain_s_per_m = 0.01;  ///< yaw rate for lateral acceleration, rad/s per m/s^2
  double surface_max_rad = 0.436;

  /// Angle of attack at load factor n and the reference airspeed: zero_lift + n * per_load.
  double alpha_zero_lift_rad = -0.0432;
  double alpha_per_load_rad = 0.0478;
  /// Throttle for level flight at the reference airspeed, and what changes it.
  double throttle_level = 0.589;
  double throttle_per_mps = 0.0119;
  double throttle_per_power = 0.0017;  ///< per m^2/s^3 of specific power wanted
  double throttle_max = 1.0;

  double climb_max_mps = 8.0;
  double sink_max_mps = 8.0;
  double height_time_s = 4.0;    ///< height error to climb rate
  double airspeed_time_s = 1.5;  ///< airspeed error to acceleration
  double acceleration_max_mps2 = 2.5;
  double power_gain = 0.002;             ///< throttle per m^2/s^3 of power missing
  double power_integral_per_s = 0.0008;  ///< and per second
  double balance_gain = 0.3;             ///< climb angle per climb angle missing
  double balance_integral_per_s = 0.3;   ///< and per second

  /// In place of the seven above: height and airspeed as ArduPlane holds them.
  std::optional<SlowEnergyTuning> slow_energy;

  double heading_gain_per_s = 1.2;  ///< course or heading error to turn rate
};

/// The tuning for an airframe that is `scale` times as long (models::froude_scaled): speeds and
/// times go by the root, angles and accelerations stay. Precondition: scale > 0.
[[nodiscard]] FixedWingTuning froude_scaled(const FixedWingTuning& tuning, double scale);

/// What guidance asks for.
struct FlightDemand {
  double lateral_mps2 = 0.0;  ///< positive to the right
  double height_m = 0.0;
  double airspeed_mps = 0.0;
};

/// The cascaded loops of a fixed wing: lateral acceleration to bank (coordinated turn), height and
/// airspeed to pitch and throttle by total energy (Lambregts 1983), attitude to body rates, rates
/// to surfaces with gains that go down with dynamic pressure. Pure: the time step is an argument.
class FixedWingLoops {
 public:
  explicit FixedWingLoops(const FixedWingTuning& tuning);

  /// Forgets the integrals, for a start on the ground or a change of hands.
  void reset() { *this = FixedWingLoops{tuning_}; }

  /// Bank for a coordinated turn at that acceleration, within roll_max.
  [[nodiscard]] double bank_for(double lateral_mps2) const;

  /// Everything. Precondition for all: seconds > 0.
  SurfaceCommand fly(const Estimate& estimate, const FlightDemand& demand, double seconds);
  /// Roll as given, and height and airspeed held.
  SurfaceCommand hold_roll(const Estimate& estimate, double roll_rad, double height_m,
                           double airspeed_mps, double seconds);
  /// Attitude and throttle as given; limits apply.
  SurfaceCommand hold_attitude(const Estimate& estimate, double roll_rad, double pitch_rad,
                               double throttle, double seconds);

  /// The bank and pitch last aimed at, for reports.
  [[nodiscard]] double roll_demand_rad() const { return roll_demand_; }
  [[nodiscard]] double pitch_demand_rad() const { return pitch_demand_; }
  [[nodiscard]] const FixedWingTuning& tuning() const { return tuning_; }

 private:
  SurfaceCommand attitude(const Estimate& estimate, double roll_rad, double pitch_rad,
                          double throttle, double seconds);
  PitchAndThrottle slow_energy(const Estimate& estimate, double height_m, double airspeed_mps,
                               double seconds);
  PitchAndThrottle energy(const Estimate& estimate, double height_m, double airspeed_mps,
                          double seconds);
  double surface(const RateGains& gains, double wanted, double rate, double airspeed_mps,
                 double& integral, double seconds) const;

  FixedWingTuning tuning_;
  double roll_integral_ = 0.0;
  double pitch_integral_ = 0.0;
  double throttle_integral_ = 0.0;
  double balance_integral_ = 0.0;
  std::optional<EnergyLoop> energy_loop_;
  double roll_demand_ = 0.0;
  double pitch_demand_ = 0.0;
};

}  // namespace skein::autopilot
