// SPDX-License-Identifier: Apache-2.0
#include "flights.hpp"

#include <utility>

#include "skein/configuration/ground_config.hpp"
#include "skein/configuration/vehicle_config.hpp"
#include "skein/recording/log.hpp"

namespace skein::recording_export {
namespace {

std::optional<MissionOrigin> origin_of(const recording::Session& session) {
  const auto made = [](const auto& config) -> std::optional<MissionOrigin> {
    if (!config) return std::nullopt;
    auto origin = MissionOrigin::make(config->origin);
    if (!origin) return std::nullopt;
    return *origin;
  };
  if (session.configuration.empty()) return std::nullopt;
  if (session.node == kGroundStation) {
    return made(configuration::parse_ground_config(session.configuration, "recording"));
  }
  return made(configuration::parse_vehicle_config(session.configuration, "recording"));
}

}  // namespace

Result<Flights> read_flights(const std::filesystem::path& path) {
  auto log = recording::Log::open(path);
  if (!log) return log.error();
  Flights flights;
  for (const auto& session : log->sessions()) {
    if (!flights.origin) flights.origin = origin_of(session);
  }
  while (auto entry = log->next()) {
    const auto flight = [&]() -> recording::Recording& {
      auto& of = flights.by_node[entry->sender];
      of.vehicle = entry->sender;
      return of;
    };
    if (auto* point = std::get_if<recording::TrackPoint>(&entry->content)) {
      flight().track.push_back(*point);
    } else if (auto* event = std::get_if<mission::MissionEvent>(&entry->content)) {
      flight().events.push_back(std::move(*event));
    } else if (auto* plan = std::get_if<recording::PlanRecord>(&entry->content)) {
      flight().plans.push_back(*plan);
    } else if (auto* place = std::get_if<recording::PlaceRecord>(&entry->content)) {
      flight().places.push_back(*place);
    }
  }
  flights.damaged = log->damaged();
  flights.complete = log->is_complete();
  return flights;
}

}  // namespace skein::recording_export
