// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "skein/base/time.hpp"
#include "skein/mission/vehicle_node.hpp"
#include "skein/onboard/control_loop.hpp"
#include "skein/onboard/planner.hpp"
#include "skein/onboard/spsc_ring.hpp"
#include "skein/recording/recording.hpp"

namespace skein::onboard {

using EventRing = SpscRing<mission::MissionEvent, 1024>;
/// Agent to recorder: what the node is given and what it gives, in order.
using AgentRing = SpscRing<recording::AgentRecord, 4096>;

/// The mission network and the flight controller, as the agent's thread sees them. None blocks.
struct AgentLink {
  struct Received {
    mission::Message message;
    VehicleId sender;
  };
  std::function<std::optional<Received>()> receive;
  std::function<void(const mission::Message&)> send;
  std::function<std::uint64_t()> dropped;  ///< messages lost by full queues and bad packets so far
  /// What the flight controller lets people know; may be empty.
  std::function<std::optional<mission::FlightNotice>()> notice = {};
  /// The time, where it is not that of the step all through it; may be empty.
  std::function<Instant()> now = {};
  /// The mode that the flight controller is in; may be empty.
  std::function<std::string()> mode = {};
  /// The operator gives the aircraft back, by a word that was issued then; may be empty.
  std::function<void(Instant)> give_back = {};
  /// The fence that the flight controller is to keep from now on; may be empty.
  std::function<void(const Fence&)> keep_fence = {};
  /// Takes down what the node is given and gives, for its re-execution; may be empty.
  std::function<void(recording::AgentRecord)> record = {};
};

/// Carries inputs to the vehicle's node and its outputs away: one step() takes in the newest state,
/// all messages, planning results and notices, and sends, logs, records and hands on what follows
/// from them. It decides nothing.
class AgentLoop {
 public:
  /// Between two steps: other vehicles' telemetry comes all the time and can wait that long.
  static constexpr Duration kStepSpacing = std::chrono::milliseconds{20};
  /// Of one step, so that a flood cannot keep the agent from its deadlines.
  static constexpr int kMessagesPerStep = 256;

  /// All references must outlive this object.
  AgentLoop(const mission::VehicleNodeConfig& config, AgentLink link, ControlPorts& control,
            Planner& planner, EventRing& events, Instant now);

  void step(Instant now);
  /// When step() wants to be called again, at the latest; kStepSpacing from the last one or later.
  [[nodiscard]] Instant next_step() const;
  [[nodiscard]] const mission::VehicleNode& node() const { return node_; }

 private:
  void take_in(const AgentLink::Received& received);
  void hand_out();
  void note(recording::AgentRecord record) const;
  void report(mission::MissionEvent event);
  void give_condition();

  mission::VehicleNode node_;
  AgentLink link_;
  ControlPorts* control_;
  Planner* planner_;
  EventRing* events_;
  mission::Condition condition_;  ///< that the node knows
  Instant stepped_at_;
};

}  // namespace skein::onboard
