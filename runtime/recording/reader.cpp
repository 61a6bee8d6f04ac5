// SPDX-License-Identifier: Apache-2.0
#include "skein/recording/reader.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "node_files.hpp"
#include "records.hpp"

namespace skein::recording {
namespace {

/// The node of a folder's name, where it is one that folder_name() gives.
std::optional<VehicleId> node_of(const std::string& name) {
  if (name == folder_name(kGroundStation)) return kGroundStation;
  const auto dash = name.find('-');
  if (dash == std::string::npos) return std::nullopt;
  VehicleId vehicle;
  const auto [end, error] =
      std::from_chars(name.data() + dash + 1, name.data() + name.size(), vehicle.value);
  if (error != std::errc{} || folder_name(vehicle) != name) return std::nullopt;
  return vehicle;
}

void add(NodeFile& file, Recording& recording) {
  const std::int64_t epoch = file.sessions.front().epoch_unix_ns;
  file.reader.for_each([&](const mcap::Message& message) {
    const auto channel = file.channels.find(message.channel);
    // Most records are messages, which nobody asks for here.
    if (channel == file.channels.end() || channel->second.kind->is_message) return true;
    auto content =
        decode(*channel->second.kind, message.data, instant_of(message.log_time_ns, epoch));
    if (!content) {
      ++recording.damaged_parts;
    } else if (auto* point = std::get_if<TrackPoint>(&*content)) {
      recording.track.push_back(*point);
    } else if (auto* event = std::get_if<mission::MissionEvent>(&*content)) {
      recording.events.push_back(std::move(*event));
    } else if (auto* plan = std::get_if<PlanRecord>(&*content)) {
      recording.plans.push_back(*plan);
    } else if (auto* place = std::get_if<PlaceRecord>(&*content)) {
      recording.places.push_back(*place);
    }
    return true;
  });
  recording.damaged_parts += file.reader.damaged();
}

}  // namespace

Result<Recording> read(const std::filesystem::path& folder, VehicleId vehicle) {
  auto files = open_node(folder);
  if (!files) return files.error();
  Recording recording;
  recording.vehicle = vehicle;
  for (NodeFile& file : *files) add(file, recording);
  return recording;
}

std::vector<SessionRecording> read_sessions(const std::filesystem::path& folder,
                                            VehicleId vehicle) {
  std::vector<SessionRecording> sessions;
  for (NodeFile& file : open_mission(folder, vehicle, std::nullopt)) {
    const Session& session = file.sessions.front();
    if (sessions.empty() || sessions.back().session.instance != session.instance) {
      sessions.push_back({session, {}});
      sessions.back().recording.vehicle = vehicle;
    }
    add(file, sessions.back().recording);
  }
  return sessions;
}

Result<std::vector<Recording>> read_run(const std::filesystem::path& folder) {
  std::error_code failure;
  std::vector<VehicleId> nodes;
  for (std::filesystem::directory_iterator it{folder, failure}, end; !failure && it != end;
       it.increment(failure)) {
    if (const auto node = node_of(it->path().filename().string())) nodes.push_back(*node);
  }
  if (failure) return Error{"cannot read " + folder.string() + ": " + failure.message()};
  std::sort(nodes.begin(), nodes.end());

  std::vector<Recording> recordings;
  for (const VehicleId node : nodes) {
    auto recording = read(folder / folder_name(node), node);
    if (!recording) return recording.error();
    recordings.push_back(std::move(*recording));
  }
  return recordings;
}

}  // namespace skein::recording
