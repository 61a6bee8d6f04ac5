// SPDX-License-Identifier: Apache-2.0
#include "flight_controllers.hpp"

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <chrono>
#include <memory>

#include "skein/base/angles.hpp"
#include "skein/can/bus.hpp"
#include "user_autopilots.hpp"

namespace skein::hil {
namespace {

constexpr std::uint64_t kBuses = 256;
/// A flight controller speaks ten times a second and more.
constexpr auto kListen = std::chrono::milliseconds{300};

}  // namespace

Result<std::vector<std::string>> quiet_buses(std::size_t count, std::uint64_t seed) {
  std::vector<std::unique_ptr<can::Bus>> buses;
  // Bus 0 is where simulated ArduPilots are by default.
  for (std::uint64_t i = 0; i < 2 * count + 8; ++i) {
    auto bus = can::open("mcast:" + std::to_string(1 + (seed + i) % (kBuses - 1)));
    if (!bus) return bus.error();
    buses.push_back(std::move(bus).value());
  }
  const auto until = std::chrono::steady_clock::now() + kListen;
  while (true) {
    std::vector<pollfd> items;
    items.reserve(buses.size());
    for (const auto& bus : buses) items.push_back({bus->descriptor(), POLLIN, 0});
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
        until - std::chrono::steady_clock::now());
    if (left.count() <= 0 || items.empty()) break;
    (void)::poll(items.data(), items.size(), static_cast<int>(left.count()));
    std::erase_if(buses, [](const auto& bus) { return bus->receive().has_value(); });
  }
  if (buses.size() < count) {
    return Error{
        fmt::format("only {} of {} multicast CAN buses are quiet; stop other flight controllers on "
                    "this machine",
                    buses.size(), count)};
  }
  std::vector<std::string> names;
  for (std::size_t i = 0; i < count; ++i) names.push_back(buses[i]->name());
  return names;
}

namespace {

/// Cruise of a plane; a copter may be faster than its plan, to be where that is, as far as the
/// emulated one flies.
double emulated_speed_mps(const VehicleSpec& spec) {
  constexpr double kCopterMost_mps = 10.0;
  if (!spec.is_copter()) return spec.cruise_speed_mps;
  return std::max(spec.cruise_speed_mps, std::min(spec.speed_max_mps, kCopterMost_mps));
}

}  // namespace

std::vector<std::string> flight_controller_command(
    const std::filesystem::path& programs, const configuration::VehicleConfig& vehicle,
    std::optional<std::uint16_t> truth_port, const std::vector<configuration::Fault>& faults) {
  const VehicleSpec& spec = vehicle.vehicle;
  const configuration::ArdupilotConfig& fc = vehicle.flight_controller.ardupilot;
  const configuration::WindConfig& wind = vehicle.flight_controller.wind;
  const auto number = [](double value) { return fmt::format("{:.10g}", value); };
  // clang-format off
  std::vector<std::string> command{(programs / "skein-fc").string(),
          "--bus", fc.can,
          "--node", std::to_string(fc.node_id),
          "--companion", std::to_string(fc.companion_node_id),
          "--system", std::to_string(fc.system_id),
          "--serial", std::to_string(fc.serial_id),
          "--airframe", std::string{to_string(spec.airframe)},
          "--origin", number(vehicle.origin.latitude_deg), number(vehicle.origin.longitude_deg),
          number(vehicle.origin.height_m - fc.geoid_height_m),
          "--failsafe",
          "--start", number(vehicle.start.x_m), number(vehicle.start.y_m), number(spec.height_m),
          "--heading", number(compass_deg_from_heading(vehicle.start.heading_rad)),
          "--speed", number(emulated_speed_mps(spec)),
          "--speed-min", number(spec.speed_min_mps),
          "--speed-max", number(spec.speed_max_mps),
          "--turn-radius", number(spec.turn_radius_m),
          "--wind-speed", number(wind.speed_mps),
          "--wind-from", number(compass_deg_from_heading(wind.from_rad)),
          // The air of a user's own ArduPilot in its simulator, so that flights with either compare.
          "--turbulence", number(wind.gust_mps),
          "--seed", std::to_string(vehicle.seed)};
  // clang-format on
  if (configuration::flies_formation(spec)) {
    command.insert(command.end(), {"--climb", number(climb_needed_mps(spec))});
  } else {
    command.insert(command.end(), {"--airborne", "--mode", "LOITER", "--hold-until",
                                   std::to_string(vehicle.time.epoch_unix_ns)});
  }
  if (!fc.signing_key.empty()) command.insert(command.end(), {"--signing-key", fc.signing_key});
  if (vehicle.remote_id.exists()) command.emplace_back("--remote-id");
  if (vehicle.fence.exists()) {
    command.insert(command.end(), {"--fence-height", number(vehicle.fence.height_max_m)});
  }
  if (truth_port) command.insert(command.end(), {"--truth", std::to_string(*truth_port)});
  for (const configuration::Fault& fault : faults) {
    if (fault.kind != configuration::FaultKind::battery || fault.vehicle != spec.id) continue;
    command.insert(command.end(), {"--at", number(to_seconds(fault.at)) + " battery " +
                                               number(fault.battery_percent)});
  }
  return command;
}

Result<void> batteries_can_fall(const configuration::Scenario& scenario,
                                const UserAutopilots& autopilots) {
  for (const configuration::Fault& fault : scenario.faults) {
    if (fault.kind != configuration::FaultKind::battery) continue;
    const auto vehicle = std::ranges::find_if(
        scenario.vehicles, [&fault](const auto& v) { return v.spec.id == fault.vehicle; });
    const bool emulated =
        vehicle != scenario.vehicles.end() &&
        vehicle->flight_controller.kind == configuration::FlightControllerKind::ardupilot &&
        autopilots.of(vehicle->spec) == nullptr;
    if (emulated) continue;
    return Error{fmt::format(
        "battery_vehicle {}: only a battery that skein-fc emulates can fall; give the vehicle "
        "flight_controller: {{kind: ardupilot}}, and no --autopilot of its airframe",
        fault.vehicle.value)};
  }
  return {};
}

}  // namespace skein::hil
