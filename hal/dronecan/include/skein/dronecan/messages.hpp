// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "skein/dronecan/definition.hpp"

/// The types in use. Names of fields are those of the DroneCAN definitions.
namespace skein::dronecan {

enum class Health : std::uint8_t { ok = 0, warning = 1, error = 2, critical = 3 };
enum class Mode : std::uint8_t {
  operational = 0,
  initialization = 1,
  maintenance = 2,
  software_update = 3,
  offline = 7,
};

/// Sent by every node once a second.
struct NodeStatus {
  std::uint32_t uptime_sec = 0;
  Health health = Health::ok;
  Mode mode = Mode::operational;
  std::uint8_t sub_mode = 0;
  std::uint16_t vendor_specific_status_code = 0;

  static constexpr auto kDefinition = message(
      341, "uavcan.protocol.NodeStatus", 0x0F0868D0C1A7C6F1,
      field("uptime_sec", &NodeStatus::uptime_sec, 32), field("health", &NodeStatus::health, 2),
      field("mode", &NodeStatus::mode, 3), field("sub_mode", &NodeStatus::sub_mode, 3),
      field("vendor_specific_status_code", &NodeStatus::vendor_specific_status_code, 16));
};

struct SoftwareVersion {
  std::uint8_t major = 0;
  std::uint8_t minor = 0;
  std::uint8_t optional_field_flags = 0;  ///< bit 0: commit is valid, bit 1: CRC is
  std::uint32_t vcs_commit = 0;
  std::uint64_t image_crc = 0;

  static constexpr auto kDefinition = part(
      field("sw_major", &SoftwareVersion::major, 8), field("sw_minor", &SoftwareVersion::minor, 8),
      field("optional_field_flags", &SoftwareVersion::optional_field_flags, 8),
      field("vcs_commit", &SoftwareVersion::vcs_commit, 32),
      field("image_crc", &SoftwareVersion::image_crc, 64));
};

using UniqueId = std::array<std::uint8_t, 16>;

struct HardwareVersion {
  std::uint8_t major = 0;
  std::uint8_t minor = 0;
  UniqueId unique_id{};
  Bytes<255> certificate_of_authenticity;

  static constexpr auto kDefinition = part(
      field("hw_major", &HardwareVersion::major, 8), field("hw_minor", &HardwareVersion::minor, 8),
      field("unique_id", &HardwareVersion::unique_id, 8),
      field("certificate_of_authenticity", &HardwareVersion::certificate_of_authenticity, 8));
};

struct GetNodeInfoRequest {
  static constexpr auto kDefinition = service(1, "uavcan.protocol.GetNodeInfo", 0xEE468A8121C46A9E);
};

struct GetNodeInfoResponse {
  NodeStatus status;
  SoftwareVersion software_version;
  HardwareVersion hardware_version;
  Bytes<80> name;  ///< such as "org.example.component"

  static constexpr auto kDefinition =
      service(1, "uavcan.protocol.GetNodeInfo", 0xEE468A8121C46A9E,
              field("status", &GetNodeInfoResponse::status),
              field("software_version", &GetNodeInfoResponse::software_version),
              field("hardware_version", &GetNodeInfoResponse::hardware_version),
              field("name", &GetNodeInfoResponse::name, 8));
};

enum class TunnelProtocol : std::uint8_t {
  mavlink = 0,
  mavlink2 = 1,
  gps_generic = 2,
  undefined = 255
};

/// Targetted: `options`. No other user may have the port while this one has it.
inline constexpr std::uint8_t kLockPort = 1;

/// Bytes of a serial port that a node has or wants. An empty buffer keeps the port alive.
struct Targetted {
  TunnelProtocol protocol = TunnelProtocol::undefined;
  std::uint8_t target_node = 0;
  std::int8_t serial_id = 0;  ///< -16..15; -1 is the default port
  std::uint8_t options = 0;   ///< 4 bits: kLockPort
  std::uint32_t baudrate = 0;
  Bytes<120> buffer;

  static constexpr auto kDefinition = message(
      3001, "uavcan.tunnel.Targetted", 0xB138E7EA72A2A2E9,
      field("protocol", &Targetted::protocol, 8), field("target_node", &Targetted::target_node, 7),
      field("serial_id", &Targetted::serial_id, 5), field("options", &Targetted::options, 4),
      field("baudrate", &Targetted::baudrate, 24), field("buffer", &Targetted::buffer, 8));
};

/// What an ArduPilot tells lights and buzzers of.
struct NotifyState {
  std::uint8_t aux_data_type = 0;
  Bytes<255> aux_data;
  std::uint64_t vehicle_state = 0;

  static constexpr auto kDefinition =
      message(20007, "ardupilot.indication.NotifyState", 0x631F2A9C1651FDEC,
              field("aux_data_type", &NotifyState::aux_data_type, 8),
              field("aux_data", &NotifyState::aux_data, 8),
              field("vehicle_state", &NotifyState::vehicle_state, 64));
};

/// What can be known of a type without its struct.
struct TypeInfo {
  TypeKind kind = TypeKind::message;
  std::uint16_t id = 0;
  std::string_view name;
  std::uint64_t signature = 0;
};

/// The types in use, by kind and id.
[[nodiscard]] std::span<const TypeInfo> types();
/// Null if it is not in use.
[[nodiscard]] const TypeInfo* find_type(TypeKind kind, std::uint16_t id);

}  // namespace skein::dronecan
