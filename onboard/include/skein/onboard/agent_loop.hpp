// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "skein/base/time.hpp"
#include "skein/mission/onboard_agent.hpp"
#include "skein/onboard/control_loop.hpp"
#include "skein/onboard/planner.hpp"
#include "skein/onboard/self_report.hpp"
#include "skein/onboard/spsc_ring.hpp"
#include "skein/recording/recording.hpp"

namespace skein::onboard {

using EventRing = SpscRing<mission::MissionEvent, 1024>;
/// Agent to recorder: what the agent is given and what it gives, in order.
using AgentRing = SpscRing<recording::AgentRecord, 4096>;

/// The mission network, as the agent's thread sees it. None of them blocks.
struct AgentLink {
  struct Received {
    mission::Message message;
    VehicleId sender;
  };
  std::function<std::optional<Received>()> receive;
  std::function<void(const mission::Message&)> send;
  std::function<std::uint64_t()> dropped;  ///< messages lost by full queues and bad packets so far
  /// What the flight controller wants the operator to know; may be empty.
  std::function<std::optional<mission::MissionEvent>()> flight_event = {};
  /// Hears the operator's commands to this vehicle once each, as the agent does, those to all
  /// included; may be empty.
  std::function<void(const mission::Command&)> on_command = {};
  /// Takes down what the agent is given and gives, for its re-execution; may be empty.
  std::function<void(recording::AgentRecord)> record = {};
  /// The mode that the flight controller is in; may be empty.
  std::function<std::string()> mode = {};
  SelfReport::Program program = {};
};

/// Carries inputs to the vehicle's agent and its outputs away: one step() takes in the newest
/// state, all messages and planning results, and sends, logs, records and hands on what follows
/// from them. A vehicle is on the network before the mission begins: its telemetry goes out at any
/// time, but the agent sees neither a state nor a timeout before mission time 0.
class AgentLoop {
 public:
  static constexpr Duration kTelemetryPeriod = std::chrono::milliseconds{100};
  /// Between two steps: other vehicles' telemetry comes all the time and can wait that long.
  static constexpr Duration kStepSpacing = std::chrono::milliseconds{20};
  /// Of one step, so that a flood cannot keep the agent from its deadlines.
  static constexpr int kMessagesPerStep = 256;

  /// All references must outlive this object.
  AgentLoop(std::unique_ptr<mission::OnboardAgent> agent, VehicleId self, AgentLink link,
            ControlPorts& control, Planner& planner, EventRing& events, Instant now);

  void step(Instant now);
  /// When step() wants to be called again, at the latest; kStepSpacing from the last one or later.
  [[nodiscard]] Instant next_step() const;
  [[nodiscard]] const mission::OnboardAgent& agent() const { return *agent_; }

 private:
  void hand_out();
  void send(const mission::Message& message);
  void note(recording::AgentRecord record) const;
  void report(mission::MissionEvent event);
  void pass_on(const mission::Command& command);
  void send_telemetry(Instant now);
  void send_self_report(Instant now);
  [[nodiscard]] std::uint64_t dropped() const;

  std::unique_ptr<mission::OnboardAgent> agent_;
  AgentLink link_;
  ControlPorts* control_;
  Planner* planner_;
  EventRing* events_;
  VehicleId self_;
  SelfReport self_report_;
  std::uint32_t command_number_ = 0;
  VehicleState state_;
  bool has_state_ = false;
  Instant stepped_at_;
  Instant next_telemetry_;
};

}  // namespace skein::onboard
