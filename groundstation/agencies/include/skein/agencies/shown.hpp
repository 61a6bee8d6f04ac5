// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "skein/base/frames.hpp"
#include "skein/base/ids.hpp"
#include "skein/base/time.hpp"
#include "skein/domain/remote_id.hpp"
#include "skein/domain/vehicle.hpp"
#include "skein/mission/messages.hpp"

/// What others are shown of the team, whatever they speak.
namespace skein::agencies {

struct ShownVehicle {
  VehicleId id;
  bool copter = false;
  VehicleState state;  ///< the newest that was heard
  Wgs84 place;         ///< of it
  mission::Activity activity{};
  double range_left_m = 0.0;
  std::uint8_t loads = 0;
  bool silent = false;                ///< not heard lately
  std::vector<std::string> problems;  ///< that a person should look at
  RemoteId remote_id{};               ///< without an id: none is said
};

struct ShownSite {
  SiteId id;
  Wgs84 place;
  std::string state;  ///< in words
  bool done = false;
};

struct ShownHazard {
  HazardId id;
  Wgs84 centre;
  double radius_m = 0.0;
};

/// The way that a vehicle has planned.
struct ShownTrack {
  VehicleId vehicle;
  std::vector<Wgs84> points;  ///< two at least
  std::uint16_t legs = 0;     ///< straight ways and turns
  std::uint16_t leg = 0;      ///< that is flown now, from 0
  double left_m = 0.0;        ///< to its end
};

struct Shown {
  std::vector<ShownVehicle> vehicles;
  std::vector<ShownSite> sites;
  std::vector<ShownHazard> hazards;
  std::vector<ShownTrack> tracks;
};

}  // namespace skein::agencies
