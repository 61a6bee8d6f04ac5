// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "skein/base/ids.hpp"
#include "skein/base/time.hpp"
#include "skein/domain/path.hpp"
#include "skein/domain/vehicle.hpp"
#include "skein/idl/recording.hpp"
#include "skein/mission/messages.hpp"
#include "skein/mission/onboard_agent.hpp"

/// What every process writes while it runs and every judge reads afterwards: MCAP files, one folder
/// a node (docs/recordings.md). Everything in them is exact.
namespace skein::recording {

/// A message of the mission network, as the node sent it, or as it was given it.
struct MessageRecord {
  mission::Message message;
  VehicleId sender;
  Instant now{};
};

using GuidanceMade = std::variant<PlanMade, TrackMade>;
/// A motion track by its digest.
[[nodiscard]] GuidanceMade made(const mission::Guidance& guidance, Instant now);

/// What the agent's thread leaves for the recorder, in its order.
using AgentRecord = std::variant<AgentStart, StateGiven, MessageRecord, PlanningGiven, TimeoutGiven,
                                 NoticeGiven, ConditionGiven, NamesakeHeard, PlanMade, TrackMade>;

/// All that one node recorded of the flight.
struct Recording {
  VehicleId vehicle;  ///< kGroundStation for the ground station, which has events only
  std::vector<TrackPoint> track;
  std::vector<mission::MissionEvent> events;
  std::vector<PlanRecord> plans;
  std::size_t damaged_parts = 0;         ///< of its files, left out: a process ended abruptly
  std::vector<PlaceRecord> places = {};  ///< of the ground station
};

/// Which process wrote a file.
struct Session {
  VehicleId node;
  InstanceId instance;
  std::string program;
  std::string version;
  /// Mission time 0 as Unix time. Files say Unix time: mission time is it less this.
  std::int64_t epoch_unix_ns = kEpochOfTests;
  std::string configuration;  ///< the process's, as YAML

  /// A time of which mission times before 0 can be subtracted, for records without a clock:
  /// 2001-09-09 01:46:40 UTC.
  static constexpr std::int64_t kEpochOfTests = 1'000'000'000'000'000'000;
};

/// The name of a node's folder within the folder of a run: "vehicle-07", "ground".
[[nodiscard]] std::string folder_name(VehicleId vehicle);

/// A node's files within its folder: the newest, and those before it, the newest of them first. A
/// run's file, within its folder, when merge_run() has made it.
inline constexpr const char* kFileName = "recording.mcap";
/// "recording.1.mcap"
[[nodiscard]] std::string older_file_name(int age);
inline constexpr const char* kRunFileName = "mission.mcap";

}  // namespace skein::recording
