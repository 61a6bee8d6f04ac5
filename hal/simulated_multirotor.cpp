// SPDX-License-Identifier: Apache-2.0
#include "skein/hal/simulated_multirotor.hpp"

#include <algorithm>
#include <cmath>

#include "skein/base/angles.hpp"
#include "skein/base/attitude.hpp"

namespace skein::hal {
namespace {

/// A setpoint no higher than that is on the ground.
constexpr double kGround_m = 0.05;
/// From there on it sinks at kTouchdown_mps, wherever the setpoint is below.
constexpr double kTouchdownBelow_m = 0.5;
constexpr double kTouchdown_mps = 0.3;
/// Of the rotors, m/s^2 per m/s: what holds it back is known before the loops feel it.
constexpr double kDrag_per_s = 0.17;
constexpr Duration kFixPeriod = std::chrono::milliseconds{100};
constexpr double kFixFilter_s = 1.0;

double step_s() { return to_seconds(SimulatedMultirotor::kStep); }

/// Of the centre of mass above the ground, at rest on its feet.
double rest_height_m(const models::HexarotorParams& airframe) {
  const auto& ground = airframe.ground;
  const double feet = static_cast<double>(ground.points.size());
  return ground.points[0].z_m -
         airframe.mass.mass_kg() * kGravity_mps2 / (feet * ground.stiffness_n_per_m);
}

models::HexarotorParams airframe_on(double ground_z_m) {
  models::HexarotorParams airframe = models::firefly();
  airframe.ground.ground_down_m = -ground_z_m;
  return airframe;
}

models::RigidBodyState parked(const models::HexarotorParams& airframe, const Vec2& north_east_m,
                              double yaw_ned_rad) {
  models::RigidBodyState state;
  state.position_m << north_east_m, airframe.ground.ground_down_m - rest_height_m(airframe);
  state.attitude = attitude_from({.yaw_rad = yaw_ned_rad});
  return state;
}

Vec3 steady_wind_ned_mps(const SimulatedMultirotorParams& params) {
  return ned_from_enu({params.wind_mps.x(), params.wind_mps.y(), 0.0});
}

/// The wind at 6 m of the Dryden gusts that have this standard deviation there.
double wind_of_gusts(double gust_mps) {
  constexpr double kSixMetres = 6.096;
  return gust_mps / models::gust_scales(kSixMetres, 1.0).along_mps;
}

}  // namespace

SimulatedMultirotor::SimulatedMultirotor(const SimulatedMultirotorParams& params)
    : params_{params},
      airframe_{airframe_on(params.start.z())},
      vehicle_{airframe_, parked(airframe_, ned_from_enu(params.start.metres()).head<2>(),
                                 yaw_from_heading(params.yaw_rad))},
      loops_{params.tuning},
      gusts_{wind_of_gusts(params.gust_mps), params.seed},
      wind_ned_mps_{steady_wind_ned_mps(params)} {
  if (params.gnss) {
    gnss_.emplace(*params.gnss, params.seed + 1);
    sense();
  }
}

double SimulatedMultirotor::height_m() const {
  return airframe_.ground.ground_down_m - rest_height_m(airframe_) -
         vehicle_.state().position_m.z();
}

Position<MissionEnu> SimulatedMultirotor::true_position() const {
  const Vec3 enu = enu_from_ned(vehicle_.state().position_m);
  return {enu.x(), enu.y(), params_.start.z() + height_m()};
}

void SimulatedMultirotor::sense() {
  const models::RigidBodyState& truth = vehicle_.state();
  const models::GnssSample fix = gnss_->sample(truth, to_seconds(kFixPeriod));
  const double share = to_seconds(kFixPeriod) / kFixFilter_s;
  const Vec3 position_error = fix.position_m - truth.position_m;
  const Vec3 velocity_error = fix.velocity_mps - truth.velocity_ned_mps();
  position_error_m_ += share * (position_error - position_error_m_);
  velocity_error_mps_ += share * (velocity_error - velocity_error_mps_);
}

PositionSetpoint SimulatedMultirotor::point() const {
  const Duration age = flown_to_ - *setpoint_at_;
  PositionSetpoint point = setpoint_.carried_on(to_seconds(std::min(age, kSetpointAgeMax)));
  if (age <= kSetpointAgeMax) return point;
  const Eigen::Vector3d velocity = point.velocity_mps();
  const double speed = velocity.norm();
  const double braked_s = std::min(to_seconds(age - kSetpointAgeMax), speed / kBrake_mps2);
  const bool moves = braked_s * kBrake_mps2 < speed;
  const Eigen::Vector3d brake = speed > 0.0 ? Eigen::Vector3d{-kBrake_mps2 / speed * velocity}
                                            : Eigen::Vector3d{Eigen::Vector3d::Zero()};
  point.ax_mps2 = brake.x();
  point.ay_mps2 = brake.y();
  point.az_mps2 = brake.z();
  point = point.carried_on(braked_s);
  if (moves) return point;
  point.vx_mps = point.vy_mps = point.vz_mps = 0.0;
  point.ax_mps2 = point.ay_mps2 = point.az_mps2 = 0.0;
  return point;
}

autopilot::MotionDemand SimulatedMultirotor::demand(const PositionSetpoint& point) const {
  const Vec3 position = ned_from_enu(point.position_m());
  autopilot::MotionDemand demand{
      .horizontal_m = Vec2{position.head<2>()},
      .down_m = position.z() - rest_height_m(airframe_),
      .velocity_mps = ned_from_enu(point.velocity_mps()),
      .acceleration_mps2 =
          ned_from_enu(point.acceleration_mps2() + kDrag_per_s * point.velocity_mps()),
      .yaw_rad = yaw_from_heading(point.yaw_rad)};
  const bool lands = point.z_m <= params_.start.z() + kGround_m;
  if (lands) {
    // However deep below the ground the point is.
    demand.down_m = airframe_.ground.ground_down_m - rest_height_m(airframe_);
    demand.velocity_mps.z() = 0.0;
    demand.acceleration_mps2.z() = 0.0;
    if (height_m() < kTouchdownBelow_m) {
      demand.down_m.reset();
      demand.velocity_mps.z() = kTouchdown_mps;
    }
  }
  return demand;
}

void SimulatedMultirotor::step() {
  if (gnss_) until_fix_ -= kStep;
  if (gnss_ && until_fix_ <= Duration{}) {
    until_fix_ += kFixPeriod;
    sense();
  }
  const models::RigidBodyState& truth = vehicle_.state();
  const Vec3 velocity = truth.velocity_ned_mps();
  const double air_mps = (velocity - wind_ned_mps_).norm();
  wind_ned_mps_ = steady_wind_ned_mps(params_);
  if (params_.gust_mps > 0.0) {
    (void)gusts_.step(step_s(), air_mps, std::max(height_m(), 0.0));
    wind_ned_mps_ += gusts_.velocity_ned_mps(euler_angles(truth.attitude).yaw_rad);
  }
  const PositionSetpoint at = point();
  const autopilot::RotorCommand command =
      loops_.fly({.position_m = truth.position_m + position_error_m_,
                  .velocity_mps = velocity + velocity_error_mps_,
                  .attitude = truth.attitude,
                  .rates_radps = truth.rates_radps},
                 demand(at), step_s());
  models::RotorSpeeds speeds{};
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    speeds.at(i) = airframe_.speed_max_radps * std::sqrt(command.thrust.at(i));
  }
  vehicle_.step(speeds, wind_ned_mps_, step_s());
  distance_flown_m_ += step_s() * vehicle_.state().velocity_ned_mps().head<2>().norm();
  const bool grounded = at.z_m <= params_.start.z() + kGround_m && height_m() < kGround_m;
  grounded_ = grounded ? grounded_ + kStep : Duration{};
  if (grounded_ >= kLanded) rest();
}

void SimulatedMultirotor::rest() {
  const models::RigidBodyState& at = vehicle_.state();
  vehicle_ = models::Hexarotor{
      airframe_, parked(airframe_, at.position_m.head<2>(), euler_angles(at.attitude).yaw_rad)};
  flying_ = false;
}

void SimulatedMultirotor::advance_to(Instant now) {
  while (flown_to_ + kStep <= now) {
    if (!flying_) {
      const bool lifts = setpoint_at_ && flown_to_ - *setpoint_at_ <= kSetpointAgeMax &&
                         setpoint_.z_m > params_.start.z() + kGround_m;
      if (!lifts) {
        flown_to_ += (now - flown_to_) / kStep * kStep;
        return;
      }
      flying_ = true;
      grounded_ = {};
      loops_.reset();
    }
    step();
    flown_to_ += kStep;
  }
}

std::optional<VehicleState> SimulatedMultirotor::state(Instant now) {
  advance_to(now);
  const models::RigidBodyState& truth = vehicle_.state();
  const Vec3 velocity =
      flying_ ? enu_from_ned(truth.velocity_ned_mps() + velocity_error_mps_) : Vec3{Vec3::Zero()};
  // At rest before mission time 0, and less than a step behind after it.
  const double behind_s = std::max(0.0, to_seconds(now - flown_to_));
  const Vec3 position = enu_from_ned(truth.position_m + position_error_m_) + behind_s * velocity;
  VehicleState state;
  state.time = now;
  state.x_m = position.x();
  state.y_m = position.y();
  state.z_m = position.z() - rest_height_m(airframe_);
  state.heading_rad = heading_from_yaw(euler_angles(truth.attitude).yaw_rad);
  state.groundspeed_mps = velocity.head<2>().norm();
  state.course_rad =
      state.groundspeed_mps > 0.0 ? std::atan2(velocity.y(), velocity.x()) : state.heading_rad;
  state.airspeed_mps = (truth.velocity_ned_mps() - wind_ned_mps_).norm();
  state.climb_mps = velocity.z();
  state.phase = flying_ ? FlightPhase::flying : FlightPhase::disarmed;
  state.distance_flown_m = distance_flown_m_;
  return state;
}

void SimulatedMultirotor::command(const Demand& demand, Instant now) {
  const auto* setpoint = std::get_if<PositionSetpoint>(&demand);
  if (setpoint == nullptr || !setpoint->finite()) return;
  advance_to(now);  // the setpoint before this one stood until now
  setpoint_ = *setpoint;
  setpoint_at_ = now;
}

}  // namespace skein::hal
