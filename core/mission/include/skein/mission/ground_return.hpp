// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "skein/base/bounded_queue.hpp"
#include "skein/base/result.hpp"
#include "skein/base/time.hpp"
#include "skein/mission/fleet.hpp"
#include "skein/mission/messages.hpp"
#include "skein/mission/onboard_agent.hpp"
#include "skein/planning/collective_return.hpp"

namespace skein::mission {

struct GroundReturnConfig {
  planning::ReturnParams params{
      // Heights are as measured: layers of 5 m are told apart in spite of that.
      .separation_vertical_m = 4.0,
      // One after another, for whoever lands them.
      .arrival_spacing = std::chrono::seconds{15},
      .avoidance = {.margin_m = kHazardMargin_m},
  };
};

/// What would be planned for vehicles that are ordered home now.
struct ReturnPreview {
  struct Way {
    VehicleId vehicle;
    TimedPath timed;
    double height_m = 0.0;
    /// It has not told yet where home is: it is taken to be where it was first heard.
    bool home_assumed = false;
  };
  std::vector<Way> ways;                                  ///< ascending by vehicle
  std::vector<std::pair<VehicleId, std::string>> cannot;  ///< sentences after the vehicle's name
  Instant last_arrival{};                                 ///< of no ways: now
  /// Of any two of these ways while both are flown, orbits at home included, in space; none of
  /// fewer than two.
  std::optional<double> least_separation_m;
};

/// Ways home that keep vehicles apart, for those that the operator orders home. Each begins to come
/// home by itself when it hears the order, at its own height. What it flies then it tells
/// (PlanReport), which is all that is needed to plan for it: where home is, how it turns, how fast
/// it flies. When all have told, or after some seconds, their ways are planned together from some
/// seconds ahead on, and told until they are flown or begin. Who has not told, or does not fly what
/// it was told, is looked at some times again, and planned around the others; after that, and where
/// there is no way, it comes home on its own, and the operator is told. Calling rules as of
/// GroundAgent.
class GroundReturn {
 public:
  explicit GroundReturn(const GroundReturnConfig& config) : config_{config} {}

  /// The operator's order to these vehicles, once it is given.
  void on_order(const std::vector<VehicleId>& vehicles, CommandKind kind, const Fleet& fleet,
                Instant now);
  /// Plans for nobody any more; what it knows of vehicles stays.
  void forget() {
    homing_.clear();
    step_ = Step::idle;
    next_ = Instant::max();
  }
  void on_message(const Message& message);
  void on_timeout(const Fleet& fleet, const std::vector<Hazard>& hazards, Instant now);

  /// As an order to these vehicles would plan, from what is known of them now: nothing is told to
  /// anybody. What each flies when the order comes, and where it has its home, it tells only then.
  [[nodiscard]] ReturnPreview preview(const std::vector<VehicleId>& vehicles, const Fleet& fleet,
                                      const std::vector<Hazard>& hazards, Instant now) const;

  [[nodiscard]] std::optional<Message> poll_message() { return messages_.pop(); }
  [[nodiscard]] std::optional<MissionEvent> poll_event() { return events_.pop(); }
  [[nodiscard]] Instant next_timeout() const { return next_; }
  [[nodiscard]] std::uint64_t dropped() const { return messages_.dropped() + events_.dropped(); }

 private:
  /// A vehicle that was ordered home.
  struct Homing {
    std::uint32_t number_before = 0;  ///< of the plan that it flew when it was ordered
    std::optional<Vec2> home{};       ///< where its own way leads; none: it has not told yet
    std::optional<TimedPath> given{};
    Instant tell_at{};
    bool alone = false;  ///< the operator was told that it comes home on its own way
  };
  enum class Step : std::uint8_t { idle, gathering, telling };

  [[nodiscard]] bool is_known(VehicleId vehicle, const Telemetry& telemetry) const;
  [[nodiscard]] bool has_told(VehicleId vehicle, Homing& homing, const Fleet& fleet) const;
  [[nodiscard]] bool follows(VehicleId vehicle, const Homing& homing) const;
  [[nodiscard]] planning::ReturningVehicle vehicle_of(VehicleId vehicle, const Homing& homing,
                                                      const Telemetry& telemetry,
                                                      Instant start) const;
  void gather(Instant now);
  [[nodiscard]] bool all_told(const Fleet& fleet);
  void plan(const Fleet& fleet, const std::vector<Hazard>& hazards, Instant now);
  void tell(Instant now);
  void review(Instant now);
  void leave_alone(VehicleId vehicle, Homing& homing, std::string why, Instant now);

  /// For the preview; none: why there is none.
  [[nodiscard]] Result<planning::ReturningVehicle> as_if_ordered(VehicleId vehicle,
                                                                 const Fleet& fleet,
                                                                 Instant start) const;

  GroundReturnConfig config_;
  std::map<VehicleId, FlightPlan> flies_;  ///< what each has told last
  std::map<VehicleId, Vec2> begun_;        ///< where each was first heard, or its first plan began
  std::map<VehicleId, Homing> homing_;
  Step step_ = Step::idle;
  Instant step_ends_{};
  int rounds_ = 0;
  std::uint32_t plan_ = 0;
  Instant next_ = Instant::max();
  BoundedQueue<Message> messages_{128};
  BoundedQueue<MissionEvent> events_{256};
};

}  // namespace skein::mission
