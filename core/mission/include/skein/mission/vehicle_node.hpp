// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "skein/base/bounded_queue.hpp"
#include "skein/mission/formation_agent.hpp"
#include "skein/mission/onboard_agent.hpp"
#include "skein/mission/setup_book.hpp"
#include "skein/mission/telemetry_pace.hpp"
#include "skein/mission/track_agent.hpp"
#include "skein/mission/vehicle_agent.hpp"

namespace skein::mission {

struct VehicleNodeConfig {
  std::variant<VehicleAgentConfig, FormationAgentConfig, TrackAgentConfig> agent;
  std::string program;            ///< name and version, for whoever watches
  std::string flight_controller;  ///< its kind
  Fence fence{};                  ///< of the configuration
  TelemetryPeriods telemetry{};
  SetupParams setup{};
  TrafficParams traffic{};  ///< of who flies in a formation, and is only warned
};

/// Everything that a vehicle decides and says: its agent, the telemetry and what it tells of itself
/// for people who watch it, and what of the operator's words is for the flight controller. Calling
/// rules as of OnboardAgent: the same inputs give the same outputs, byte for byte.
///
/// A message that is not its sender's to say is refused and counted, whatever it is. Who runs with
/// another setup (SetupBook) is not worked with: its words of the contract net and of sites count
/// for nothing. A vehicle whose setup is not the ground station's, and one that starts anew in the
/// mission and has not been told which orders stand, holds (Bar). A vehicle that knows them tells
/// whoever does not, and of the hazards and the withdrawn sites too. A vehicle is on the network
/// before the mission begins: it tells of itself at any time, but its agent sees neither a state
/// nor a timeout before mission time 0.
class VehicleNode {
 public:
  VehicleNode(const VehicleNodeConfig& config, Instant now);
  ~VehicleNode();
  VehicleNode(const VehicleNode&) = delete;
  VehicleNode& operator=(const VehicleNode&) = delete;
  VehicleNode(VehicleNode&&) noexcept;
  VehicleNode& operator=(VehicleNode&&) noexcept;

  void on_state(const VehicleState& state, Instant now);
  void on_message(const Message& message, VehicleId sender, Instant now);
  void on_planning_result(const PlanningResult& result, Instant now);
  void on_notice(const FlightNotice& notice, Instant now);
  /// Counts until the next one.
  void on_condition(const Condition& condition);
  /// A state or a timeout makes it tell of itself now: what its condition is should be given first.
  [[nodiscard]] bool wants_condition(Instant now) const;
  void on_timeout(Instant now);

  /// To be sent: all that the vehicle says.
  [[nodiscard]] std::optional<Message> poll_message();
  [[nodiscard]] std::optional<Guidance> poll_guidance();
  [[nodiscard]] std::optional<PlanningRequest> poll_planning_request();
  /// To the recorder; those for others are among the messages too.
  [[nodiscard]] std::optional<MissionEvent> poll_event();
  /// The operator gives the aircraft (back) to this program, by a command to this very vehicle that
  /// was issued then: what goes to all takes no aircraft from its pilot.
  [[nodiscard]] std::optional<Instant> poll_give_back();
  /// To the flight controller: the fence that it is to keep from now on.
  [[nodiscard]] std::optional<Fence> poll_fence();
  [[nodiscard]] Instant next_timeout() const;
  /// As of OnboardAgent.
  [[nodiscard]] Instant quiet_until(Instant now) const;

  /// What decides, for whoever looks on.
  [[nodiscard]] const OnboardAgent& agent() const;
  [[nodiscard]] Bar bar() const;
  [[nodiscard]] VehicleId vehicle() const;
  [[nodiscard]] InstanceId instance() const;
  [[nodiscard]] Counters counters() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace skein::mission
