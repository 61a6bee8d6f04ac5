// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "skein/base/ids.hpp"
#include "skein/base/time.hpp"
#include "skein/coalition/messages.hpp"
#include "skein/domain/hazard.hpp"
#include "skein/domain/path.hpp"
#include "skein/domain/site.hpp"
#include "skein/domain/task.hpp"
#include "skein/domain/vehicle.hpp"
#include "skein/formation/change.hpp"
#include "skein/formation/passage.hpp"
#include "skein/mission/events.hpp"

/// What crosses the mission network besides the coalition's own messages.
namespace skein::mission {

/// What a vehicle is doing (Wang 2022, protocol states).
enum class Activity : std::uint8_t {
  searching,
  surveying,
  leading,
  bidding,
  executing,
  monitoring,
  holding,
  forming,   ///< on its way to a place in a formation
  en_route,  ///< flies a route that was planned before the mission
  count
};
[[nodiscard]] std::string_view to_string(Activity activity);

/// Best effort, several times a second.
struct Telemetry {
  VehicleId vehicle;
  InstanceId instance;
  VehicleState state;
  Activity activity = Activity::searching;
  double range_left_m = 0.0;
  std::uint8_t loads = 0;
  std::uint32_t plan_number = 0;  ///< of the flight plan being followed; grows with every new one
  std::uint32_t control_overruns = 0;  ///< missed control periods since the start
  std::uint32_t messages_dropped = 0;  ///< by full queues and bad packets since the start
};

/// A leader asks the operator for a decision on one plan. Sent again until answered.
struct AuthorisationRequest {
  coalition::Round round;
  SiteId site;
  Vec2 site_position{0.0, 0.0};
  struct Delivery {
    TaskAssignment assignment;
    double bearing_rad = 0.0;
  };
  std::vector<Delivery> deliveries;
  Instant decide_by{};  ///< after it the vehicles hold and the plan is timed anew
};

/// The operator's decision on that plan, and on no other. Sent again until it is of no more use.
struct Authorisation {
  coalition::Round round;
  SiteId site;
  bool granted = false;
  std::string decided_by;
  Instant decided_at{};
};

/// From the ground station to one vehicle, or to all (vehicle 0).
struct Command {
  VehicleId vehicle;
  /// Grows; a repeated or older number has no effect. The mission time in ms, plus 1, at which it
  /// was issued, or more where it would not grow; before mission time 0 it tells no time.
  std::uint32_t number = 0;
  CommandKind kind = CommandKind::hold;
};
/// To the millisecond before, for commands issued at mission time 0 or later.
[[nodiscard]] inline Instant issued_at(const Command& command) {
  return Instant{std::chrono::milliseconds{command.number} - std::chrono::milliseconds{1}};
}

/// A survey sensor or an operator has found a site. `finder` is the vehicle that should survey it.
struct SiteReport {
  VehicleId finder;
  Site site;
};

struct HazardReport {
  Hazard hazard;
};

/// Where a vehicle of a formation is, and how far in its change. Best effort, every slot or so
/// (formation::kSlot): the others keep clear of it by what they have heard last.
struct FormationStatus {
  VehicleId vehicle;
  formation::Progress progress;  ///< of change 0 while it has been given none
  Vec3 position_m = Vec3::Zero();
  Vec3 reference_m = Vec3::Zero();  ///< where it is to be; its position before the first change
  bool at_rest = true;
};

/// What the control thread follows. Trivially copyable; a newer number replaces an older one.
struct FlightPlan {
  std::uint32_t number = 0;
  TimedPath timed;
};

/// The plan that a fixed wing follows, for whoever watches it. Sent with each new one and every few
/// seconds; nobody decides by it.
struct PlanReport {
  VehicleId vehicle;
  FlightPlan plan;
};

inline constexpr std::size_t kProblemsMax = 8;
inline constexpr std::size_t kHeardMax = 64;

/// How a vehicle's program is, once a second, for whoever watches it; nobody decides by it.
struct Health {
  VehicleId vehicle;
  InstanceId instance;
  Instant time{};                     ///< by its clock
  std::string program;                ///< name and version
  std::string flight_controller;      ///< its kind
  std::string mode;                   ///< the flight controller's own word; empty where it has none
  std::vector<std::string> problems;  ///< what is wrong now; at most kProblemsMax
  struct Heard {
    VehicleId vehicle;  ///< 0: the ground station
    Duration age{};     ///< since its newest message
  };
  std::vector<Heard> heard;  ///< the newest first; at most kHeardMax
};

using Message = std::variant<coalition::Message, Telemetry, AuthorisationRequest, Authorisation,
                             MissionEvent, Command, SiteReport, HazardReport, formation::Change,
                             FormationStatus, PlanReport, Health>;

}  // namespace skein::mission
