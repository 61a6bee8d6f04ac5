// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/recorder.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <filesystem>
#include <utility>

namespace skein::groundstation {

Result<Recorder> Recorder::open(const std::string& folder, recording::Writer::Options options) {
  Recorder recorder{std::move(options)};
  if (folder.empty()) return recorder;
  if (const auto added = recorder.add(folder, false); !added) return added.error();
  return recorder;
}

Result<void> Recorder::add(const std::string& folder, bool ordered) {
  for (const Running& other : running_) {
    std::error_code none_there;
    if (std::filesystem::equivalent(other.folder, folder, none_there)) {
      return Error{folder + ": is recorded into already; name another folder"};
    }
  }
  auto writer = recording::Writer::open(folder, options_);
  if (!writer) return writer.error();
  running_.push_back({folder, std::move(*writer), ordered});
  return {};
}

Result<void> Recorder::begin(const std::string& folder) {
  if (const auto added = add(folder, true); !added) return added;
  const auto earlier = std::find_if(running_.begin(), running_.end() - 1,
                                    [](const Running& running) { return running.ordered; });
  if (earlier != running_.end() - 1) running_.erase(earlier);
  return {};
}

Result<void> Recorder::end() {
  if (std::erase_if(running_, [](const Running& running) { return running.ordered; }) > 0) {
    return {};
  }
  return Error{
      running_.empty()
          ? "nothing is recorded; 'record FOLDER' begins"
          : "only what the configuration wants is recorded, until the ground station ends"};
}

void Recorder::write(const mission::Message& message, VehicleId sender, Instant now) {
  for (Running& running : running_) running.writer.write(message, sender, now);
}

void Recorder::write(const mission::MissionEvent& event) {
  for (Running& running : running_) running.writer.write(event);
}

void Recorder::write_places(const formation::Change& change) {
  for (Running& running : running_) {
    if (running.change == change.number) continue;
    running.change = change.number;
    for (const formation::Mover& mover : change.movers) {
      running.writer.write(
          recording::PlaceRecord{change.number, change.start, mover.vehicle, mover.points.back()});
    }
  }
}

void Recorder::flush() {
  std::erase_if(running_, [](Running& running) {
    const auto flushed = running.writer.flush();
    if (!flushed) spdlog::error("recording stops: {}", flushed.error().message);
    return !flushed;
  });
}

}  // namespace skein::groundstation
