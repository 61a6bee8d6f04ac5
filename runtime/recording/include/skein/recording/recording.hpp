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
#include "skein/mission/messages.hpp"
#include "skein/mission/onboard_agent.hpp"

/// What every process writes while it runs and every judge reads afterwards: MCAP files, one folder
/// a node (docs/recordings.md). Everything in them is exact.
namespace skein::recording {

/// How a vehicle flew, at one moment.
struct TrackPoint {
  VehicleState state;
  std::uint32_t plan_number = 0;  ///< of the plan that control followed then; 0 before the first
  double along_error_m = 0.0;     ///< positive when ahead of time
  double cross_error_m = 0.0;     ///< positive when left of the path
};

/// A flight plan, and when control began to follow it. It was in force until the next one's
/// `since`.
struct PlanRecord {
  std::uint32_t number = 0;
  Instant since{};
  TimedPath plan;
};

/// Where a vehicle is to be at the end of a change of formation.
struct PlaceRecord {
  std::uint32_t change = 0;
  Instant start{};
  VehicleId vehicle;
  Vec3 place_m = Vec3::Zero();
};

/// A message of the mission network, as the node sent it, or as it was given it.
struct MessageRecord {
  mission::Message message;
  VehicleId sender;
  Instant now{};
};

/// So many records had no room on their way to the file, since the last that says so.
struct Gap {
  std::uint64_t lost = 0;
};

/// What a vehicle's node is given besides messages, and what it gives besides them, each at the
/// `now` of the step that it was given in.
struct AgentStart {
  InstanceId instance;
  std::string program;  ///< as it names itself
  Instant now{};
};
struct StateGiven {
  VehicleState state;
  Instant now{};
};
struct PlanningGiven {
  coalition::Round round;
  std::uint64_t expired_after = 0;  ///< its budget was spent when asked this often; 0: never
  Duration took{};
  Instant now{};
};
struct TimeoutGiven {
  Instant now{};
};
struct NoticeGiven {
  mission::FlightNotice notice;
  Instant now{};
};
struct ConditionGiven {
  mission::Condition condition;
  Instant now{};
};
/// The next message under this vehicle's number was given, not said: another node has it too.
struct NamesakeHeard {
  Instant now{};
};
struct PlanMade {
  std::shared_ptr<const mission::FlightPlan> plan;  ///< never null; large, so kept elsewhere
  Instant now{};
};
/// A motion track, of which there is one in every slot, by its digest.
struct TrackMade {
  std::uint32_t number = 0;
  Instant start{};
  std::uint16_t points = 0;
  Vec3 first_m = Vec3::Zero();
  std::uint64_t digest = 0;  ///< FNV-1a of all its values
  Instant now{};
};
using GuidanceMade = std::variant<PlanMade, TrackMade>;
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

/// A node's files within its folder: the newest, and the one before it. A run's file, within its
/// folder, when merge_run() has made it.
inline constexpr const char* kFileName = "recording.mcap";
inline constexpr const char* kOlderFileName = "recording.1.mcap";
inline constexpr const char* kRunFileName = "mission.mcap";

}  // namespace skein::recording
