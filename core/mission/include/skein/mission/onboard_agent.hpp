// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "skein/base/time.hpp"
#include "skein/domain/fence.hpp"
#include "skein/domain/vehicle.hpp"
#include "skein/mission/guidance.hpp"
#include "skein/mission/messages.hpp"
#include "skein/mission/separation_watch.hpp"
#include "skein/mission/traffic_watch.hpp"
#include "skein/planning/allocation.hpp"

namespace skein::mission {

/// Paths keep this far from hazards where there is room: in long turns with the wind, which leave
/// no rate to spare, a vehicle gets up to 11 m off.
inline constexpr double kHazardMargin_m = 12.0;

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

/// What the flight controller lets people know. A warning is for the operator.
struct FlightNotice {
  Instant time{};
  bool warning = false;
  AutopilotNotice what{};
};

/// What only the program around the node can know; counted since its start.
struct Condition {
  std::string mode;            ///< of the flight controller, its own word; empty where it has none
  std::uint64_t overruns = 0;  ///< control periods that were missed
  std::uint64_t dropped = 0;   ///< messages and records that had no room, or were broken
  friend bool operator==(const Condition&, const Condition&) = default;
};

/// What keeps a vehicle from working with the others, whatever it is told: it holds until it ends.
enum class Bar : std::uint8_t {
  none,
  setup_differs,   ///< it does not run with what the ground station runs with
  orders_unknown,  ///< it has started anew, and does not know which orders stand
};

/// What was of no use, or had no room, since the start.
struct Counters {
  std::uint64_t protocol_errors = 0;   ///< inputs that no state machine had an entry for
  std::uint64_t bad_messages = 0;      ///< whose values make no sense: changes that are none
  std::uint64_t refused = 0;           ///< messages that were not their sender's to say
  std::uint64_t messages_dropped = 0;  ///< queues were full, those between parts too
  std::uint64_t events_dropped = 0;
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
  /// From now on; before the first state, too.
  virtual void on_bar(Bar bar, Instant now) = 0;

  /// Keeps that fence from now on. Else nothing is changed, and it says why not; empty: it does.
  virtual std::string keep_fence(const Fence& /*fence*/, Instant /*now*/) { return {}; }

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
  /// Before then, unless anything else comes, a timeout does nothing, and a state no more than
  /// replace the one before it: whoever steps many vehicles may leave all but the last out.
  [[nodiscard]] virtual Instant quiet_until(Instant /*now*/) const { return Instant::min(); }

  /// The telemetry of this moment; sent by the node at its own rate.
  [[nodiscard]] virtual Telemetry telemetry() const = 0;
  [[nodiscard]] virtual Counters counters() const = 0;
  /// What is left of its range is for the way home.
  [[nodiscard]] virtual bool range_spent() const { return false; }
  /// From now on others fly the aircraft, or this program again.
  virtual void on_piloted(bool /*piloted*/, Instant /*now*/) {}
  /// It goes by the telemetry of others, wherever they are (SeparationWatch).
  [[nodiscard]] virtual bool watches_others() const { return false; }
  [[nodiscard]] virtual std::optional<SeparationConflict> separation_conflict() const {
    return std::nullopt;
  }
  /// With aircraft that are not of the team.
  [[nodiscard]] virtual std::optional<TrafficWatch::Conflict> traffic_conflict() const {
    return std::nullopt;
  }
};

}  // namespace skein::mission
