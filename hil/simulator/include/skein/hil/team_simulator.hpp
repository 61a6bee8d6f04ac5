// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "skein/base/attitude.hpp"
#include "skein/base/geometry.hpp"
#include "skein/base/result.hpp"
#include "skein/base/time.hpp"
#include "skein/coalition/protocol_params.hpp"
#include "skein/configuration/formation_config.hpp"
#include "skein/configuration/scenario.hpp"
#include "skein/domain/fence.hpp"
#include "skein/domain/hazard.hpp"
#include "skein/domain/site.hpp"
#include "skein/domain/traffic_params.hpp"
#include "skein/domain/vehicle.hpp"
#include "skein/hil/fault.hpp"
#include "skein/hil/radio/radio_model.hpp"
#include "skein/mission/ground_agent.hpp"
#include "skein/mission/ground_node.hpp"
#include "skein/mission/messages.hpp"
#include "skein/mission/vehicle_agent.hpp"
#include "skein/models/wind.hpp"
#include "skein/planning/allocation.hpp"

namespace skein::hil {

/// What a simulated vehicle is under its flight controller (hal::FlightController).
enum class Body : std::uint8_t {
  heading_dynamics,  ///< a fixed wing, by models::HeadingDynamics
  multirotor,        ///< a point that follows its reference as well as gusts let it
  hexarotor          ///< six degrees of freedom, by hal::SimulatedMultirotor
};

struct SimulatedVehicle {
  VehicleSpec spec;
  Pose2 start;
  std::vector<Vec2> search;
  Body body = Body::heading_dynamics;
  /// By orders of the ground station; otherwise it works in coalitions.
  bool flies_formation = false;
  /// The number under which it speaks and hears, where that is another vehicle's: then the one of
  /// its `spec` is what it is told apart by from outside alone.
  std::optional<VehicleId> flies_as = std::nullopt;

  [[nodiscard]] VehicleId number() const { return flies_as.value_or(spec.id); }
};

/// A whole mission in virtual time.
struct TeamMission {
  std::vector<SimulatedVehicle> vehicles;
  std::vector<Site> sites;
  /// Sites that nobody's sensor finds: each is told, from its time on, to the nearest vehicle that
  /// can survey and is searching.
  std::map<SiteId, Instant> reported;
  std::vector<TimedHazard> hazards;
  Fence fence{};
  coalition::ProtocolParams protocol;
  planning::AllocationParams planning;
  TrafficParams traffic;
  std::vector<configuration::PassingAircraft> aircraft;  ///< that the ground station hears
  std::vector<mission::ScriptedDecision> decisions;
  radio::RadioParams radio;
  models::WindParams wind;
  bool heeds_wind = false;  ///< planes plan as on an autopilot (mission::VehicleAgentConfig)
  Duration allocation_takes = std::chrono::milliseconds{50};  ///< in virtual time
  Duration duration_max = std::chrono::seconds{300};
  bool ends_landed = false;  ///< then all are ordered home, and to land
  std::uint64_t seed = 1;
  std::vector<Fault> faults;  ///< of the scenario, and drawn ones
  /// With the script that is flown; there is one where some vehicle flies in formation.
  std::optional<configuration::FormationConfig> formation;
  /// Of any plane from where it is to be while the formation holds, root mean square; 0: not
  /// judged.
  double place_rms_m = 0.0;
  /// Of how far gusts push a multirotor from its reference, per axis; never beyond 0.3 m.
  double gust_error_m = 0.05;
};

/// A fault, or a part of its mending, that took place.
struct FaultEvent {
  enum class Kind : std::uint8_t {
    ended,
    gone,
    restarted,
    joined,
    reported,
    appeared,
    healed,
    radio,
    ordered,
    stands_still,
    piloted,
    given_back
  };
  Instant time{};
  Kind kind = Kind::healed;
  VehicleId vehicle;  ///< where it applies
  std::string text;
  Duration lasts{};  ///< that a program stands still, or a pilot has the aircraft
};

/// A body as whoever watches from outside sees it.
struct SeenBody {
  VehicleId vehicle;
  Vec3 position_m = Vec3::Zero();
  bool airborne = false;
  double off_m = 0.0;   ///< from its reference, while it has one
  bool unled = false;   ///< it has no program, or its pilot has it
  bool adrift = false;  ///< it has none, and comes down as it may
};

/// What a vehicle itself has to say at a moment, whether it is heard or not.
struct OwnWord {
  VehicleId vehicle;
  std::optional<mission::Telemetry> telemetry;  ///< none: its program does not run
};

/// Where an aircraft that is not of the team is then; none before it is heard, and after it was.
[[nodiscard]] std::optional<mission::Aircraft> place_of(
    const configuration::PassingAircraft& aircraft, Instant now);

/// What is observed while it runs; called in the order of time, and all times are true mission
/// time, whatever a vehicle's clock says.
struct TeamObserver {
  std::function<void(const mission::MissionEvent&)>
      event;  ///< of vehicles and of the ground (id 0)
  std::function<void(VehicleId, const mission::FlightPlan&, Instant)> plan;
  /// The plan has number 0 while a copter takes off.
  std::function<void(VehicleId, const VehicleState&, const mission::FlightPlan&)> track;
  std::function<void(const FaultEvent&)> fault;
  /// Whatever is sent, as it would go through the codec.
  std::function<void(const mission::Message&)> message;
  /// What a vehicle's program is given of the network.
  std::function<void(VehicleId, const mission::Message&, Instant)> heard;
  /// All that fly in formation, in the mission's order, at every control step.
  std::function<void(Instant, const std::vector<SeenBody>&)> bodies;
  /// What the ground station's program takes from the network, or says itself (sender 0), in its
  /// own time; and every event that it shows.
  std::function<void(const mission::Message&, VehicleId sender, Instant)> ground_message;
  std::function<void(const mission::MissionEvent&)> ground_event;
  /// At every step of the nodes, while the ground station's program runs.
  std::function<void(Instant, const mission::GroundNode&, const std::vector<OwnWord>&)> moment;
};

/// A vehicle when the mission ended.
struct VehicleEnd {
  VehicleId vehicle;
  bool gone = false;   ///< its agent ended for good
  bool spent = false;  ///< its battery has fallen: it comes home
  bool barred =
      false;  ///< it does not work with the others (mission::Bar, its number is used twice)
  std::uint8_t loads = 0;
  double range_left_m = 0.0;
  Vec2 position{0.0, 0.0};
  bool landed = false;   ///< by the operator's order
  bool in_place = true;  ///< it has come to where its newest change of formation ends
};

struct TeamResult {
  Instant ended_at{};
  std::size_t sites_done = 0;
  std::uint64_t messages = 0;         ///< of vehicles, but telemetry; counted once for each sender
  std::uint64_t protocol_errors = 0;  ///< sum over the vehicles
  std::uint64_t dropped = 0;  ///< messages and events that an agent's queues had no room for
  std::vector<VehicleEnd> vehicles;
  bool ground_gone = false;  ///< its program ended for good
  /// What it last said in the newest change of the formation.
  std::optional<mission::MissionEvent> ground_warning;
};

/// Fails where the formation's script, or a shape's file, cannot be read.
[[nodiscard]] Result<void> check_script(const TeamMission& mission);

/// Flies the mission with the production agents and ground station, guidance and vehicle models, in
/// one thread and in virtual time. It ends at duration_max, or before it when all is done: the
/// sites, by work or by the operator's refusal (and 5 s more, and not before the radio has healed);
/// with ends_landed all that fly have landed then, too; the formation's script (and 2 s of rest
/// more; 30 s where it is not done, and nothing moves any more); or when all that are left have
/// landed at the end of their range. Precondition: check_script().
/// Nothing in it reads a clock or an unseeded generator: the same mission gives the same calls,
/// byte for byte.
TeamResult simulate_team(const TeamMission& mission, const TeamObserver& observer);

[[nodiscard]] std::string text_of(const FaultEvent& event);
/// One line an event, for traces and their comparison.
[[nodiscard]] std::string trace_line(const mission::MissionEvent& event);
[[nodiscard]] std::string trace_line(const FaultEvent& event);
/// What goes wrong in the mission, a line each: its faults, and what was drawn with them.
[[nodiscard]] std::string describe(const TeamMission& mission);

}  // namespace skein::hil
