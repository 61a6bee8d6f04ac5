// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "skein/autopilot/estimate.hpp"

namespace skein::autopilot {

struct PitchAndThrottle {
  double pitch_rad = 0.0;
  double throttle = 0.0;
};

/// Airspeed and height as ArduPlane 4.6.3 in its simulator holds them with TECS_SPDWEIGHT 0, as the
/// bench gives it: airspeeds late, heights by pitch alone. Limits and gains of the pitch are its
/// parameters or near them, those of airspeed and throttle fitted to its log (TECS, 20 to 29 m/s).
struct SlowEnergyTuning {
  double height_lag_s = 3.0;         ///< TECS_HDEM_TCONST: heights asked for are followed by it
  double height_rate_max_mps = 5.0;  ///< TECS_CLMB_MAX, TECS_SINK_MAX
  double faster_power = 20.6;        ///< m^2/s^3: an airspeed asked for rises by this / airspeed
  double slower_mps2 = 0.74;         ///< and falls by this at most
  double throttle_rate_per_s = 1.0;  ///< THR_SLEWRATE
  double vertical_acceleration_mps2 = 7.0;  ///< TECS_VERT_ACC: how the pitch asked for changes
  double time_s = 4.3;                      ///< what energy errors are taken back in by throttle
  double pitch_time_s = 10.0;               ///< and by pitch: TECS_TIME_CONST is 5
  double power_range = 167.0;               ///< m^2/s^3 that all of the throttle is taken to give
  double throttle_damping = 0.7;
  double throttle_integral_per_s = 0.3;
  double pitch_damping = 0.3;         ///< TECS_PTCH_DAMP
  double airspeed_lag_s = 1.4;        ///< of the airspeed that is asked for
  double pitch_integral_per_s = 0.2;  ///< TECS_INTEG_GAIN is 0.3
};

/// What the airframe needs for level flight, and its limits.
struct EnergyLimits {
  double throttle_level = 0.0;  ///< at cruise: what other airspeeds take is the integral's
  double throttle_max = 1.0;
  double pitch_trim_rad = 0.0;  ///< that the integral begins with
  double pitch_min_rad = 0.0;
  double pitch_max_rad = 0.0;
  double airspeed_least_mps = 1.0;
};

/// Total energy control (Lambregts 1983) with errors of energy in place of rates: throttle for the
/// sum of height's and speed's, pitch for the height's. There is no feedforward of the angle of
/// attack, so that each change of speed or bank goes through the integral, and height swings.
class EnergyLoop {
 public:
  explicit EnergyLoop(const SlowEnergyTuning& tuning) : t_{tuning} {}

  /// Precondition: seconds > 0.
  [[nodiscard]] PitchAndThrottle step(const Estimate& estimate, double height_m,
                                      double airspeed_mps, const EnergyLimits& limits,
                                      double seconds);

 private:
  struct State {
    double height_m = 0.0;      ///< asked for, as it is followed
    double asked_mps = 0.0;     ///< airspeed, after its lag
    double airspeed_mps = 0.0;  ///< and its ramp
    double pitch_power = 0.0;   ///< integral, m^2/s^3
    double pitch_rad = 0.0;
    double throttle_integral = 0.0;
    double throttle = 0.0;
    double acceleration_mps2 = 0.0;  ///< flown, filtered
  };
  [[nodiscard]] State begun(const Estimate& estimate, const EnergyLimits& limits) const;

  SlowEnergyTuning t_;
  std::optional<State> state_;
};

}  // namespace skein::autopilot
