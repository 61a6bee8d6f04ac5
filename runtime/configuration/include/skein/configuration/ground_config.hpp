// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "skein/base/frames.hpp"
#include "skein/base/result.hpp"
#include "skein/coalition/protocol_params.hpp"
#include "skein/configuration/agencies_config.hpp"
#include "skein/configuration/command_config.hpp"
#include "skein/configuration/formation_config.hpp"
#include "skein/configuration/process_config.hpp"
#include "skein/configuration/remote_id_config.hpp"
#include "skein/configuration/site_config.hpp"
#include "skein/domain/fence.hpp"
#include "skein/domain/hazard.hpp"
#include "skein/domain/traffic_params.hpp"
#include "skein/domain/vehicle.hpp"
#include "skein/planning/allocation.hpp"

namespace skein::configuration {

/// The web console.
struct ConsoleConfig {
  std::string address = "127.0.0.1";
  std::uint16_t port = 7460;  ///< 0: there is none
  std::string passwords;      ///< file; empty: whoever reaches it is the operator
  std::string certificate;    ///< PEM files
  std::string key;
  std::string tiles;  ///< folder z/x/y.png or MBTiles file; empty: none
  struct Overlay {
    std::string name;
    std::string file;  ///< GeoJSON
  };
  std::vector<Overlay> overlays;
  struct Group {
    std::string name;
    std::vector<VehicleId> vehicles;
  };
  std::vector<Group> groups;
  /// Where a vehicle's pictures are: a link that people follow, and that no program of ours opens.
  struct Video {
    VehicleId vehicle;
    std::string url;
  };
  std::vector<Video> videos;
};

/// Everything that skein-ground needs to know (docs/configuration.md).
/// Whose key signs what is authorised on this machine (docs/keys.md), from the start on.
struct OperatorConfig {
  std::string name;           ///< empty: whoever unlocks his later
  std::string password_file;  ///< its first line
};

struct GroundConfig {
  Wgs84 origin;
  NetworkConfig network;
  coalition::ProtocolParams protocol;
  TrafficParams traffic;
  planning::AllocationParams planning;
  TimeConfig time;
  std::vector<VehicleId> vehicles;  ///< the fleet that is expected
  /// Empty: the operator types at the prompt.
  std::vector<OperatorDecision> operator_decisions;
  std::vector<Hazard> hazards;  ///< known before the mission
  Fence fence;                  ///< of the whole team
  std::vector<SiteTemplate> site_templates;
  DetectionsConfig detections;
  FormationConfig formation;
  std::vector<VehicleSpec> planes;  ///< of a formation of planes: what each can do
  ConsoleConfig console;
  AgenciesConfig agencies;
  TeamRemoteId remote_id;
  CommandConfig command;
  OperatorConfig op;
  std::string control_socket;    ///< its name; empty: by the network's port
  std::string recording_folder;  ///< empty: nothing is recorded
  std::uint32_t recording_limit_mb = 1000;
};

/// Fails with one line for every mistake in the file: "file:line: key: what is wrong; what to do".
[[nodiscard]] Result<GroundConfig> load_ground_config(const std::filesystem::path& file);
/// As above, from text; `name` stands for the file in messages.
[[nodiscard]] Result<GroundConfig> parse_ground_config(std::string_view yaml,
                                                       const std::string& name);
/// What load_ground_config reads back as the same struct.
[[nodiscard]] std::string to_yaml(const GroundConfig& config);

}  // namespace skein::configuration
