// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "skein/base/time.hpp"
#include "skein/coalition/protocol_params.hpp"
#include "skein/domain/fence.hpp"
#include "skein/domain/path.hpp"
#include "skein/domain/traffic_params.hpp"
#include "skein/domain/vehicle.hpp"
#include "skein/mission/onboard_agent.hpp"
#include "skein/planning/allocation.hpp"

namespace skein::mission {

struct VehicleAgentConfig {
  VehicleSpec vehicle;
  InstanceId instance;
  coalition::ProtocolParams protocol;
  TrafficParams traffic;
  planning::AllocationParams planning;
  std::vector<Vec2> search;  ///< waypoints of the search route; the vehicle orbits the last one
  std::optional<TimedPath> route;  ///< flown first, to its end unless a task comes between
  std::vector<Hazard> hazards;     ///< known before the mission
  Fence fence;
  Duration status_period = std::chrono::seconds{1};
  /// Of a fixed wing: its plans are of one airspeed in the wind that it measures, and its turns so
  /// wide that they are held there. Else of one speed over the ground, as if its airspeed followed
  /// whatever is asked of it at once.
  bool heeds_wind = false;
  /// The follower begins turns so much before the path does: a delivery's run goes straight on for
  /// longer than that.
  double turn_lead_s = 0.0;
  /// Where its range ends, at home or where it is recovered anywhere, it lands without an order.
  /// Else it orbits there for its pilot.
  bool lands_by_itself = true;
};

/// All decisions of one vehicle of a coalition: search, survey, lead, bid, execute, hold.
class VehicleAgent final : public OnboardAgent {
 public:
  VehicleAgent(const VehicleAgentConfig& config, Instant now);
  ~VehicleAgent() override;
  VehicleAgent(const VehicleAgent&) = delete;
  VehicleAgent& operator=(const VehicleAgent&) = delete;

  /// The first state starts the route, or the search; later ones judge how tasks were flown.
  void on_state(const VehicleState& state, Instant now) override;
  void on_message(const Message& message, VehicleId sender, Instant now) override;
  void on_planning_result(const PlanningResult& result, Instant now) override;
  void on_timeout(Instant now) override;
  void on_bar(Bar bar, Instant now) override;
  std::string keep_fence(const Fence& fence, Instant now) override;

  [[nodiscard]] std::optional<Message> poll_message() override;
  [[nodiscard]] std::optional<Guidance> poll_guidance() override;
  [[nodiscard]] std::optional<MissionEvent> poll_event() override;
  [[nodiscard]] std::optional<PlanningRequest> poll_planning_request() override;
  [[nodiscard]] Instant next_timeout() const override;
  [[nodiscard]] Instant quiet_until(Instant now) const override;

  [[nodiscard]] Telemetry telemetry() const override;
  [[nodiscard]] Activity activity() const;
  [[nodiscard]] Counters counters() const override;
  [[nodiscard]] bool range_spent() const override;
  void on_piloted(bool piloted, Instant now) override;
  [[nodiscard]] bool watches_others() const override;
  [[nodiscard]] std::optional<SeparationConflict> separation_conflict() const override;
  [[nodiscard]] std::optional<TrafficWatch::Conflict> traffic_conflict() const override;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace skein::mission
