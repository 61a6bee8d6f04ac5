// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "skein/base/angles.hpp"
#include "skein/base/frames.hpp"
#include "skein/base/geometry.hpp"
#include "skein/base/result.hpp"
#include "skein/base/time.hpp"
#include "skein/coalition/protocol_params.hpp"
#include "skein/configuration/ground_config.hpp"
#include "skein/configuration/host.hpp"
#include "skein/configuration/process_config.hpp"
#include "skein/configuration/routes_config.hpp"
#include "skein/configuration/site_config.hpp"
#include "skein/configuration/tasking.hpp"
#include "skein/configuration/vehicle_config.hpp"
#include "skein/domain/fence.hpp"
#include "skein/domain/hazard.hpp"
#include "skein/domain/site.hpp"
#include "skein/domain/vehicle.hpp"
#include "skein/planning/allocation.hpp"

namespace skein::configuration {

/// Who passes on what others say.
enum class MeshKind : std::uint8_t { none, vehicles, all };
inline constexpr std::array<std::string_view, 3> kMeshKinds{"none", "vehicles", "all"};

/// The radio between the nodes.
struct RadioConfig {
  double range_m = 1500.0;          ///< vehicle to vehicle; beyond it nothing arrives
  double ground_range_m = 20000.0;  ///< ground station to vehicle
  Duration delay_mean = std::chrono::milliseconds{60};
  Duration delay_jitter = std::chrono::milliseconds{30};  ///< delays lie within mean +- jitter
  double loss_ratio = 0.0;                                ///< of messages, independently
  MeshKind mesh = MeshKind::none;
  double bytes_per_s = 0.0;  ///< of the channel around each node; 0: there is always room
};

/// One vehicle of the fleet, the three levels of the file already merged.
struct ScenarioVehicle {
  std::string type;
  VehicleSpec spec;
  Pose2 start;
  std::vector<Vec2> search;                  ///< flown in order; the vehicle orbits the last point
  FlightRoute route;                         ///< of a plan; not of the scenario's file
  FlightControllerConfig flight_controller;  ///< its wind is the scenario's
};

enum class FaultKind : std::uint8_t { kill_vehicle, partition, loss, flood, battery };

/// Something that goes wrong.
struct Fault {
  Instant at{};
  FaultKind kind = FaultKind::partition;
  Duration duration{};  ///< of a partition, of loss, of a flood
  /// That is killed or floods, 0 = ground station; or whose battery falls.
  VehicleId vehicle;
  std::vector<std::vector<VehicleId>> groups;  ///< that hear themselves only; 0 = ground station
  double loss_ratio = 0.0;                     ///< in place of the radio's
  double battery_percent = 0.0;                ///< that it falls to
};

/// Published values of one site, to be printed beside ours. Mission time.
struct ReferenceSite {
  SiteId site;
  std::optional<VehicleId> found_by;
  std::optional<double> survey_done_s;
  std::optional<double> formed_s;
  std::optional<int> coalition_size;
  std::vector<double> delivery_times_s;
  std::optional<double> assessment_done_s;
  std::optional<double> allocation_time_s;
};

/// What the judges hold a run to.
struct Expectations {
  double delivery_spread_s = 1.0;  ///< between the first and the last of simultaneous deliveries
  double slot_error_s = 1.0;       ///< of a sequential delivery
  double bearing_error_rad = radians(5.0);
  double miss_distance_m = 30.0;  ///< horizontal, passing over the site
  double assess_start_error_s = 1.0;
  double place_rms_m = 0.3;                 ///< of any vehicle while a formation holds
  double arrival_spread_s = 0.3;            ///< from the first vehicle in its place to the last
  double separation_horizontal_m = 20.0;    ///< two vehicles closer than this ...
  double separation_vertical_m = 5.0;       ///< ... are at least that far apart in height
  int coalitions = 0;                       ///< that form and finish
  std::vector<SiteId> first_attempt_fails;  ///< sites whose leader has to monitor first
  std::vector<VehicleId> vehicles_lost;     ///< by faults
  Capabilities copters_fly;                 ///< each of these kinds at least once
};

/// Where everybody is when a mission is over: where its work leaves them, or ordered home and
/// landed.
enum class Ending : std::uint8_t { in_the_air, landed };
inline constexpr std::array<std::string_view, 2> kEndings{"in_the_air", "landed"};

/// An aircraft that is not of the team, and is heard from one place to the other.
struct PassingAircraft {
  std::uint32_t address = 0;  ///< of ICAO
  Vec2 from_m{0.0, 0.0};
  Vec2 to_m{0.0, 0.0};
  double height_m = 0.0;  ///< above the origin, where it is first heard
  double climb_mps = 0.0;
  double speed_mps = 0.0;
  Instant at{};
};

/// A mission: the fleet, the sites, the world and what must come out (docs/scenarios.md).
struct Scenario {
  std::string title;
  std::string notes;
  std::uint64_t seed = 1;
  Wgs84 origin;
  Duration duration_max = std::chrono::seconds{300};
  RadioConfig radio;
  AirConfig air;
  std::uint16_t air_port = 7400;  ///< of a fleet in the field; a bench looks for a free one
  WindConfig wind;
  coalition::ProtocolParams protocol;
  planning::AllocationParams planning;
  TrafficParams traffic;
  std::vector<PassingAircraft> aircraft;  ///< in virtual time
  std::vector<ScenarioVehicle> vehicles;
  std::vector<Site> sites;
  std::vector<SiteTemplate> site_templates;  ///< for the ground station
  std::vector<TimedHazard> hazards;
  Fence fence;
  std::vector<OperatorDecision> operator_decisions;
  FormationConfig formation;
  RoutesConfig routes;
  TaskingConfig tasking;
  Ending ends = Ending::in_the_air;
  std::vector<Fault> faults;
  std::vector<ReferenceSite> reference;
  Expectations expect;
  // Of a fleet in the field (docs/fleet.md); a bench heeds the hosts of external vehicles only.
  std::optional<std::int64_t> epoch_unix_ns;  ///< nothing: given when it is rendered
  ConsoleConfig console;
  AgenciesConfig agencies;
  TeamRemoteId remote_id;
  std::vector<Host> hosts;

  /// Some vehicle does, by orders of the ground station.
  [[nodiscard]] bool flies_formation() const;
  /// Planned before the mission.
  [[nodiscard]] bool flies_routes() const { return !routes.approaches.empty(); }
  /// Before the mission, too.
  [[nodiscard]] bool tasks_sites() const { return !tasking.known.empty(); }
};

/// Fails with one line for every mistake in the file: "file:line: key: what is wrong; what to do".
/// Call check() too: it finds what is well written and cannot be flown.
[[nodiscard]] Result<Scenario> load_scenario(const std::filesystem::path& file);
/// As above, from text; `name` stands for the file in messages.
[[nodiscard]] Result<Scenario> parse_scenario(std::string_view yaml, const std::string& name);
/// What load_scenario reads back as the same struct.
[[nodiscard]] std::string to_yaml(const Scenario& scenario);

/// Finds missions that no planner could fly: missing capabilities, loads or range, hazards on
/// starts, sites and final approaches, vehicles of one height, a radio slower than the protocol
/// allows, names of vehicles and sites that do not exist. Fails with one sentence a line.
[[nodiscard]] Result<void> check(const Scenario& scenario);
/// Both: what check() finds is said of `file`, too.
[[nodiscard]] Result<Scenario> load_flyable_scenario(const std::filesystem::path& file);

}  // namespace skein::configuration
