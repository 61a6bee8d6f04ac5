// SPDX-License-Identifier: Apache-2.0
#include "skein/models/fixed_wing.hpp"

#include <algorithm>
#include <cmath>

#include "skein/base/angles.hpp"
#include "skein/base/assert.hpp"
#include "skein/models/runge_kutta.hpp"

namespace skein::models {
namespace {

Eigen::Matrix3d inertia(double jx, double jy, double jz, double jxz) {
  Eigen::Matrix3d j;
  j << jx, 0.0, -jxz, 0.0, jy, 0.0, -jxz, 0.0, jz;
  return j;
}

RotorShares shares(const RotorShares& wanted) {
  RotorShares limited{};
  std::transform(wanted.begin(), wanted.end(), limited.begin(),
                 [](double share) { return std::clamp(share, 0.0, 1.0); });
  return limited;
}

FixedWingInput limited(const FixedWingInput& input, double surface_max_rad) {
  const auto surface = [&](double rad) {
    return std::clamp(rad, -surface_max_rad, surface_max_rad);
  };
  return {.elevator_rad = surface(input.elevator_rad),
          .aileron_rad = surface(input.aileron_rad),
          .rudder_rad = surface(input.rudder_rad),
          .throttle = std::clamp(input.throttle, 0.0, 1.0),
          .rotors = shares(input.rotors)};
}

constexpr int kServos = 4;
constexpr int kActuators = kServos + static_cast<int>(kLiftRotors);
using Actuators = Eigen::Matrix<double, kActuators, 1>;
using StateVector = Eigen::Matrix<double, kRigidBodySize + kActuators, 1>;

Actuators to_actuators(const FixedWingInput& input) {
  Actuators a;
  a << input.elevator_rad, input.aileron_rad, input.rudder_rad, input.throttle,
      Eigen::Map<const Eigen::Matrix<double, kLiftRotors, 1>>{input.rotors.data()};
  return a;
}

FixedWingInput input_of(const Actuators& a) {
  FixedWingInput input{a[0], a[1], a[2], a[3]};
  std::copy(a.data() + kServos, a.data() + kActuators, input.rotors.begin());
  return input;
}

Actuators lags_s(const FixedWingParams& p) {
  Actuators lags = Actuators::Constant(p.lift ? p.lift->time_s : 1.0);
  lags.head<3>().setConstant(p.servo_time_s);
  lags[3] = p.throttle_time_s;
  return lags;
}

}  // namespace

FixedWingParams aerosonde() {
  FixedWingParams p;
  p.mass = MassProperties{11.0, inertia(0.8244, 1.135, 1.759, 0.1204)};
  p.wing_area_m2 = 0.55;
  p.span_m = 2.8956;
  p.chord_m = 0.18994;
  p.air_density_kgpm3 = 1.2682;
  p.aero = {.cl0 = 0.23,
            .cl_alpha = 5.61,
            .cl_q = 7.95,
            .cl_elevator = 0.13,
            .cd_parasitic = 0.043,
            .cd_q = 0.0,
            .cd_elevator = 0.0135,
            .cm0 = 0.0135,
            .cm_alpha = -2.74,
            .cm_q = -38.21,
            .cm_elevator = -0.99,
            .cy0 = 0.0,
            .cy_beta = -0.98,
            .cy_p = 0.0,
            .cy_r = 0.0,
            .cy_aileron = 0.075,
            .cy_rudder = 0.19,
            .croll0 = 0.0,
            .croll_beta = -0.13,
            .croll_p = -0.51,
            .croll_r = 0.25,
            .croll_aileron = 0.17,
            .croll_rudder = 0.0024,
            .cn0 = 0.0,
            .cn_beta = 0.073,
            .cn_p = 0.069,
            .cn_r = -0.095,
            .cn_aileron = -0.011,
            .cn_rudder = -0.069,
            .oswald = 0.9,
            .stall_rad = 0.47,
            .stall_sharpness = 50.0};
  p.propulsion = {.diameter_m = 0.508,
                  .ct0 = 0.09357,
                  .ct1 = -0.06044,
                  .ct2 = -0.1079,
                  .cq0 = 0.005230,
                  .cq1 = 0.004970,
                  .cq2 = -0.01664,
                  .volts_max = 44.4,
                  .volts_per_radps = 60.0 / (kTwoPi * 145.0),
                  .resistance_ohm = 0.042,
                  .no_load_amps = 1.5};
  p.servo_time_s = 0.04;
  p.throttle_time_s = 0.1;
  p.surface_max_rad = radians(25.0);
  p.ground.points.push_back({0.45, 0.0, 0.25});
  p.ground.points.push_back({-0.1, 0.35, 0.25});
  p.ground.points.push_back({-0.1, -0.35, 0.25});
  p.ground.stiffness_n_per_m = 2000.0;
  p.ground.damping_ns_per_m = 120.0;
  p.ground.friction_along = 0.04;
  p.ground.friction_across = 0.5;
  return p;
}

FixedWingParams froude_scaled(const FixedWingParams& params, double scale) {
  SKEIN_ASSERT(scale > 0.0);
  const double root = std::sqrt(scale);
  FixedWingParams p = params;
  p.mass = MassProperties{params.mass.mass_kg() * std::pow(scale, 3),
                          params.mass.inertia_kgm2() * std::pow(scale, 5)};
  p.wing_area_m2 *= scale * scale;
  p.span_m *= scale;
  p.chord_m *= scale;
  // Voltage stays, so the current takes the whole of the power's scale^3.5.
  const double current = std::pow(scale, 3) * root;
  p.propulsion.diameter_m *= scale;
  p.propulsion.volts_per_radps *= root;
  p.propulsion.resistance_ohm /= current;
  p.propulsion.no_load_amps *= current;
  p.servo_time_s *= root;
  p.throttle_time_s *= root;
  for (auto& point : p.ground.points) {
    point.x_m *= scale;
    point.y_m *= scale;
    point.z_m *= scale;
  }
  p.ground.stiffness_n_per_m *= scale * scale;
  p.ground.damping_ns_per_m *= scale * scale * root;
  p.ground.slip_mps *= root;
  return p;
}

FixedWingParams fast_fixed_wing() {
  FixedWingParams p = froude_scaled(aerosonde(), 2.0);
  p.air_density_kgpm3 = 1.225;
  PropulsionParams& prop = p.propulsion;
  constexpr double kPitch = 2.0;
  prop.ct1 /= kPitch;
  prop.ct2 /= kPitch * kPitch;
  prop.cq0 *= kPitch;
  prop.cq2 /= kPitch;
  prop.resistance_ohm /= kPitch;
  prop.no_load_amps *= kPitch;
  prop.volts_max *= 1.2;
  p.servo_time_s = 0.05;
  p.throttle_time_s = 0.15;
  return p;
}

FixedWingParams small_fixed_wing() {
  FixedWingParams p = froude_scaled(fast_fixed_wing(), 0.25);
  p.propulsion.volts_max *= 1.3;
  p.aero.cd_parasitic *= 1.9;
  p.aero.cy_aileron = 0.0;
  p.aero.cn_aileron = 0.0;
  p.aero.cn_beta = 0.03;
  p.aero.cn_r = -0.163;
  p.aero.cy_beta = -1.4;
  return p;
}

FixedWingParams small_quadplane() {
  constexpr double kArm_m = 0.25;
  constexpr double kThrustPerWeight = 1.9;
  FixedWingParams p = small_fixed_wing();
  const double each_n =
      kThrustPerWeight * p.mass.mass_kg() * kGravity_mps2 / static_cast<double>(kLiftRotors);
  p.lift = LiftRotorParams{.arm_forward_m = kArm_m,
                           .arm_right_m = kArm_m,
                           .thrust_max_n = each_n,
                           .torque_per_lift_m = 0.02,
                           .time_s = 0.04};
  return p;
}

AirData air_data(const RigidBodyState& state, const Vec3& wind_ned_mps) {
  const Vec3 air = state.velocity_mps - state.attitude.conjugate() * wind_ned_mps;
  const double speed = air.norm();
  return {.airspeed_mps = speed,
          .alpha_rad = std::atan2(air.z(), air.x()),
          .beta_rad = speed > 0.0 ? std::asin(std::clamp(air.y() / speed, -1.0, 1.0)) : 0.0};
}

Propulsion propulsion(const PropulsionParams& p, double rho, double airspeed_mps, double throttle) {
  const double d = p.diameter_m;
  const double d2 = d * d;
  const double k = p.volts_per_radps;
  const double volts = p.volts_max * throttle;
  // a w^2 + b w + c = 0: the propeller's torque less the motor's.
  const double a = p.cq0 * rho * d2 * d2 * d / (kTwoPi * kTwoPi);
  const double b = p.cq1 * rho * d2 * d2 * airspeed_mps / kTwoPi + k * k / p.resistance_ohm;
  const double c = p.cq2 * rho * d2 * d * airspeed_mps * airspeed_mps -
                   k * volts / p.resistance_ohm + k * p.no_load_amps;
  const double shaft =
      std::max(0.0, (-b + std::sqrt(std::max(0.0, b * b - 4.0 * a * c))) / (2.0 * a));
  const double n = shaft / kTwoPi;
  // rho n^2 D^4 C_T(V / (n D)), written so that n may be 0.
  const double thrust =
      rho * d2 *
      (p.ct0 * n * n * d2 + p.ct1 * airspeed_mps * n * d + p.ct2 * airspeed_mps * airspeed_mps);
  const double torque =
      rho * d2 * d *
      (p.cq0 * n * n * d2 + p.cq1 * airspeed_mps * n * d + p.cq2 * airspeed_mps * airspeed_mps);
  return {.thrust_n = thrust, .torque_nm = torque, .shaft_radps = shaft};
}

double lift_coefficient(const AerodynamicParams& p, double alpha) {
  const double linear = p.cl0 + p.cl_alpha * alpha;
  // Far from the stall the exponentials would overflow; the blend is 0 or 1 there anyway.
  const auto step = [&](double beyond) {
    return 1.0 / (1.0 + std::exp(-std::clamp(p.stall_sharpness * beyond, -200.0, 200.0)));
  };
  const double below = step(-alpha - p.stall_rad);
  const double above = step(alpha - p.stall_rad);
  // Eq. 4.10, (1 + A + B) / ((1 + A)(1 + B)), with A / (1 + A) = 1 - above, B / (1 + B) = 1 -
  // below.
  const double blend = 1.0 - (1.0 - above) * (1.0 - below);
  const double s = std::sin(alpha);
  const double plate = 2.0 * std::copysign(s * s, alpha) * std::cos(alpha);
  return (1.0 - blend) * linear + blend * plate;
}

Wrench fixed_wing_wrench(const FixedWingParams& params, const RigidBodyState& state,
                         const FixedWingInput& input, const Vec3& wind_ned_mps) {
  const AerodynamicParams& c = params.aero;
  const AirData air = air_data(state, wind_ned_mps);
  const double v = air.airspeed_mps;
  const double alpha = air.alpha_rad;
  const double beta = std::clamp(air.beta_rad, -c.stall_rad, c.stall_rad);
  const double pressure = 0.5 * params.air_density_kgpm3 * v * v * params.wing_area_m2;
  // Dynamic pressure times length / (2 V), without dividing by an airspeed that may be 0.
  const double rate = 0.25 * params.air_density_kgpm3 * v * params.wing_area_m2;
  const double p = rate * params.span_m * state.rates_radps.x();
  const double q = rate * params.chord_m * state.rates_radps.y();
  const double r = rate * params.span_m * state.rates_radps.z();

  const double lift =
      pressure * (lift_coefficient(c, alpha) + c.cl_elevator * input.elevator_rad) + c.cl_q * q;
  // Beyond the stall, as far as backwards, the flow is off: a plate's drag, and no more moment or
  // side force than there.
  const double attached = std::clamp(alpha, -c.stall_rad, c.stall_rad);
  const double plate = 2.0 * (std::pow(std::sin(alpha), 2) - std::pow(std::sin(attached), 2));
  const double linear = c.cl0 + c.cl_alpha * attached;
  const double aspect = params.span_m * params.span_m / params.wing_area_m2;
  const double cd =
      c.cd_parasitic + linear * linear / (kPi * c.oswald * aspect) + std::max(0.0, plate);
  const double drag = pressure * (cd + c.cd_elevator * input.elevator_rad) + c.cd_q * q;
  const auto lateral = [&](double c0, double c_beta, double c_p, double c_r, double c_a,
                           double c_r_surface) {
    return pressure *
               (c0 + c_beta * beta + c_a * input.aileron_rad + c_r_surface * input.rudder_rad) +
           c_p * p + c_r * r;
  };
  const Propulsion prop =
      propulsion(params.propulsion, params.air_density_kgpm3, v, input.throttle);
  const double sin_a = std::sin(alpha);
  const double cos_a = std::cos(alpha);
  Wrench wrench;
  wrench.force_n = {
      prop.thrust_n - drag * cos_a + lift * sin_a,
      lateral(c.cy0, c.cy_beta, c.cy_p, c.cy_r, c.cy_aileron, c.cy_rudder),
      -drag * sin_a - lift * cos_a,
  };
  wrench.moment_nm = {
      params.span_m * lateral(c.croll0, c.croll_beta, c.croll_p, c.croll_r, c.croll_aileron,
                              c.croll_rudder) -
          prop.torque_nm,
      params.chord_m *
          (pressure * (c.cm0 + c.cm_alpha * attached + c.cm_elevator * input.elevator_rad) +
           c.cm_q * q),
      params.span_m * lateral(c.cn0, c.cn_beta, c.cn_p, c.cn_r, c.cn_aileron, c.cn_rudder),
  };
  return wrench;
}

FixedWing::FixedWing(const FixedWingParams& params, const RigidBodyState& state,
                     const FixedWingInput& actuators)
    : params_{params}, state_{state}, actuators_{limited(actuators, params.surface_max_rad)} {
  SKEIN_ASSERT(params.servo_time_s > 0.0 && params.throttle_time_s > 0.0);
}

Wrench FixedWing::wrench(const RigidBodyState& state, const FixedWingInput& actuators,
                         const Vec3& wind_ned_mps) const {
  Wrench sum = fixed_wing_wrench(params_, state, actuators, wind_ned_mps);
  sum += ground_wrench(params_.ground, state);
  if (params_.lift) sum += lift_wrench(*params_.lift, actuators.rotors);
  return sum;
}

void FixedWing::step(const FixedWingInput& command, const Vec3& wind_ned_mps, double seconds) {
  SKEIN_ASSERT(seconds > 0.0);
  const Actuators goal = to_actuators(limited(command, params_.surface_max_rad));
  const Actuators lags = lags_s(params_);
  StateVector x;
  x << to_vector(state_), to_actuators(actuators_);
  x = runge_kutta_step(x, seconds, [&](const StateVector& at) {
    const RigidBodyState state = from_vector(at.head<kRigidBodySize>());
    const Actuators now = at.tail<kActuators>();
    StateVector rate;
    rate << rigid_body_derivative(state, wrench(state, input_of(now), wind_ned_mps), params_.mass),
        (goal - now).cwiseQuotient(lags);
    return rate;
  });
  state_ = from_vector(x.head<kRigidBodySize>());
  state_.attitude.normalize();
  actuators_ = input_of(x.tail<kActuators>());
}

Vec3 FixedWing::specific_force(const Vec3& wind_ned_mps) const {
  return wrench(state_, actuators_, wind_ned_mps).force_n / params_.mass.mass_kg();
}

}  // namespace skein::models
