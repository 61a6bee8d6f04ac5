// SPDX-License-Identifier: Apache-2.0
#include "skein/models/fixed_wing.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <vector>

#include "skein/base/angles.hpp"

namespace skein::models {
namespace {

/// As the authors of the coefficients computed the results that they publish with their course
/// (Beard and McLain, mavsim, chapters 4 and 5): without parasitic drag.
FixedWingParams published() {
  FixedWingParams p = aerosonde();
  p.aero.cd_parasitic = 0.0;
  return p;
}

/// North, east, down, u, v, w, roll, pitch, yaw, p, q, r.
using Euler = Eigen::Matrix<double, 12, 1>;
using Inputs = Eigen::Vector4d;  // elevator, aileron, rudder, throttle

Euler derivative(const FixedWingParams& params, const Euler& x, const Inputs& u) {
  const RigidBodyState state{
      .position_m = x.segment<3>(0),
      .velocity_mps = x.segment<3>(3),
      .attitude = attitude_from({.roll_rad = x[6], .pitch_rad = x[7], .yaw_rad = x[8]}),
      .rates_radps = x.segment<3>(9)};
  const RigidBodyVector rate = rigid_body_derivative(
      state, fixed_wing_wrench(params, state, {u[0], u[1], u[2], u[3]}, Vec3::Zero()), params.mass);
  const double sr = std::sin(x[6]);
  const double cr = std::cos(x[6]);
  Euler result;
  result << rate.head<6>(), x[9] + std::tan(x[7]) * (sr * x[10] + cr * x[11]),
      cr * x[10] - sr * x[11], (sr * x[10] + cr * x[11]) / std::cos(x[7]), rate.tail<3>();
  return result;
}

Eigen::Matrix<double, 12, 12> jacobian(const FixedWingParams& params, const Euler& x,
                                       const Inputs& u) {
  Eigen::Matrix<double, 12, 12> result;
  for (Eigen::Index i = 0; i < 12; ++i) {
    Euler up = x;
    Euler down = x;
    up[i] += 1e-5;
    down[i] -= 1e-5;
    result.col(i) = (derivative(params, up, u) - derivative(params, down, u)) / 2e-5;
  }
  return result;
}

template <std::size_t N>
Eigen::MatrixXd part(const Eigen::Matrix<double, 12, 12>& a,
                     const std::array<Eigen::Index, N>& states) {
  const auto n = static_cast<Eigen::Index>(N);
  Eigen::MatrixXd result{n, n};
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index k = 0; k < n; ++k) {
      result(i, k) =
          a(states.at(static_cast<std::size_t>(i)), states.at(static_cast<std::size_t>(k)));
    }
  }
  return result;
}

using Roots = std::vector<std::complex<double>>;
/// By magnitude, greatest first; of a pair the one above the axis first.
Roots roots(const Eigen::MatrixXd& a) {
  const Eigen::VectorXcd values = Eigen::EigenSolver<Eigen::MatrixXd>{a, false}.eigenvalues();
  Roots result{values.data(), values.data() + values.size()};
  std::sort(result.begin(), result.end(), [](const auto& l, const auto& r) {
    if (std::abs(std::abs(l) - std::abs(r)) > 1e-9) return std::abs(l) > std::abs(r);
    return l.imag() > r.imag();
  });
  return result;
}

constexpr std::array<Eigen::Index, 4> kLengthwise{3, 5, 10, 7};  // u, w, q, pitch
constexpr std::array<Eigen::Index, 4> kSideways{4, 9, 11, 6};    // v, p, r, roll

Euler published_state() {
  Euler x = Euler::Zero();
  x[2] = -100.0;
  x[3] = 24.968743;
  x[5] = 1.249755;
  x[7] = 0.05001119;
  return x;
}
const Inputs kPublishedInputs{-0.124778, 0.001836, -0.000303, 0.676752};

Euler state_of(const Trim& trim) {
  const EulerAngles angles = euler_angles(trim.state.attitude);
  Euler x;
  x << trim.state.position_m, trim.state.velocity_mps, angles.roll_rad, angles.pitch_rad,
      angles.yaw_rad, trim.state.rates_radps;
  return x;
}
Inputs inputs_of(const Trim& trim) {
  return {trim.input.elevator_rad, trim.input.aileron_rad, trim.input.rudder_rad,
          trim.input.throttle};
}

/// In that flight, well above the ground.
FixedWing flying(const FixedWingParams& params, const Trim& trim) {
  RigidBodyState state = trim.state;
  state.position_m.z() = -100.0;
  return {params, state, trim.input};
}

TEST(FixedWing, ForcesAndMomentsAreThePublishedOnes) {
  RigidBodyState state;
  state.velocity_mps = {25.0, 0.0, 0.0};
  const FixedWingInput input{.elevator_rad = -0.2, .rudder_rad = 0.005, .throttle = 0.5};
  const FixedWingParams params = published();
  const Propulsion prop = propulsion(params.propulsion, params.air_density_kgpm3, 25.0, 0.5);
  EXPECT_NEAR(prop.thrust_n, -12.43072534597213, 1e-9);
  EXPECT_NEAR(prop.torque_nm, -0.49879620097737787, 1e-9);
  Wrench wrench = fixed_wing_wrench(params, state, input, Vec3::Zero());
  wrench.force_n.z() += params.mass.mass_kg() * kGravity_mps2;
  EXPECT_LT((wrench.force_n - Vec3{-12.109717001006562, 0.20707328125, 63.44373750624077}).norm(),
            1e-9);
  EXPECT_LT(
      (wrench.moment_nm - Vec3{0.5063701133123779, 8.75643373378125, -0.21774997963125006}).norm(),
      1e-9);
}

TEST(FixedWing, ForcesInASlippingTurnInWindAreThePublishedOnes) {
  RigidBodyState state;
  state.velocity_mps = {27.3465947, 0.619628233, 1.42257772};
  state.attitude = Eigen::Quaterniond{0.938688796, 0.247421558, 0.0656821468, 0.230936730};
  state.rates_radps = {0.00498772167, 0.168736005, 0.171797313};
  const FixedWingInput input{-0.15705144, 0.01788999, 0.01084654, 1.0};
  // Published as the gust along body axes.
  const Vec3 wind = state.attitude * Vec3{-0.00165177, -0.00475441, -0.01717199};
  const AirData air = air_data(state, wind);
  EXPECT_NEAR(air.airspeed_mps, 27.39323489287441, 1e-7);
  EXPECT_NEAR(air.alpha_rad, 0.05259649205640062, 1e-9);
  EXPECT_NEAR(air.beta_rad, 0.022801214339060967, 1e-5);  // the gust is printed with few digits
  const FixedWingParams params = published();
  Wrench wrench = fixed_wing_wrench(params, state, input, wind);
  wrench.force_n +=
      params.mass.mass_kg() * kGravity_mps2 * (state.attitude.conjugate() * Vec3::UnitZ());
  EXPECT_LT(
      (wrench.force_n - Vec3{36.22803068339798, 48.44092504137796, -39.39246596662818}).norm(),
      5e-3);
  EXPECT_LT((wrench.moment_nm - Vec3{0.10867448074086083, 0.1249623335264915, -0.09481002421995177})
                .norm(),
            1e-3);
}

TEST(FixedWing, LinearisationIsThePublishedOne) {
  const auto a = jacobian(published(), published_state(), kPublishedInputs);
  Eigen::Matrix4d lengthwise;
  lengthwise << -0.20676658, 0.50039026, -1.21983882, -9.79511927,  //
      -0.56064206, -4.46393561, 24.37105023, -0.53938541,           //
      0.19993539, -3.99297865, -5.29473836, 0.0,                    //
      0.0, 0.0, 0.99997406, 0.0;
  Eigen::Matrix4d sideways;
  sideways << -0.776772629, 1.249755, -24.968743, 9.79757127,  //
      -3.86671935, -22.628851, 10.9050409, 0.0,                //
      0.783077145, -0.115091678, -1.22765475, 0.0,             //
      0.0, 0.999999666, 0.0500528958, 0.0;
  // Theirs are one-sided differences with a step of 0.01: half of it times 9.81 is left.
  EXPECT_LT((part(a, kLengthwise) - lengthwise).cwiseAbs().maxCoeff(), 0.06)
      << part(a, kLengthwise);
  EXPECT_LT((part(a, kSideways) - sideways).cwiseAbs().maxCoeff(), 0.06) << part(a, kSideways);
  const Roots ours = roots(part(a, kSideways));
  const Roots theirs = roots(sideways);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_LT(std::abs(ours[i] - theirs[i]), 0.02) << i;
}

TEST(Trim, IsThePublishedOne) {
  const Result<Trim> found = trim(published(), {.airspeed_mps = 25.0});
  ASSERT_TRUE(found.ok()) << found.error().message;
  EXPECT_LT(found->residual, 1e-9);
  EXPECT_NEAR(found->input.elevator_rad, -0.124778, 5e-4);  // their optimiser left 0.01 m/s^2
  EXPECT_NEAR(found->input.aileron_rad, 0.001836, 1e-5);
  EXPECT_NEAR(found->input.rudder_rad, -0.000303, 2e-5);
  EXPECT_NEAR(found->input.throttle, 0.676752, 1e-4);
  EXPECT_NEAR(air_data(found->state, Vec3::Zero()).alpha_rad, 0.05001, 1e-4);
}

TEST(Trim, HoldsWhereItIsFlown) {
  const Result<Trim> level = trim(aerosonde(), {.airspeed_mps = 25.0});
  ASSERT_TRUE(level.ok());
  FixedWing plane = flying(aerosonde(), *level);
  for (int i = 0; i < 2000; ++i) plane.step(level->input, Vec3::Zero(), 0.005);
  EXPECT_NEAR(plane.state().position_m.z(), -100.0, 1e-3);
  EXPECT_NEAR(plane.state().position_m.x(), 250.0, 1e-3);
  EXPECT_NEAR(plane.state().attitude.norm(), 1.0, 1e-12);
}

TEST(Trim, TurnsAndClimbsAsAsked) {
  const double turn = 25.0 / 80.0;  // rad/s: radius 80 m
  const Result<Trim> spiral =
      trim(aerosonde(), {.airspeed_mps = 25.0, .climb_angle_rad = 0.03, .turn_rate_radps = turn});
  ASSERT_TRUE(spiral.ok()) << spiral.error().message;
  EXPECT_NEAR(euler_angles(spiral->state.attitude).roll_rad, std::atan(25.0 * turn / 9.81), 0.03);
  FixedWing plane = flying(aerosonde(), *spiral);
  const int steps = static_cast<int>(kTwoPi / turn / 0.005);
  for (int i = 0; i < steps; ++i) plane.step(spiral->input, Vec3::Zero(), 0.005);
  const double seconds = 0.005 * steps;
  EXPECT_NEAR(plane.state().position_m.head<2>().norm(), 0.0, 0.5);
  EXPECT_NEAR(-plane.state().position_m.z(), 100.0 + 25.0 * std::sin(0.03) * seconds, 0.05);
}

TEST(Trim, SaysWhatCannotBeFlown) {
  EXPECT_FALSE(trim(aerosonde(), {.airspeed_mps = 45.0}).ok());  // more than its propeller
  EXPECT_FALSE(trim(aerosonde(), {.airspeed_mps = 5.0}).ok());   // below its stall
  EXPECT_FALSE(trim(aerosonde(), {.airspeed_mps = 0.0}).ok());
}

TEST(Modes, OfTheAerosondeAreTheClassicalOnes) {
  const FixedWingParams params = aerosonde();
  const Result<Trim> level = trim(params, {.airspeed_mps = 25.0});
  ASSERT_TRUE(level.ok());
  const auto a = jacobian(params, state_of(*level), inputs_of(*level));
  const double u0 = 25.0;
  // Short period: fast, damped; close to the two-degree approximation
  // s^2 - (Zw + Mq) s + (Zw Mq - u0 Mw).
  const Roots lengthwise = roots(part(a, kLengthwise));
  const std::complex<double> short_period = lengthwise[0];
  const double natural = std::sqrt(a(5, 5) * a(10, 10) - a(5, 10) * a(10, 5));
  EXPECT_LT(short_period.real(), 0.0);
  EXPECT_GT(short_period.imag(), 0.0);
  EXPECT_NEAR(std::abs(short_period) / natural, 1.0, 0.02);
  EXPECT_NEAR(2.0 * short_period.real() / (a(5, 5) + a(10, 10)), 1.0, 0.05);
  // Phugoid: slow, hardly damped; Lanchester's period pi sqrt(2) V / g.
  const std::complex<double> phugoid = lengthwise[2];
  EXPECT_LT(phugoid.real(), 0.0);
  EXPECT_NEAR(kTwoPi / phugoid.imag() / (kPi * std::sqrt(2.0) * u0 / kGravity_mps2), 1.0, 0.2);
  // Roll: real, close to Lp.
  const Roots sideways = roots(part(a, kSideways));
  EXPECT_EQ(sideways[0].imag(), 0.0);
  EXPECT_NEAR(sideways[0].real() / a(9, 9), 1.0, 0.05);
  // Dutch roll: a damped pair; period near sqrt(Yv Nr + u0 Nv).
  EXPECT_LT(sideways[1].real(), 0.0);
  EXPECT_GT(sideways[1].imag(), 0.0);
  const double dutch = std::sqrt(a(4, 4) * a(11, 11) - a(4, 11) * a(11, 4));
  EXPECT_NEAR(std::abs(sideways[1]) / dutch, 1.0, 0.15);
  // Spiral: real, slow, and unstable since Lv Nr < Nv Lr (Etkin's criterion).
  ASSERT_LT(a(9, 4) * a(11, 11), a(11, 4) * a(9, 11));
  EXPECT_EQ(sideways[3].imag(), 0.0);
  EXPECT_GT(sideways[3].real(), 0.0);
  EXPECT_LT(sideways[3].real(), 0.2);
}

TEST(FroudeScaling, KeepsAnglesAndStretchesTime) {
  const FixedWingParams small = aerosonde();
  const FixedWingParams large = froude_scaled(small, 4.0);
  EXPECT_NEAR(large.mass.mass_kg(), 11.0 * 64.0, 1e-9);
  const Result<Trim> slow = trim(small, {.airspeed_mps = 25.0});
  const Result<Trim> fast = trim(large, {.airspeed_mps = 50.0});
  ASSERT_TRUE(slow.ok() && fast.ok());
  EXPECT_LT((inputs_of(*slow) - inputs_of(*fast)).norm(), 1e-9);
  const auto a = jacobian(small, state_of(*slow), inputs_of(*slow));
  const auto b = jacobian(large, state_of(*fast), inputs_of(*fast));
  for (const auto& group : {kLengthwise, kSideways}) {
    const Roots ours = roots(part(a, group));
    const Roots theirs = roots(part(b, group));
    for (std::size_t i = 0; i < 4; ++i) EXPECT_LT(std::abs(ours[i] - 2.0 * theirs[i]), 1e-5) << i;
  }
}

TEST(FastFixedWing, FliesTheSpeedsAndTurnsOfTheMissions) {
  const FixedWingParams params = fast_fixed_wing();
  EXPECT_NEAR(params.mass.mass_kg(), 88.0, 1e-9);
  for (const double airspeed : {40.0, 42.5, 50.0, 57.5, 60.0, 69.0}) {
    const Result<Trim> level = trim(params, {.airspeed_mps = airspeed});
    ASSERT_TRUE(level.ok()) << level.error().message;
    EXPECT_LT(level->residual, 1e-9);
  }
  const Result<Trim> allround = trim(params, {.airspeed_mps = 50.0, .turn_rate_radps = 50.0 / 150});
  ASSERT_TRUE(allround.ok()) << allround.error().message;
  const Result<Trim> carrier = trim(params, {.airspeed_mps = 60.0, .turn_rate_radps = 60.0 / 200});
  ASSERT_TRUE(carrier.ok()) << carrier.error().message;
  EXPECT_NEAR(degrees(euler_angles(carrier->state.attitude).roll_rad), 61.4, 1.0);
  // Full throttle leaves enough to climb at cruise speed.
  EXPECT_TRUE(trim(params, {.airspeed_mps = 50.0, .climb_angle_rad = 0.1}).ok());
}

TEST(SmallFixedWing, FliesTheSpeedsAndTurnsOfSmallMissions) {
  const FixedWingParams params = small_fixed_wing();
  EXPECT_NEAR(params.mass.mass_kg(), 1.375, 1e-9);
  for (const double airspeed : {15.5, 20.0, 25.0, 30.0, 34.0}) {
    const Result<Trim> level = trim(params, {.airspeed_mps = airspeed});
    EXPECT_TRUE(level.ok()) << level.error().message;
  }
  EXPECT_TRUE(trim(params, {.airspeed_mps = 25.0, .turn_rate_radps = 25.0 / 66}).ok());
}

TEST(FixedWing, LiftStallsIntoAFlatPlate) {
  const AerodynamicParams& aero = aerosonde().aero;
  EXPECT_NEAR(lift_coefficient(aero, 0.1), 0.23 + 0.561, 1e-6);
  EXPECT_GT(lift_coefficient(aero, 0.40), 2.0);
  EXPECT_LT(lift_coefficient(aero, 0.60), 1.0);
  EXPECT_NEAR(lift_coefficient(aero, kPi / 4), std::sqrt(0.5), 1e-6);
  EXPECT_NEAR(lift_coefficient(aero, -kPi / 4), -std::sqrt(0.5), 1e-6);
  EXPECT_NEAR(lift_coefficient(aero, kPi / 2), 0.0, 1e-9);
  EXPECT_TRUE(std::isfinite(lift_coefficient(aero, -kPi)));
}

TEST(FixedWing, StepIsOfOrderFour) {
  const auto fly = [](int steps) {
    RigidBodyState state = trim(aerosonde(), {.airspeed_mps = 25.0})->state;
    state.position_m.z() = -100.0;
    state.rates_radps = {0.5, -0.2, 0.1};
    FixedWing plane{aerosonde(), state, {.elevator_rad = -0.12, .throttle = 0.7}};
    for (int i = 0; i < steps; ++i) {
      plane.step({.elevator_rad = -0.2, .aileron_rad = 0.05, .throttle = 0.7}, {2.0, -3.0, 0.0},
                 1.0 / steps);
    }
    return to_vector(plane.state());
  };
  const RigidBodyVector truth = fly(6400);
  const double coarse = (fly(200) - truth).norm();
  EXPECT_NEAR(coarse / (fly(400) - truth).norm(), 16.0, 2.0);
}

TEST(FixedWing, IsTheSameEveryTime) {
  const auto fly = [] {
    FixedWing plane{fast_fixed_wing(),
                    trim(fast_fixed_wing(), {.airspeed_mps = 50.0})->state,
                    {.throttle = 0.5}};
    for (int i = 0; i < 1000; ++i) {
      plane.step({.elevator_rad = -0.02, .aileron_rad = 0.01, .throttle = 0.5}, {1.0, 2.0, 0.0},
                 0.0025);
    }
    return to_vector(plane.state());
  };
  EXPECT_EQ(fly(), fly());
}

TEST(FixedWing, StandsOnItsWheels) {
  const FixedWingParams params = fast_fixed_wing();
  RigidBodyState state;
  state.position_m.z() = -0.6;
  FixedWing plane{params, state, {}};
  for (int i = 0; i < 4000; ++i) plane.step({}, {0.0, 3.0, 0.0}, 0.0025);
  EXPECT_TRUE(plane.on_ground());
  EXPECT_LT(plane.state().velocity_mps.norm(), 0.02);
  EXPECT_NEAR(plane.state().position_m.z(), -0.5, 0.15);
  EXPECT_LT(plane.state().position_m.head<2>().norm(), 0.2);  // creeps a little in the wind
  EXPECT_NEAR(plane.specific_force({0.0, 3.0, 0.0}).z(), -kGravity_mps2, 0.1);
}

}  // namespace
}  // namespace skein::models
