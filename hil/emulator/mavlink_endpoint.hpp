// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fence_keeper.hpp"
#include "mission_store.hpp"
#include "remote_id_transmitter.hpp"
#include "skein/dronecan/tunnel.hpp"
#include "skein/hil/emulator_config.hpp"
#include "skein/mavlink/parser.hpp"
#include "skein/mavlink/signed_link.hpp"
#include "telemetry.hpp"
#include "vehicle.hpp"

namespace skein::hil {

/// MAVLink on a serial port, as an ArduPilot that has just started speaks it: streams, commands
/// with their answers, setpoints, text. What the port has no room for is numbered and lost.
class MavlinkEndpoint {
 public:
  MavlinkEndpoint(const EmulatorConfig& config, const Earth& earth, Vehicle& vehicle,
                  const Battery& battery, dronecan::TunnelPort& port, Instant booted, Instant now);

  /// Once in each period of the main loop: reads the port, obeys, sends what is due.
  void step(Instant now);

  /// Why it may not be armed; checked, told and shown in SYS_STATUS.
  void set_refusal(std::optional<std::string> reason) { refusal_ = std::move(reason); }
  /// Whether it knows where it is, as SYS_STATUS tells.
  void set_position(bool known) { position_ = known; }
  /// Arms, or says why not.
  mavlink::CommandResult arm();
  /// Was asked to restart, and has had the time to say that it will.
  /// None: it has no transmitter.
  [[nodiscard]] RemoteIdTransmitter* remote_id() { return remote_id_ ? &*remote_id_ : nullptr; }
  [[nodiscard]] bool wants_restart(Instant now) const { return restart_at_ && now >= *restart_at_; }

 private:
  struct Stream {
    std::uint32_t id = 0;
    Duration interval{};  ///< 0: not sent
    Instant due;
  };

  void on_packet(const mavlink::Packet& packet, Instant now);
  void acknowledge(const mavlink::CommandInt& command, mavlink::CommandResult result,
                   const mavlink::Packet& packet);
  mavlink::CommandResult obey(const mavlink::CommandInt& command, Instant now);
  mavlink::CommandResult set_mode(const mavlink::CommandInt& command);
  mavlink::CommandResult arm_or_disarm(const mavlink::CommandInt& command);
  mavlink::CommandResult set_interval(const mavlink::CommandInt& command, Instant now);
  mavlink::CommandResult tell_interval(const mavlink::CommandInt& command);
  mavlink::CommandResult send_once(std::uint32_t id, Instant now);
  mavlink::CommandResult restart(const mavlink::CommandInt& command, Instant now);
  void say_mission(MissionStore& store, Instant now);
  void tell_parameter(std::string_view name);
  void on_timesync(const mavlink::Timesync& question, const mavlink::Packet& packet, Instant now);
  [[nodiscard]] bool for_us(std::uint8_t system, std::uint8_t component) const;
  [[nodiscard]] Situation situation(Instant now) const;
  [[nodiscard]] Duration default_interval(std::uint32_t id) const;
  Stream* find_stream(std::uint32_t id);
  void send(const mavlink::WireBytes& bytes) { (void)port_.write(bytes); }
  void say(mavlink::Severity severity, std::string_view text);

  EmulatorConfig config_;
  const Earth& earth_;
  Vehicle& vehicle_;
  const Battery& battery_;
  dronecan::TunnelPort& port_;
  Instant booted_;
  std::optional<mavlink::Signing> signing_;
  mavlink::Parser parser_;
  mavlink::Encoder encoder_;
  FenceKeeper fence_;
  std::optional<RemoteIdTransmitter> remote_id_;
  MissionStore mission_;
  MissionStore fence_store_;
  std::uint8_t mission_system_ = 0;  ///< who is answered about the mission
  std::uint8_t mission_component_ = 0;
  std::vector<Stream> streams_;
  Instant timesync_at_;
  Instant refusal_told_at_;
  std::optional<std::string> refusal_;
  bool position_ = true;
  std::optional<Instant> restart_at_;
};

}  // namespace skein::hil
