// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "skein/base/bounded_queue.hpp"
#include "skein/base/result.hpp"
#include "skein/base/time.hpp"
#include "skein/domain/fence.hpp"
#include "skein/mission/fleet.hpp"
#include "skein/mission/messages.hpp"

namespace skein::mission {

/// One vehicle's route of a plan, and what the vehicle says to it.
struct GivenRoute {
  TimedPath timed;
  std::optional<RouteState> answer;  ///< the newest; none: not heard
  RouteObstacle why = RouteObstacle::nothing;
  std::optional<InstanceId> instance{};  ///< of the program that has answered
  bool told_since = false;               ///< it has answered the plan's step
  bool released = false;                 ///< it alone is told to leave its route
  Instant released_at{};
  Instant next{};  ///< when it is told again
};

/// What routes of a plan have to do with each other.
enum class RouteBond : std::uint8_t {
  together,   ///< all are flown, or none
  each_alone  ///< who cannot fly its own leaves it, and the others fly
};

/// A plan of the operator's.
struct GivenRoutes {
  std::uint32_t plan = 0;
  RouteStep step = RouteStep::offer;
  Instant begins{};
  bool begun = false;  ///< from here on each flies its own
  bool over = false;   ///< nobody is told any more
  Instant step_at{};   ///< when the step was decided on
  RouteBond bond = RouteBond::together;
  bool by_operator = false;  ///< he has called it off
  std::map<VehicleId, GivenRoute> routes;
};

/// The routes that the operator gives vehicles over the air. A plan is offered to all its vehicles,
/// every second until each has answered; when all have taken theirs they are told to fly, in the
/// same way. Where one refuses, does not answer until shortly before the plan begins, or has not
/// taken up the word to fly when it does, the plan is called off for all. From its begin on a
/// vehicle that leaves its route leaves it alone; one whose program starts anew is told again.
/// Where each flies for itself (RouteBond::each_alone) all that holds from the offer on: who
/// refuses or is not heard is left out. One plan at a time. Calling rules as of GroundAgent.
class GroundRoutes {
 public:
  /// A plan must begin this much later, so that all can answer; of more than 32 vehicles, as much
  /// later as it takes to tell all of them twice, 32 each 0.1 s.
  static constexpr Duration kNotice = std::chrono::seconds{5};

  static constexpr std::size_t kVehiclesMax = 1024;

  /// No route that leads out of that fence is given.
  explicit GroundRoutes(Fence fence = {}) : fence_{std::move(fence)} {}
  /// From now on that one.
  void set_fence(const Fence& fence) { fence_ = fence; }

  void recall(const Message& message, VehicleId sender, Instant at);
  void on_message(const Message& message, Instant now);
  void on_timeout(const Fleet& fleet, Instant now);

  using Routes = std::map<VehicleId, TimedPath>;
  /// What the ground station knows to be wrong with them; what it does not know of the vehicles,
  /// these judge themselves. All begin at one time, which is that of the first.
  [[nodiscard]] Result<void> check(const Routes& routes, const std::vector<Hazard>& hazards,
                                   const Fleet& fleet, Instant now) const;
  /// Gives the plan's number. Fails as check() does, and while another plan is given.
  Result<std::uint32_t> give(const Routes& routes, const std::vector<Hazard>& hazards,
                             const Fleet& fleet, Instant now, RouteBond bond = RouteBond::together);
  /// Of the operator. Fails where there is none.
  Result<void> call_off(Instant now);
  /// That vehicle alone leaves its route, for something else; the others fly on. Not before the
  /// plan has begun: false, and nothing is done.
  bool release(VehicleId vehicle, Instant now);
  [[nodiscard]] const Fence& fence() const { return fence_; }

  /// The newest; none before the first.
  [[nodiscard]] const std::optional<GivenRoutes>& given() const { return given_; }

  [[nodiscard]] std::optional<Message> poll_message() { return messages_.pop(); }
  [[nodiscard]] std::optional<MissionEvent> poll_event() { return events_.pop(); }
  [[nodiscard]] Instant next_timeout() const { return next_; }
  [[nodiscard]] std::uint64_t dropped() const { return messages_.dropped() + events_.dropped(); }

 private:
  [[nodiscard]] bool stands() const { return given_ && !given_->over; }
  void recall_own(const Route& route, Instant at);
  void on_status(const RouteStatus& status, Instant now);
  void decide(Instant now);
  void decide_offer(Instant now);
  void decide_flight(Instant now);
  static void leave_out(GivenRoute& route, Instant now);
  void take_step(RouteStep step, Instant now);
  void call_off(const event::RoutesCalledOff& why, Instant now);
  /// False where there is somebody to tell yet.
  bool tell(const Fleet& fleet, Instant now);
  void report(EventBody body, Instant now);

  Fence fence_;
  std::optional<GivenRoutes> given_;
  Instant next_ = Instant::max();
  Instant tell_at_{};
  VehicleId told_last_{};
  BoundedQueue<Message> messages_{128};
  BoundedQueue<MissionEvent> events_{64};
};

}  // namespace skein::mission
