// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "skein/hil/team_simulator.hpp"
#include "skein/mission/vehicle_agent.hpp"
#include "skein/models/heading_dynamics.hpp"

namespace skein::hil {

/// One aircraft of the simulated team: its motion, its clock, and the agent on board while that
/// runs. Times are true mission time but for what the agent is given and gives.
class FlyingVehicle {
 public:
  FlyingVehicle(const TeamMission& mission, const SimulatedVehicle& what, const models::Wind& wind);

  /// From its start, with an agent on board.
  void take_off(Instant now);
  [[nodiscard]] bool flying() const { return dynamics_.has_value(); }

  /// The program ends. The flight controller holds: an orbit where the vehicle is.
  void end_agent(Instant now, const std::vector<Hazard>& hazards);
  /// Is there an orbit here that is clear of the hazards?
  [[nodiscard]] bool can_hold(const std::vector<Hazard>& hazards) const;
  /// A new agent that remembers nothing, in what state the vehicle is.
  void start_agent(const std::vector<Hazard>& hazards);

  /// Null while no program runs. Its times are of this vehicle's clock.
  [[nodiscard]] mission::VehicleAgent* agent() const { return agent_.get(); }
  [[nodiscard]] std::uint32_t life() const { return life_; }  ///< counts its agents
  [[nodiscard]] Instant local(Instant now) const { return now + clock_; }
  /// An event of the agent with its times in true mission time.
  [[nodiscard]] mission::MissionEvent in_true_time(mission::MissionEvent event) const;
  [[nodiscard]] VehicleState local_state() const;

  /// Follows a plan of the agent from now on.
  void follow(const mission::FlightPlan& plan);
  /// One control period; false while there is no plan.
  bool control(Instant now);

  [[nodiscard]] const VehicleSpec& spec() const { return what_.spec; }
  [[nodiscard]] const VehicleState& state() const { return dynamics_->state(); }
  /// As it is recorded: in true time, with numbers that grow over all agents.
  [[nodiscard]] const mission::FlightPlan& plan() const { return recorded_; }
  [[nodiscard]] std::uint8_t loads_left() const { return loads_left_; }
  void began_delivery() { loads_left_ = loads_left_ > 0 ? loads_left_ - 1 : 0; }
  void advance(Instant now) { dynamics_->advance_to(now); }

 private:
  [[nodiscard]] std::optional<double> hold_curvature(const std::vector<Hazard>& hazards) const;

  const TeamMission& mission_;
  const SimulatedVehicle& what_;
  models::Wind wind_;
  Duration clock_{};
  std::unique_ptr<mission::VehicleAgent> agent_;
  std::uint32_t life_ = 0;
  std::optional<models::HeadingDynamics> dynamics_;
  mission::FlightPlan plan_;  ///< in this vehicle's time; the recorded number
  mission::FlightPlan recorded_;
  std::uint32_t numbers_before_ = 0;  ///< plans of earlier agents and of the flight controller
  std::uint8_t loads_left_ = 0;
};

}  // namespace skein::hil
