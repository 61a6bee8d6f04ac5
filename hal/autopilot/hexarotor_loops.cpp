// SPDX-License-Identifier: Apache-2.0
#include "skein/autopilot/hexarotor_loops.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "rotor_mix.hpp"
#include "skein/base/angles.hpp"

namespace skein::autopilot {
namespace {

constexpr std::size_t kRotors = RotorCommand::kRotors;

double bearing(std::size_t rotor) { return radians(30.0 + 60.0 * static_cast<double>(rotor)); }

}  // namespace

double RotorCommand::mean() const {
  return std::accumulate(thrust.begin(), thrust.end(), 0.0) / static_cast<double>(kRotors);
}

RotorCommand mix(const HexarotorTuning& tuning, const LiftDemand& demand) {
  constexpr auto kCount = static_cast<double>(kRotors);
  const double full = tuning.rotor_thrust_max_n;
  const Vec3& moment = demand.moment_nm;
  std::array<double, kRotors> tilt{};
  std::array<double, kRotors> yaw{};
  for (std::size_t i = 0; i < kRotors; ++i) {
    // The columns are orthogonal: sin^2 and cos^2 sum to 3 over the rotors.
    tilt[i] = (-std::sin(bearing(i)) * moment.x() + std::cos(bearing(i)) * moment.y()) /
              (0.5 * kCount * tuning.arm_m * full);
    yaw[i] = (i % 2 == 0 ? -1.0 : 1.0) * moment.z() / (kCount * tuning.torque_per_lift_m * full);
  }
  return {fitted_shares(demand.thrust_n / (kCount * full), tilt, yaw)};
}

double HexarotorLoops::hover_thrust() const {
  return tuning_.mass_kg * kGravity_mps2 /
         (static_cast<double>(kRotors) * tuning_.rotor_thrust_max_n);
}

RotorCommand HexarotorLoops::fly(const Estimate& estimate, const MotionDemand& demand,
                                 double seconds) {
  return mix(tuning_, lift_.fly(estimate, demand, seconds));
}

RotorCommand HexarotorLoops::hold_attitude(const Estimate& estimate, double roll_rad,
                                           double pitch_rad, double yaw_rad, double yaw_rate_radps,
                                           double thrust, double seconds) {
  const double full = static_cast<double>(kRotors) * tuning_.rotor_thrust_max_n;
  return mix(tuning_, lift_.hold_attitude(estimate, roll_rad, pitch_rad, yaw_rad, yaw_rate_radps,
                                          full * std::clamp(thrust, 0.0, 1.0), seconds));
}

}  // namespace skein::autopilot
