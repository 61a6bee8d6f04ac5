// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <string>

#include "skein/models/fixed_wing.hpp"

namespace skein::models {
namespace {

/// Angle of attack, bank about the path, elevator, aileron, rudder, throttle.
using Unknowns = Eigen::Matrix<double, 6, 1>;

struct Flight {
  RigidBodyState state;
  FixedWingInput input;
};

Flight flight_of(const TrimCondition& condition, const Unknowns& x) {
  using Eigen::AngleAxisd;
  Flight flight;
  flight.state.attitude =
      Eigen::Quaterniond{AngleAxisd{condition.climb_angle_rad, Vec3::UnitY()} *
                         AngleAxisd{x[1], Vec3::UnitX()} * AngleAxisd{x[0], Vec3::UnitY()}};
  flight.state.velocity_mps = condition.airspeed_mps * Vec3{std::cos(x[0]), 0.0, std::sin(x[0])};
  flight.state.rates_radps =
      flight.state.attitude.conjugate() * Vec3{0.0, 0.0, condition.turn_rate_radps};
  flight.input = {x[2], x[3], x[4], x[5]};
  return flight;
}

Unknowns accelerations(const FixedWingParams& params, const TrimCondition& condition,
                       const Unknowns& x) {
  const Flight flight = flight_of(condition, x);
  const RigidBodyVector rate = rigid_body_derivative(
      flight.state, fixed_wing_wrench(params, flight.state, flight.input, Vec3::Zero()),
      params.mass);
  Unknowns result;
  result << rate.segment<3>(3), rate.segment<3>(10);
  return result;
}

}  // namespace

Result<Trim> trim(const FixedWingParams& params, const TrimCondition& condition) {
  if (!(condition.airspeed_mps > 0.0)) return Error{"trim: the airspeed must be positive"};
  Unknowns x = Unknowns::Zero();
  x[1] = std::atan(condition.airspeed_mps * condition.turn_rate_radps / kGravity_mps2);
  x[5] = 0.5;
  Unknowns residual = accelerations(params, condition, x);
  for (int iteration = 0; iteration < 50 && residual.cwiseAbs().maxCoeff() > 1e-11; ++iteration) {
    Eigen::Matrix<double, 6, 6> jacobian;
    for (Eigen::Index i = 0; i < 6; ++i) {
      constexpr double kStep = 1e-6;
      Unknowns up = x;
      Unknowns down = x;
      up[i] += kStep;
      down[i] -= kStep;
      jacobian.col(i) =
          (accelerations(params, condition, up) - accelerations(params, condition, down)) /
          (2.0 * kStep);
    }
    const Unknowns change = jacobian.fullPivLu().solve(residual);
    // Bounded steps: beyond a fifth of a radian the linear model says nothing.
    x -= change * std::min(1.0, 0.2 / std::max(change.cwiseAbs().maxCoeff(), 1e-12));
    residual = accelerations(params, condition, x);
  }
  const double left = residual.cwiseAbs().maxCoeff();
  const std::string at = "trim at " + std::to_string(condition.airspeed_mps) + " m/s: ";
  if (!(left < 1e-8)) return Error{at + "no steady flight found; ask for a gentler one"};
  const Flight flight = flight_of(condition, x);
  const double surface =
      std::max({std::abs(flight.input.elevator_rad), std::abs(flight.input.aileron_rad),
                std::abs(flight.input.rudder_rad)});
  if (surface > params.surface_max_rad || flight.input.throttle < 0.0 ||
      flight.input.throttle > 1.0 || std::abs(x[0]) > params.aero.stall_rad) {
    return Error{at + "it needs more than throttle, surfaces or wing give"};
  }
  return Trim{flight.state, flight.input, left};
}

}  // namespace skein::models
