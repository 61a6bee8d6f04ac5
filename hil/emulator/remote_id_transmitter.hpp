// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

#include "skein/base/time.hpp"
#include "skein/mavlink/enums.hpp"
#include "skein/mavlink/packet.hpp"
#include "skein/mavlink/parser.hpp"
#include "skein/mavlink/remote_id.hpp"

namespace skein::hil {

/// A transmitter of Remote ID on a serial port of the autopilot, as ArduRemoteID is one: it says
/// once a second whether it has been told all that it must say. And what an ArduPilot with
/// DID_OPTIONS 1 makes of that.
class RemoteIdTransmitter {
 public:
  static constexpr Duration kPeriod = std::chrono::seconds{1};
  static constexpr Duration kFresh = std::chrono::seconds{3};

  explicit RemoteIdTransmitter(std::uint8_t system)
      : encoder_{system, mavlink::kComponentRemoteId1} {}

  /// From now on it has no power, or again.
  void set_powered(bool powered) { powered_ = powered; }

  /// True for what is told it through the autopilot.
  bool on_packet(const mavlink::Packet& packet, Instant now) {
    if (const auto id = mavlink::decode<mavlink::OpenDroneIdBasicId>(packet)) {
      if (id->id_type != 0 && id->uas_id[0] != 0) basic_id_at_ = now;
      return true;
    }
    if (const auto system = mavlink::decode<mavlink::OpenDroneIdSystem>(packet)) {
      has_operator_ = system->operator_latitude != 0 || system->operator_longitude != 0;
      system_at_ = now;
      return true;
    }
    if (mavlink::decode<mavlink::OpenDroneIdOperatorId>(packet)) {
      operator_id_at_ = now;
      return true;
    }
    return mavlink::decode<mavlink::OpenDroneIdSelfId>(packet).has_value();
  }

  /// Its next word, when it is due.
  [[nodiscard]] std::optional<mavlink::WireBytes> poll(Instant now) {
    if (!powered_ || now < next_) return std::nullopt;
    next_ = now + kPeriod;
    said_at_ = now;
    const std::string_view missing = what_is_missing(now);
    said_good_ = missing.empty();
    mavlink::OpenDroneIdArmStatus status;
    status.status = said_good_ ? 0 : 1;
    status.error = mavlink::field_of<50>(missing);
    return encoder_.encode(status);
  }

  /// Why the autopilot does not arm.
  [[nodiscard]] std::optional<std::string> refusal(Instant now) const {
    if (!basic_id_at_) return "OpenDroneID: UA_TYPE required in BasicID";
    if (!has_operator_) return "OpenDroneID: operator location must be set";
    if (!said_at_ || now - *said_at_ > kFresh) return "OpenDroneID: ARM_STATUS not available";
    if (!is_fresh(system_at_, now)) return "OpenDroneID: SYSTEM not available";
    if (!said_good_) return "OpenDroneID: " + std::string{what_is_missing(now)};
    return std::nullopt;
  }

 private:
  [[nodiscard]] static bool is_fresh(const std::optional<Instant>& at, Instant now) {
    return at && now - *at <= kFresh;
  }
  [[nodiscard]] std::string_view what_is_missing(Instant now) const {
    if (!is_fresh(basic_id_at_, now)) return "missing basic_id message";
    if (!is_fresh(operator_id_at_, now)) return "missing operator_id message";
    if (!is_fresh(system_at_, now)) return "missing system message";
    return has_operator_ ? "" : "missing operator location";
  }

  mavlink::Encoder encoder_;
  bool powered_ = true;
  bool has_operator_ = false;
  bool said_good_ = false;
  std::optional<Instant> basic_id_at_;
  std::optional<Instant> system_at_;
  std::optional<Instant> operator_id_at_;
  std::optional<Instant> said_at_;
  Instant next_ = Instant::min();
};

}  // namespace skein::hil
