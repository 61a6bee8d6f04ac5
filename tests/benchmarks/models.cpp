// SPDX-License-Identifier: Apache-2.0
// One step of the six-degree-of-freedom models and of the autopilots that fly them, as the bench
// runs them.
#include <benchmark/benchmark.h>

#include <cmath>

#include "skein/autopilot/copter_autopilot.hpp"
#include "skein/autopilot/plane_autopilot.hpp"
#include "skein/models/dryden_gusts.hpp"
#include "skein/models/fixed_wing.hpp"
#include "skein/models/hexarotor.hpp"

namespace {

using skein::Vec3;
namespace autopilot = skein::autopilot;
namespace models = skein::models;

models::FixedWing fixed_wing() {
  const models::FixedWingParams params = models::fast_fixed_wing();
  models::Trim trim = models::trim(params, {.airspeed_mps = 50.0}).value();
  trim.state.position_m.z() = -300.0;
  return {params, trim.state, trim.input};
}

models::Hexarotor hexarotor() {
  models::RigidBodyState state;
  state.position_m.z() = -20.0;
  models::Hexarotor vehicle{models::firefly(), state};
  models::RotorSpeeds hover{};
  hover.fill(models::hover_speed_radps(models::firefly()));
  vehicle.set_speeds(hover);
  return vehicle;
}

autopilot::Estimate estimate(const models::RigidBodyState& state, const Vec3& force) {
  return {.position_m = state.position_m,
          .velocity_mps = state.velocity_ned_mps(),
          .attitude = state.attitude,
          .rates_radps = state.rates_radps,
          .specific_force_mps2 = force,
          .airspeed_mps = state.velocity_mps.norm()};
}

void fixed_wing_step(benchmark::State& state) {
  models::FixedWing plane = fixed_wing();
  const models::FixedWingInput input = plane.actuators();
  for ([[maybe_unused]] auto _ : state) plane.step(input, Vec3::Zero(), 0.0025);
  benchmark::DoNotOptimize(plane.state());
}
BENCHMARK(fixed_wing_step)->Name("fixed_wing_step/skein");

void hexarotor_step(benchmark::State& state) {
  models::Hexarotor vehicle = hexarotor();
  const models::RotorSpeeds hover = vehicle.speeds_radps();
  for ([[maybe_unused]] auto _ : state) vehicle.step(hover, Vec3::Zero(), 0.0025);
  benchmark::DoNotOptimize(vehicle.state());
}
BENCHMARK(hexarotor_step)->Name("hexarotor_step/skein");

void gusts_step(benchmark::State& state) {
  models::DrydenGusts gusts{5.0, 1};
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(gusts.step(0.0025, 50.0, 300.0));
}
BENCHMARK(gusts_step)->Name("gusts_step/skein");

void plane_autopilot_step(benchmark::State& state) {
  autopilot::PlaneAutopilot pilot{{}};
  const models::FixedWing plane = fixed_wing();
  const autopilot::Estimate here = estimate(plane.state(), plane.specific_force(Vec3::Zero()));
  skein::Instant now{};
  benchmark::DoNotOptimize(pilot.step(here, now));
  benchmark::DoNotOptimize(pilot.arm());
  benchmark::DoNotOptimize(pilot.select_mode(autopilot::PlaneMode::guided));
  for ([[maybe_unused]] auto _ : state) {
    now += std::chrono::milliseconds{20};
    benchmark::DoNotOptimize(pilot.step(here, now));
  }
}
BENCHMARK(plane_autopilot_step)->Name("plane_autopilot_step/skein");

void hexarotor_flight(benchmark::State& state) {
  models::Hexarotor vehicle = hexarotor();
  const double fastest = vehicle.params().speed_max_radps;
  autopilot::HexarotorLoops loops{{}};
  const autopilot::MotionDemand demand{.horizontal_m = skein::Vec2{0.0, 0.0}, .down_m = -20.0};
  for ([[maybe_unused]] auto _ : state) {
    const autopilot::RotorCommand command =
        loops.fly(estimate(vehicle.state(), vehicle.specific_force(Vec3::Zero())), demand, 0.0025);
    models::RotorSpeeds speeds{};
    for (std::size_t i = 0; i < speeds.size(); ++i) {
      speeds[i] = fastest * std::sqrt(command.thrust[i]);
    }
    vehicle.step(speeds, Vec3::Zero(), 0.0025);
  }
  benchmark::DoNotOptimize(vehicle.state());
}
BENCHMARK(hexarotor_flight)->Name("hexarotor_flight/skein");

}  // namespace
