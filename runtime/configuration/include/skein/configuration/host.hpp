// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "skein/base/ids.hpp"

namespace skein::configuration {

/// What flies a vehicle of a mixed mission: its own flight controller, or skein-fc, which the bench
/// starts there.
enum class HostFlightController : std::uint8_t { own, emulated, count };

/// Where one program of a fleet runs, and how the machine is reached (docs/fleet.md).
struct Host {
  VehicleId node;        ///< 0: the ground station
  std::string address;   ///< IPv4, of the mission network
  std::string ssh;       ///< as ssh takes it; empty: this machine
  std::string run;       ///< words before every command there, such as "sudo -n"
  std::string programs;  ///< folder, to start them directly; empty: they are units of systemd
  std::string configurations = "/etc/skein";
  std::string recordings = "/var/lib/skein";
  std::string can;           ///< in place of the vehicle's bus; empty: as the vehicle says
  std::string radio_plugin;  ///< of mixed missions; empty: plain UDP
  HostFlightController flight_controller = HostFlightController::own;

  friend bool operator==(const Host&, const Host&) = default;
};

}  // namespace skein::configuration
