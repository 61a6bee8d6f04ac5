// SPDX-License-Identifier: Apache-2.0
#include "flying_vehicle.hpp"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "skein/idl/autopilot_fields.hpp"
#include "skein/idl/coalition_fields.hpp"
#include "skein/idl/domain_fields.hpp"
#include "skein/idl/events_fields.hpp"
#include "skein/planning/path_follower.hpp"

namespace skein::hil {
namespace {

/// An orbit in wind is flown some metres off its circle.
constexpr double kOrbitClearance_m = 15.0;

/// A number for an instance that no other life of any vehicle has.
InstanceId instance(VehicleId vehicle, std::uint32_t life) {
  return {static_cast<std::uint64_t>(life) << 32U | vehicle.value};
}

}  // namespace

FlyingVehicle::FlyingVehicle(const TeamMission& mission, const SimulatedVehicle& what,
                             const models::Wind& wind)
    : mission_{mission},
      what_{what},
      wind_{wind},
      clock_{clock_offset(mission.faults, what.spec.id)},
      loads_left_{what.spec.loads} {}

void FlyingVehicle::take_off(Instant now) {
  dynamics_.emplace(what_.spec, wind_, what_.start, now);
  std::vector<Hazard> known;
  for (const auto& h : mission_.hazards) {
    if (h.known_from <= now) known.push_back(h.hazard);
  }
  start_agent(known);
}

void FlyingVehicle::start_agent(const std::vector<Hazard>& hazards) {
  mission::VehicleAgentConfig config;
  config.vehicle = what_.spec;
  config.vehicle.loads = loads_left_;
  config.instance = instance(what_.spec.id, life_);
  config.protocol = mission_.protocol;
  config.planning = mission_.planning;
  config.search = what_.search;
  config.hazards = hazards;
  numbers_before_ = plan_.number;
  agent_ = std::make_unique<mission::VehicleAgent>(config, local(dynamics_->state().time));
}

std::optional<double> FlyingVehicle::hold_curvature(const std::vector<Hazard>& hazards) const {
  const double radius = what_.spec.planning_radius_m();
  const Pose2 here = dynamics_->state().pose();
  for (const double side : {1.0, -1.0}) {
    const Vec2 centre = here.position() + side * radius * left_of(unit_vector(here.heading_rad));
    const bool clear = std::all_of(hazards.begin(), hazards.end(), [&](const Hazard& h) {
      return std::abs((h.centre - centre).norm() - radius) > h.radius_m + kOrbitClearance_m;
    });
    if (clear) return side / radius;
  }
  return std::nullopt;
}

bool FlyingVehicle::can_hold(const std::vector<Hazard>& hazards) const {
  return hold_curvature(hazards).has_value();
}

void FlyingVehicle::end_agent(Instant now, const std::vector<Hazard>& hazards) {
  agent_.reset();
  ++life_;
  ++plan_.number;
  plan_.timed = {};
  plan_.timed.start_time = local(now);
  plan_.timed.speed_mps = what_.spec.cruise_speed_mps;
  plan_.timed.path.start = dynamics_->state().pose();
  plan_.timed.tail_curvature_per_m =
      hold_curvature(hazards).value_or(1.0 / what_.spec.planning_radius_m());
  recorded_ = plan_;
  recorded_.timed.start_time = now;
}

mission::MissionEvent FlyingVehicle::in_true_time(mission::MissionEvent event) const {
  event.time -= clock_;
  std::visit(
      [this](auto& body) {
        codec::for_each_field(body, [this](auto /*name*/, auto& value) {
          if constexpr (std::is_same_v<decltype(value), Instant&>) value -= clock_;
        });
      },
      event.body);
  return event;
}

VehicleState FlyingVehicle::local_state() const {
  VehicleState state = dynamics_->state();
  state.time += clock_;
  return state;
}

void FlyingVehicle::follow(const mission::FlightPlan& plan) {
  plan_ = plan;
  plan_.number += numbers_before_;
  recorded_ = plan_;
  recorded_.timed.start_time -= clock_;
}

bool FlyingVehicle::control(Instant now) {
  dynamics_->advance_to(now);
  if (plan_.number == 0) return false;
  dynamics_->command(planning::follow_path({}, what_.spec, plan_.timed, local_state(), local(now)));
  return true;
}

}  // namespace skein::hil
