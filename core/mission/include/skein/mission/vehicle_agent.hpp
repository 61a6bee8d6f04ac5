// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/base/time.hpp"
#include "skein/coalition/protocol_params.hpp"
#include "skein/domain/path.hpp"
#include "skein/domain/vehicle.hpp"
#include "skein/mission/messages.hpp"
#include "skein/planning/allocation.hpp"

namespace skein::mission {

struct VehicleAgentConfig {
  VehicleSpec vehicle;
  InstanceId instance;
  coalition::ProtocolParams protocol;
  planning::AllocationParams planning;
  std::vector<Vec2> search;     ///< waypoints of the search route; the vehicle orbits the last one
  std::vector<Hazard> hazards;  ///< known before the mission
  Duration status_period = std::chrono::seconds{1};
};

/// What the control thread follows. Trivially copyable; a newer number replaces an older one.
struct FlightPlan {
  std::uint32_t number = 0;
  TimedPath timed;
};

/// Long work for the planner thread: call planning::allocate(params, problem), with a budget that
/// ends before `answer_by` where time is real, and hand the outcome back.
struct PlanningRequest {
  coalition::Round round;
  Instant answer_by = Instant::max();
  planning::AllocationParams params;
  planning::AllocationProblem problem;
};
struct PlanningResult {
  coalition::Round round;
  Result<planning::Allocation> allocation;
  Duration took{};  ///< for the log only
};

/// All decisions of one vehicle: search, survey, lead, bid, execute, hold. It does no I/O and reads
/// no clock. Call the on_*() functions with a `now` that never decreases; after each call drain the
/// poll_*() functions; call on_timeout() when next_timeout() is reached (early calls are harmless).
/// Not thread-safe. The same inputs give the same outputs, byte for byte.
class VehicleAgent {
 public:
  VehicleAgent(const VehicleAgentConfig& config, Instant now);
  ~VehicleAgent();
  VehicleAgent(const VehicleAgent&) = delete;
  VehicleAgent& operator=(const VehicleAgent&) = delete;

  /// The first state starts the search; later ones judge how tasks were flown.
  void on_state(const VehicleState& state, Instant now);
  /// Any message of the mission network. Those that are not for this vehicle are ignored.
  void on_message(const Message& message, VehicleId sender, Instant now);
  void on_planning_result(const PlanningResult& result, Instant now);
  void on_timeout(Instant now);

  [[nodiscard]] std::optional<Message> poll_message();  ///< to be sent; events are among them
  [[nodiscard]] std::optional<FlightPlan> poll_plan();  ///< to the control thread
  [[nodiscard]] std::optional<MissionEvent>
  poll_event();  ///< to the recorder; also sent as messages
  [[nodiscard]] std::optional<PlanningRequest> poll_planning_request();
  [[nodiscard]] Instant next_timeout() const;

  /// The telemetry of this moment; sent by the process at its own rate.
  [[nodiscard]] Telemetry telemetry() const;
  [[nodiscard]] Activity activity() const;
  /// Inputs that no state machine had an entry for, and messages that queues had no room for.
  [[nodiscard]] std::map<std::string, std::uint64_t> counters() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace skein::mission
