// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/emulated_flight_controller.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "battery.hpp"
#include "copter_vehicle.hpp"
#include "mavlink_endpoint.hpp"
#include "plane_vehicle.hpp"
#include "skein/dronecan/node.hpp"
#include "skein/dronecan/tunnel.hpp"
#include "telemetry.hpp"

namespace skein::hil {
namespace {

using namespace std::chrono_literals;

/// After a restart, as measured of ArduPilot 4.6.3: NodeStatus is back, and MAVLink.
constexpr Duration kBusAfter = 1200ms;
constexpr Duration kMavlinkAfter = 5200ms;
/// Of ArduPilot's serial ports on DroneCAN, each way.
constexpr std::size_t kPortBytes = 2048;

dronecan::NodeParams node_params(const EmulatorConfig& config) {
  dronecan::NodeParams p;
  p.node_id = config.node_id;
  p.name = "org.skein.fc";
  p.software_version.major = 4;
  p.software_version.minor = 6;
  p.hardware_version.major = 1;
  // The same at every start, another for every node and system.
  p.hardware_version.unique_id = {'s', 'k', 'e', 'i', 'n', '-', 'f', 'c'};
  p.hardware_version.unique_id[14] = config.system_id;
  p.hardware_version.unique_id[15] = config.node_id;
  p.fd = config.fd;
  return p;
}

dronecan::TunnelParams tunnel_params(const EmulatorConfig& config) {
  dronecan::TunnelParams p;
  p.remote_node = config.companion_node;
  p.serial_id = config.serial_id;
  p.check_target = false;
  p.buffer_bytes = kPortBytes;
  return p;
}

std::optional<double> percent_of(std::string_view word) {
  double percent = 0.0;
  const auto read = std::from_chars(word.data(), word.data() + word.size(), percent);
  const bool whole = read.ec == std::errc{} && read.ptr == word.data() + word.size();
  if (!whole || !(percent >= 0.0 && percent <= 100.0)) return std::nullopt;
  return percent;
}

/// All that a restart of the autopilot begins anew.
struct Link {
  Link(const EmulatorConfig& config, Instant booted)
      : node{node_params(config), booted}, port{tunnel_params(config), booted} {}

  dronecan::Node node;
  dronecan::TunnelPort port;
  std::optional<MavlinkEndpoint> mavlink;
};

}  // namespace

struct EmulatedFlightController::State {
  State(const EmulatorConfig& c, const MissionOrigin& origin)
      : config{c}, earth{origin}, battery{c.battery_mah} {}

  void restart(Instant now) {
    link.reset();
    booted = now;
    bus_from = now + kBusAfter;
    mavlink_from = now + kMavlinkAfter;
  }

  void watch_nodes() {
    while (const auto event = link->node.poll_event()) {
      if (event->kind != dronecan::NodeEventKind::informed) continue;
      const dronecan::RemoteNode* const other = link->node.find(event->node_id);
      const auto [known, is_new] =
          nodes.try_emplace(event->node_id, other->info->hardware_version.unique_id);
      if (!is_new && known->second != other->info->hardware_version.unique_id) {
        const auto& name = other->info->name;
        duplicate = fmt::format("DroneCAN: Duplicate Node {}/{}!",
                                std::string{name.begin(), name.end()}, event->node_id);
      }
    }
  }

  [[nodiscard]] std::optional<std::string> refusal() const {
    if (const auto reason = autopilot::arming_refusal(health)) return std::string{*reason};
    if (const auto& why = vehicle->report().mode_refusal) return std::string{*why};
    if (!duplicate.empty()) return duplicate;
    if (!reason_given.empty()) return reason_given;
    for (const dronecan::RemoteNode& other : link->node.others()) {
      if (other.online && (other.status.health != dronecan::Health::ok ||
                           other.status.mode != dronecan::Mode::operational)) {
        return fmt::format("DroneCAN: Node {} unhealthy!", other.node_id);
      }
    }
    return std::nullopt;
  }

  /// One that stands still in the air, until its mission begins, takes nothing.
  void drain(Instant t) {
    if (t >= config.hold_until) battery.give(vehicle->report().throttle, vehicle->period());
  }

  void period(Instant t, bool last) {
    if (!link) {
      if (t < bus_from) {
        vehicle->coast(t);
        drain(t);
        return;
      }
      link.emplace(config, booted);
      vehicle->restart(t);
      battery.count_from_full();
    }
    vehicle->control(t);
    drain(t);
    if (t < mavlink_from || !config.serial_port || !config.mavlink) return;
    if (!link->mavlink) {
      link->mavlink.emplace(config, earth, *vehicle, battery, link->port, booted, t);
    }
    if (!last) return;  // a program that was held up does not send the past
    auto why_not = refusal();
    if (auto* const transmitter = link->mavlink->remote_id()) {
      transmitter->set_powered(remote_id);
      if (!why_not) why_not = transmitter->refusal(t);
    }
    link->mavlink->set_refusal(std::move(why_not));
    link->mavlink->set_position(health.position);
    link->mavlink->step(t);
    if (link->mavlink->wants_restart(t)) restart(t);
  }

  EmulatorConfig config;
  Earth earth;
  std::unique_ptr<Vehicle> vehicle;
  Battery battery;
  std::optional<Link> link;
  Instant booted;
  Instant bus_from;
  Instant mavlink_from;
  Instant next_period;
  autopilot::Health health;
  std::map<std::uint8_t, dronecan::UniqueId> nodes;  ///< kept over restarts, as ArduPilot does
  std::string duplicate;
  std::string reason_given;  ///< not to arm, from outside
  bool silent = false;
  bool remote_id = true;  ///< its transmitter has power
  mavlink::Encoder truth_encoder{config.system_id, mavlink::kComponentAutopilot};
};

EmulatedFlightController::EmulatedFlightController(std::unique_ptr<State> state)
    : state_{std::move(state)} {}
EmulatedFlightController::~EmulatedFlightController() = default;
EmulatedFlightController::EmulatedFlightController(EmulatedFlightController&&) noexcept = default;
EmulatedFlightController& EmulatedFlightController::operator=(EmulatedFlightController&&) noexcept =
    default;

Result<EmulatedFlightController> EmulatedFlightController::make(const EmulatorConfig& config,
                                                                Instant now) {
  if (auto good = check(config); !good) return good.error();
  const auto origin = MissionOrigin::make(config.origin);
  if (!origin) return origin.error();
  auto state = std::make_unique<State>(config, *origin);
  if (config.airframe == Airframe::copter) {
    state->vehicle = std::make_unique<CopterVehicle>(config, state->earth, now);
  } else {
    auto plane = PlaneVehicle::make(config, state->earth, now);
    if (!plane) return plane.error();
    state->vehicle = std::move(plane).value();
  }
  state->booted = state->bus_from = state->mavlink_from = state->next_period = now;
  state->link.emplace(config, now);
  return EmulatedFlightController{std::move(state)};
}

void EmulatedFlightController::on_frame(const can::Frame& frame, Instant now) {
  auto& link = state_->link;
  if (!link) return;
  if (const dronecan::Transfer* const transfer = link->node.on_frame(frame, 0, now)) {
    link->port.on_transfer(*transfer, link->node.node_id(), now);
  }
}

void EmulatedFlightController::step(Instant now) {
  State& s = *state_;
  while (s.next_period <= now) {
    const Instant t = s.next_period;
    s.next_period += s.vehicle->period();
    s.period(t, s.next_period > now);
  }
  if (!s.link) return;
  s.watch_nodes();
  if (s.config.serial_port) s.link->port.step(s.link->node, now);
  s.link->node.step(now);
}

Instant EmulatedFlightController::next_timeout() const {
  const State& s = *state_;
  if (!s.link) return s.next_period;
  const Instant node = s.link->node.next_timeout();
  if (!s.config.serial_port) return std::min(s.next_period, node);
  return std::min({s.next_period, s.link->port.next_timeout(), node});
}

std::span<const can::Frame> EmulatedFlightController::front() {
  if (!state_->link) return {};
  dronecan::Node& node = state_->link->node;
  while (state_->silent && !node.front().empty()) node.pop();
  return node.front();
}

void EmulatedFlightController::pop() {
  if (state_->link) state_->link->node.pop();
}

std::vector<std::uint8_t> EmulatedFlightController::truth() {
  const auto packet =
      state_->truth_encoder.encode(sim_state(state_->vehicle->report(), state_->earth));
  return {packet.begin(), packet.end()};
}

Result<void> EmulatedFlightController::interfere(std::string_view line, Instant now) {
  State& s = *state_;
  const std::size_t space = line.find(' ');
  const std::string_view verb = line.substr(0, space);
  const std::string_view word =
      space == std::string_view::npos ? std::string_view{} : line.substr(space + 1);
  const bool is_word = !word.empty();
  if (verb == "silent" && (word == "on" || word == "off")) {
    s.silent = word == "on";
    return {};
  }
  if (verb == "position" && (word == "lost" || word == "good")) {
    s.health.position = word == "good";
    s.vehicle->set_health(s.health);
    return {};
  }
  if (verb == "remote-id" && (word == "on" || word == "off")) {
    s.remote_id = word == "on";
    return {};
  }
  if (verb == "prearm") {
    s.reason_given = word;
    return {};
  }
  if (verb == "battery") {
    const auto percent = percent_of(word);
    if (!percent) return Error{fmt::format("'{}': battery takes a number from 0 to 100", line)};
    s.battery.fall_to(*percent);
    return {};
  }
  if (verb == "reboot" && !is_word) {
    s.restart(now);
    return {};
  }
  const bool is_arming = (verb == "arm" || verb == "disarm") && !is_word;
  if (!is_arming && (verb != "mode" || !is_word)) {
    return Error{
        fmt::format("'{}': not one of mode NAME, arm, disarm, reboot, silent on|off, "
                    "position lost|good, prearm REASON, battery PERCENT, remote-id on|off",
                    line)};
  }
  if (!s.link || !s.link->mavlink) return Error{fmt::format("'{}': the autopilot restarts", line)};
  auto result = mavlink::CommandResult::failed;
  if (verb == "arm") {
    result = s.link->mavlink->arm();
  } else if (verb == "disarm") {
    result = on_wire(s.vehicle->disarm(true));
  } else {
    const auto mode = mode_named(s.config.airframe, word);
    if (!mode) return Error{fmt::format("'{}': there is no such mode", line)};
    result = on_wire(s.vehicle->select_mode(*mode));
  }
  if (result != mavlink::CommandResult::accepted) {
    return Error{fmt::format("'{}': refused by the autopilot", line)};
  }
  return {};
}

}  // namespace skein::hil
