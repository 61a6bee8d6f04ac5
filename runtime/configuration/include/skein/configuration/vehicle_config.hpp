// SPDX-License-Identifier: Apache-2.0
#pragma once

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
#include "skein/coalition/protocol_params.hpp"
#include "skein/configuration/formation_config.hpp"
#include "skein/configuration/process_config.hpp"
#include "skein/configuration/routes_config.hpp"
#include "skein/domain/fence.hpp"
#include "skein/domain/hazard.hpp"
#include "skein/domain/remote_id.hpp"
#include "skein/domain/traffic_params.hpp"
#include "skein/domain/vehicle.hpp"
#include "skein/planning/allocation.hpp"
#include "skein/planning/path_follower.hpp"

namespace skein::configuration {

/// A steady wind and its gusts, in the horizontal plane.
struct WindConfig {
  double speed_mps = 0.0;
  double from_rad = kPi / 2.0;  ///< the direction that it comes from, radians from east
  double gust_mps = 0.0;        ///< standard deviation of the turbulence
};

enum class FlightControllerKind : std::uint8_t { simulated, ardupilot, count };
/// When the companion takes the aircraft from its pilot (docs/ardupilot.md).
enum class TakeOverKind : std::uint8_t { when_guided, in_flight, from_ground, count };

/// An ArduPilot on a CAN bus. The node ids and the serial port are those of its parameters.
struct ArdupilotConfig {
  std::string can;  ///< "can0", "vcan0", "mcast:0"; in a scenario empty: the bench chooses
  std::uint8_t node_id = 10;
  std::uint8_t companion_node_id = 42;
  std::uint8_t system_id = 1;
  std::int8_t serial_id = 0;
  std::string signing_key;  ///< path of its file; empty: MAVLink is not signed
  TakeOverKind take_over = TakeOverKind::when_guided;
  double takeoff_height_m = 40.0;
  double geoid_height_m = 0.0;
  double turn_lead_s = 0.6;      ///< rolling into a turn takes so long
  double airspeed_lead_s = 4.0;  ///< and a change of airspeed
};

struct FlightControllerConfig {
  FlightControllerKind kind = FlightControllerKind::simulated;
  WindConfig wind;  ///< of the simulated flight controller
  ArdupilotConfig ardupilot;

  /// Asked for more per radian, an ArduPlane that flies 25 m/s swings (docs/ardupilot.md).
  static constexpr double kHeadingGainMost_per_s = 0.8;
  /// The rest is for gusts, and to come back to the path.
  static constexpr double kTurnShare = 0.85;
  /// How plans are followed on it; the simulated one needs no leads.
  [[nodiscard]] planning::PathFollowerParams follower() const {
    if (kind != FlightControllerKind::ardupilot) return {};
    return {.turn_lead_s = ardupilot.turn_lead_s,
            .airspeed_lead_s = ardupilot.airspeed_lead_s,
            .heading_gain_most_per_s = kHeadingGainMost_per_s,
            .turn_share = kTurnShare};
  }
};

/// By orders of the ground station: a copter that can do no tasks. Every other vehicle works in
/// coalitions.
[[nodiscard]] bool flies_formation(const VehicleSpec& vehicle);

/// Everything that skein-onboard needs to know (docs/configuration.md).
struct VehicleConfig {
  VehicleSpec vehicle;
  Wgs84 origin;
  Pose2 start;
  std::vector<Vec2> search;  ///< flown in order; the vehicle orbits the last point
  FlightRoute route;         ///< flown before
  FlightControllerConfig flight_controller;
  NetworkConfig network;
  coalition::ProtocolParams protocol;
  TrafficParams traffic;
  planning::AllocationParams planning;
  std::vector<Hazard> hazards;  ///< known before the mission
  Fence fence;                  ///< of the whole team
  FormationConfig formation;    ///< of a vehicle that flies in formation
  RemoteId remote_id;
  std::string detections_socket;  ///< path, where detectors tell of sites; empty: nowhere
  TimeConfig time;
  std::string recording_folder;  ///< empty: nothing is recorded
  std::uint32_t recording_limit_mb = 1000;
  std::uint64_t seed = 1;
};

/// Fails with one line for every mistake in the file: "file:line: key: what is wrong; what to do".
[[nodiscard]] Result<VehicleConfig> load_vehicle_config(const std::filesystem::path& file);
/// As above, from text; `name` stands for the file in messages.
[[nodiscard]] Result<VehicleConfig> parse_vehicle_config(std::string_view yaml,
                                                         const std::string& name);
/// What load_vehicle_config reads back as the same struct.
[[nodiscard]] std::string to_yaml(const VehicleConfig& config);

}  // namespace skein::configuration
