// SPDX-License-Identifier: Apache-2.0
#include "skein/autopilot/vtol_flight.hpp"

#include <algorithm>
#include <cmath>

#include "rotor_mix.hpp"
#include "skein/base/assert.hpp"
#include "skein/base/attitude.hpp"

namespace skein::autopilot {
namespace {

/// Over its place.
constexpr double kOver_m = 1.5;
constexpr double kStill_mps = 0.8;
/// The ground holds it up: it sinks no more though it is told to.
constexpr double kRestsShare = 0.3;
constexpr double kSinkTime_s = 0.5;
constexpr double kAccelerates_rad = 0.02;  ///< the nose, on the way to the wings

}  // namespace

VtolFlight::VtolFlight(const VtolParams& params) : params_{params}, loops_{params.tuning} {}

void VtolFlight::hover(const Estimate& estimate, const std::optional<Vec2>& place_m,
                       double height_m) {
  const bool fast = estimate.airspeed_mps > params_.brakes_until_mps;
  if (!carries()) {
    loops_.reset();
    yaw_rad_ = euler_angles(estimate.attitude).yaw_rad;
  }
  phase_ = fast ? Phase::brake : Phase::hover;
  sets_down_ = false;
  rested_s_ = 0.0;
  stops_anywhere_ = !place_m;
  place_m_ = place_m.value_or(estimate.position_m.head<2>());
  height_m_ = height_m;
}

void VtolFlight::set_down(const Estimate& estimate, const std::optional<Vec2>& place_m,
                          double ground_m) {
  hover(estimate, place_m, estimate.height_m());
  sets_down_ = true;
  ground_m_ = ground_m;
}

void VtolFlight::fly_on_wings(const Estimate& estimate) {
  if (!carries()) return;
  if (phase_ != Phase::transition) {
    yaw_rad_ = euler_angles(estimate.attitude).yaw_rad;
    height_m_ = estimate.height_m();
  }
  phase_ = Phase::transition;
}

void VtolFlight::stop() {
  phase_ = Phase::wings;
  thrust_n_ = fading_n_ = 0.0;
  rotors_.fill(0.0);
}

double VtolFlight::stopping_m(double groundspeed_mps) const {
  return groundspeed_mps * groundspeed_mps / (2.0 * params_.braking_mps2);
}

MotionDemand VtolFlight::level(const Estimate& estimate) const {
  MotionDemand demand;
  demand.down_m = -height_m_;
  demand.velocity_mps.head<2>() = estimate.velocity_mps.head<2>();
  demand.yaw_rad = yaw_rad_;
  return demand;
}

MotionDemand VtolFlight::sinking(const Estimate& estimate) const {
  const bool near = estimate.height_m() < ground_m_ + params_.touch_from_m;
  MotionDemand demand;
  demand.horizontal_m = place_m_;
  demand.velocity_mps.z() = near ? params_.touch_mps : params_.tuning.sink_max_mps;
  demand.yaw_rad = yaw_rad_;
  demand.speed_max_mps = params_.approach_mps;
  return demand;
}

SurfaceCommand VtolFlight::step(const Estimate& estimate, FixedWingLoops& wings, double seconds) {
  SKEIN_ASSERT(carries() && seconds > 0.0);
  switch (phase_) {
    case Phase::transition:
      lift(loops_.fly(estimate, level(estimate), seconds));
      if (estimate.airspeed_mps >= params_.wings_from_mps) {
        phase_ = Phase::wings;
        fading_n_ = thrust_n_;
      }
      return wings.hold_attitude(estimate, 0.0, kAccelerates_rad, wings.tuning().throttle_max,
                                 seconds);
    case Phase::brake:
      lift(loops_.fly(estimate, level(estimate), seconds));
      if (stops_anywhere_) place_m_ = estimate.position_m.head<2>();
      if (estimate.airspeed_mps <= params_.brakes_until_mps) phase_ = Phase::hover;
      return wings.hold_attitude(estimate, 0.0, 0.0, 0.0, seconds);
    case Phase::hover: {
      MotionDemand demand;
      demand.horizontal_m = place_m_;
      demand.down_m = -height_m_;
      demand.yaw_rad = yaw_rad_;
      demand.speed_max_mps = params_.approach_mps;
      lift(loops_.fly(estimate, demand, seconds));
      const bool over = (place_m_ - estimate.position_m.head<2>()).norm() < kOver_m &&
                        estimate.groundspeed_mps() < kStill_mps;
      if (sets_down_ && over) {
        phase_ = Phase::sink;
        sink_mps_ = params_.touch_mps;
      }
      break;
    }
    case Phase::sink: {
      const MotionDemand demand = sinking(estimate);
      lift(loops_.fly(estimate, demand, seconds));
      sink_mps_ += (-estimate.climb_mps() - sink_mps_) * std::min(1.0, seconds / kSinkTime_s);
      const bool rests = demand.velocity_mps.z() == params_.touch_mps &&
                         sink_mps_ < kRestsShare * params_.touch_mps;
      rested_s_ = rests ? rested_s_ + seconds : 0.0;
      break;
    }
    case Phase::wings:
      break;
  }
  return {};
}

void VtolFlight::fade(double seconds) {
  thrust_n_ = std::max(0.0, thrust_n_ - fading_n_ * seconds / params_.fade_s);
  lift({.thrust_n = thrust_n_});
}

void VtolFlight::lift(const LiftDemand& demand) {
  const double full = params_.rotor_thrust_max_n;
  constexpr auto kCount = static_cast<double>(kRotors);
  // Signs of the X: what a thrust there rolls, pitches and yaws by.
  constexpr std::array<double, kRotors> kRoll{-1.0, 1.0, 1.0, -1.0};
  constexpr std::array<double, kRotors> kPitch{1.0, -1.0, 1.0, -1.0};
  constexpr std::array<double, kRotors> kYaw{1.0, 1.0, -1.0, -1.0};
  std::array<double, kRotors> tilt{};
  std::array<double, kRotors> yaw{};
  for (std::size_t i = 0; i < kRotors; ++i) {
    tilt[i] = (kRoll[i] * demand.moment_nm.x() / params_.arm_right_m +
               kPitch[i] * demand.moment_nm.y() / params_.arm_forward_m) /
              (kCount * full);
    yaw[i] = kYaw[i] * demand.moment_nm.z() / (kCount * params_.torque_per_lift_m * full);
  }
  thrust_n_ = demand.thrust_n;
  rotors_ = fitted_shares(demand.thrust_n / (kCount * full), tilt, yaw);
}

}  // namespace skein::autopilot
