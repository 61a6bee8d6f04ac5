// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "activity.hpp"
#include "failsafe.hpp"
#include "leader.hpp"
#include "outbox.hpp"
#include "ownship.hpp"
#include "relay_orbit.hpp"
#include "route_flyer.hpp"
#include "scout.hpp"
#include "skein/mission/separation_watch.hpp"
#include "skein/mission/vehicle_agent.hpp"
#include "task_flyer.hpp"

namespace skein::mission {

/// Hands inputs to the parts, and what one part brings forth to the others. What a vehicle does
/// because of its Failsafe is in vehicle_agent_failsafe.cpp.
class VehicleAgent::Impl {
 public:
  explicit Impl(const VehicleAgentConfig& config)
      : outbox{config.vehicle.id},
        ownship_{config},
        separation_{config.protocol, config.vehicle.id, config.instance, config.vehicle.height_m},
        traffic_{config.traffic} {}

  void on_state(const VehicleState& state, Instant now);
  void on_message(const Message& message, Instant now);
  void on_planning_result(const PlanningResult& result, Instant now);
  void on_timeout(Instant now) { step(now); }
  void on_bar(Bar bar, Instant now);
  std::string keep_fence(const Fence& fence, Instant now);
  [[nodiscard]] std::optional<Guidance> poll_guidance() { return ownship_.poll_guidance(); }
  [[nodiscard]] Instant next_timeout() const;
  [[nodiscard]] Instant quiet_until(Instant now) const;
  [[nodiscard]] Telemetry telemetry() const;
  [[nodiscard]] Activity activity() const;
  [[nodiscard]] Counters counters() const;
  void on_piloted(bool piloted, Instant now);
  [[nodiscard]] const SeparationWatch& separation() const { return separation_; }
  [[nodiscard]] const TrafficWatch& traffic() const { return traffic_; }
  [[nodiscard]] bool range_spent() const { return failsafe_.facts().range_spent; }

  Outbox outbox;

 private:
  // Everything that came in is worked off before a call returns.
  void step(Instant now);
  void pump(Instant now);
  void pass_on(Instant now);
  void check() const;
  void send(const coalition::Message& message, Instant now);
  void receive(const coalition::Message& message, Instant now);
  void say_last_words(Instant now);
  void answer(const coalition::Participant::Output& output, Instant now);
  [[nodiscard]] coalition::Reason otherwise_engaged(const coalition::Announcement& call) const;
  void on_authorisation(const Authorisation& message, Instant now);
  void idle(Instant now);
  [[nodiscard]] PartStates part_states() const;
  [[nodiscard]] bool may_lead() const;
  [[nodiscard]] Instant idle_until(Instant now) const;
  [[nodiscard]] Instant scout_timeout() const;

  void on_command(const Command& message, Instant now);
  void obey(CommandKind order, Instant now);
  [[nodiscard]] bool ends_anywhere() const {
    return failsafe_.facts().range_spent && !ownship_.comes_home() &&
           ownship_.config().lands_by_itself;
  }
  [[nodiscard]] bool flight_ends(Instant now) const;
  void come_down(Instant now);
  void on_return_flight(const ReturnFlight& message, Instant now);
  void on_site(const SiteReport& message, Instant now);
  void on_hazard(const HazardReport& told, Instant now);
  void on_telemetry(const Telemetry& message, Instant now);
  [[nodiscard]] RouteStanding route_standing() const;
  void watch_range(Instant now);
  void watch_wind(const VehicleState& state, Instant now);
  void watch_fence(Instant now);
  void watch_orbit(Instant now);
  [[nodiscard]] bool may_leave_layer() const;
  void watch_traffic(Instant now);
  void watch_separation(Instant now);
  void respond(const Failsafe::Response& response, Instant now);

  Ownship ownship_;
  Scout scout_{ownship_, outbox};
  Leader leader_{ownship_, outbox};
  TaskFlyer flyer_{ownship_, outbox};
  RelayOrbit relay_{ownship_};
  SeparationWatch separation_;
  TrafficWatch traffic_;
  CommandFilter commands_;
  std::optional<Instant> hears_below_at_;  ///< those that it is to come down through
  std::optional<Instant> may_land_at_;     ///< where the air below is free
  Failsafe failsafe_;
  RouteFlyer routes_{ownship_, outbox};
  std::uint32_t return_plan_ = 0;              ///< the newest that it flies
  bool lands_ = false;                         ///< by order, once it is at home
  bool was_landing_ = false;                   ///< with the last state
  bool told_barred_ = false;                   ///< that a hazard keeps it from that
  std::optional<CommandKind> order_at_start_;  ///< heard before, on the way up perhaps
};

}  // namespace skein::mission
