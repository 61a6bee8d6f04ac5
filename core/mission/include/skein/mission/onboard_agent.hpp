// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "skein/base/time.hpp"
#include "skein/domain/vehicle.hpp"
#include "skein/mission/guidance.hpp"
#include "skein/mission/messages.hpp"
#include "skein/planning/allocation.hpp"

namespace skein::mission {

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

/// All decisions of one vehicle, whatever it flies. It does no I/O and reads no clock. Call the
/// on_*() functions with a `now` that never decreases; after each call drain the poll_*()
/// functions; call on_timeout() when next_timeout() is reached (early calls are harmless). Not
/// thread-safe. The same inputs give the same outputs, byte for byte.
class OnboardAgent {
 public:
  virtual ~OnboardAgent() = default;

  virtual void on_state(const VehicleState& state, Instant now) = 0;
  /// Any message of the mission network. Those that are not for this vehicle are ignored.
  virtual void on_message(const Message& message, VehicleId sender, Instant now) = 0;
  virtual void on_planning_result(const PlanningResult& /*result*/, Instant /*now*/) {}
  virtual void on_timeout(Instant now) = 0;

  /// To be sent; events are among them.
  [[nodiscard]] virtual std::optional<Message> poll_message() = 0;
  /// To control, which follows it from now on.
  [[nodiscard]] virtual std::optional<Guidance> poll_guidance() = 0;
  /// To the recorder; also sent as messages.
  [[nodiscard]] virtual std::optional<MissionEvent> poll_event() = 0;
  [[nodiscard]] virtual std::optional<PlanningRequest> poll_planning_request() {
    return std::nullopt;
  }
  [[nodiscard]] virtual Instant next_timeout() const = 0;

  /// The telemetry of this moment; sent by the process at its own rate.
  [[nodiscard]] virtual Telemetry telemetry() const = 0;
  /// Inputs that no state machine had an entry for, and messages that queues had no room for.
  [[nodiscard]] virtual std::map<std::string, std::uint64_t> counters() const = 0;
};

}  // namespace skein::mission
